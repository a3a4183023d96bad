#include <optional>
#include <string>

#include <fmt/format.h>

#include <sixdof/report/tables.h>

namespace sixdof::report {
namespace {

/// Columns that are counters of a row, by the name of the counter.
constexpr const char* k_counters[] = {
    "contacts_mean",       "contact_off_mean",  "contact_off_max",     "off_bodies",       "contact_normal_deg",
    "reversed_normals",    "contact_force_deg", "contact_depth_ratio", "uncovered_mean",   "astray_mean",
    "exchange_normal_deg", "exchange_flips",    "exchange_points",     "moved_normal_deg", "moved_flips",
    "moved_points",        "step_normal_deg",   "step_normal_max_deg", "step_force_deg",   "step_points_mean",
    "step_center_mean",    "without_contact",   "full_answers",        "failed",           "judged"};

}  // namespace

DataTable contacts_table(const Results& results, const std::vector<RowGroup>& groups) {
  constexpr double k_us = 1e3;  // in ns
  DataTable table{.name = "contacts",
                  .title = "Contacts of bodies that overlap",
                  .columns = {"run", "pair", "percent", "order", "algorithm", "settings", "time_us", "p50_us"},
                  .rows = {}};
  table.columns.insert(table.columns.end(), std::begin(k_counters), std::end(k_counters));
  for (const char* column : {"faults", "command", "worst_pose"}) table.columns.emplace_back(column);
  for (const RowGroup& group : groups) {
    const Row& row = group.row();
    if (row.fields.query != "contacts" || !row.fields.bucket || row.fields.algorithm == "null") continue;
    const auto cell = [](std::optional<double> value, double unit = 1.0) {
      return value ? Cell(*value / unit) : Cell();
    };
    const auto time = group.mean_time();
    table.rows.push_back({run_name(results, row.file), row.fields.pair, row.fields.bucket->percent, row.fields.order,
                          row.fields.algorithm, row.fields.settings, time ? Cell(time->value / k_us) : Cell(),
                          cell(group.value("p50_ns"), k_us)});
    std::vector<Cell>& cells = table.rows.back();
    for (const char* counter : k_counters) cells.push_back(cell(group.value(counter)));
    cells.emplace_back(to_string(group.faults));
    cells.emplace_back(reproduction(row, results.files[row.file]));
    cells.emplace_back(row.outliers.command_of("contact_normal_max_deg"));
  }
  return table;
}

}  // namespace sixdof::report
