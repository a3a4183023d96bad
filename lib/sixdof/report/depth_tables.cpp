#include <iterator>
#include <optional>

#include <sixdof/report/tables.h>

namespace sixdof::report {
namespace {

/// Columns that are counters of a row, by the name of the counter.
constexpr const char* k_counters[] = {"depth_ratio",     "too_shallow",     "too_deep",    "missed_depths",
                                      "too_shallow_max", "too_deep_max",    "judged",      "open_depths",
                                      "failed",          "depth_width_max", "depth_of_ray"};

}  // namespace

DataTable depths_table(const Results& results, const std::vector<RowGroup>& groups) {
  constexpr double k_us = 1e3;  // in ns
  DataTable table{.name = "depths",
                  .title = "Depths of bodies that overlap, against the interval of their penetration depth",
                  .columns = {"run", "pair", "bodies", "percent", "algorithm", "settings", "time_us", "p50_us"},
                  .rows = {}};
  table.columns.insert(table.columns.end(), std::begin(k_counters), std::end(k_counters));
  for (const char* column : {"faults", "command", "worst_pose"}) table.columns.emplace_back(column);
  for (const RowGroup& group : groups) {
    const Row& row = group.row();
    if (row.fields.query != "depth" || !row.fields.bucket || row.fields.algorithm == "null") continue;
    const auto cell = [](std::optional<double> value, double unit = 1.0) {
      return value ? Cell(*value / unit) : Cell();
    };
    const auto time = group.mean_time();
    table.rows.push_back({run_name(results, row.file), row.fields.pair,
                          row.fields.body.empty() ? std::string("meshes") : row.fields.body, row.fields.bucket->percent,
                          row.fields.algorithm, row.fields.settings, time ? Cell(time->value / k_us) : Cell(),
                          cell(group.value("p50_ns"), k_us)});
    std::vector<Cell>& cells = table.rows.back();
    for (const char* counter : k_counters) cells.push_back(cell(group.value(counter)));
    cells.emplace_back(to_string(group.faults));
    cells.emplace_back(reproduction(row, results.files[row.file]));
    cells.emplace_back(row.outliers.command_of("too_shallow_max"));
  }
  return table;
}

}  // namespace sixdof::report
