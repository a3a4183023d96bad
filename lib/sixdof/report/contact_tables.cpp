#include <optional>
#include <string>

#include <fmt/format.h>

#include <sixdof/report/tables.h>

namespace sixdof::report {
namespace {

/// Columns that are counters of a row, by the name of the counter.
constexpr const char* k_contacts[] = {"contacts_mean",
                                      "contact_off_mean",
                                      "contact_off_max",
                                      "off_bodies",
                                      "contact_normal_deg",
                                      "reversed_normals",
                                      "contact_force_deg",
                                      "contact_depth_ratio",
                                      "uncovered_mean",
                                      "astray_mean",
                                      "exchange_normal_deg",
                                      "exchange_flips",
                                      "exchange_points",
                                      "exchange_failed",
                                      "moved_normal_deg",
                                      "moved_flips",
                                      "moved_points",
                                      "moved_failed",
                                      "step_normal_deg",
                                      "step_normal_max_deg",
                                      "step_force_deg",
                                      "step_points_mean",
                                      "step_center_mean",
                                      "without_contact",
                                      "full_answers",
                                      "failed",
                                      "judged"};
constexpr const char* k_depths[] = {"depth_ratio",     "too_shallow",     "too_deep",    "missed_depths",
                                    "too_shallow_max", "too_deep_max",    "judged",      "open_depths",
                                    "failed",          "depth_width_max", "depth_of_ray"};

Cell cell(std::optional<double> value, double unit = 1.0) { return value ? Cell(*value / unit) : Cell(); }

/// Appends a line for each row of a query: the cells of place(fields), times, counters, faults and commands.
/// @param table with the columns of the place; @param outlier counter whose configuration is the worst pose
template <class Place>
void add_lines(DataTable& table, const char* query, std::span<const char* const> counters, const char* outlier,
               const Results& results, const std::vector<RowGroup>& groups, const Place& place) {
  constexpr double k_us = 1e3;  // in ns
  table.columns.insert(table.columns.end(), {"algorithm", "settings", "time_us", "p50_us"});
  table.columns.insert(table.columns.end(), counters.begin(), counters.end());
  table.columns.insert(table.columns.end(), {"faults", "command", "worst_pose"});
  for (const RowGroup& group : groups) {
    const Row& row = group.row();
    if (row.fields.query != query || !row.fields.bucket || row.fields.algorithm == "null") continue;
    const auto time = group.mean_time();
    std::vector<Cell>& cells = table.rows.emplace_back();
    cells.emplace_back(run_name(results, row.file));
    for (Cell& each : place(row.fields)) cells.push_back(std::move(each));
    cells.emplace_back(row.fields.algorithm);
    cells.emplace_back(row.fields.settings);
    cells.push_back(time ? Cell(time->value / k_us) : Cell());
    cells.push_back(cell(group.value("p50_ns"), k_us));
    for (const char* counter : counters) cells.push_back(cell(group.value(counter)));
    cells.emplace_back(to_string(group.faults));
    cells.emplace_back(reproduction(row, results.files[row.file]));
    cells.emplace_back(row.outliers.command_of(outlier));
  }
}

}  // namespace

DataTable contacts_table(const Results& results, const std::vector<RowGroup>& groups) {
  DataTable table{.name = "contacts",
                  .title = "Contacts of bodies that overlap",
                  .columns = {"run", "pair", "percent", "order"},
                  .rows = {}};
  add_lines(table, "contacts", k_contacts, "contact_normal_max_deg", results, groups,
            [](const RowFields& fields) -> std::vector<Cell> {
              return {fields.pair, fields.bucket->percent, fields.order};
            });
  return table;
}

DataTable depths_table(const Results& results, const std::vector<RowGroup>& groups) {
  DataTable table{.name = "depths",
                  .title = "Depths of bodies that overlap, against the interval of their penetration depth",
                  .columns = {"run", "pair", "bodies", "percent"},
                  .rows = {}};
  add_lines(table, "depth", k_depths, "too_shallow_max", results, groups,
            [](const RowFields& fields) -> std::vector<Cell> {
              return {fields.pair, fields.body.empty() ? std::string("meshes") : fields.body, fields.bucket->percent};
            });
  return table;
}

}  // namespace sixdof::report
