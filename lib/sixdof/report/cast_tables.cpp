#include <string>

#include <fmt/format.h>

#include <sixdof/report/tables.h>

namespace sixdof::report {

DataTable casts_table(const Results& results, const std::vector<RowGroup>& groups) {
  constexpr double k_us = 1e3;  // in ns
  DataTable table{
      .name = "casts",
      .title = "First contacts of moving bodies",
      .columns = {"run",        "pair",       "motion",     "percent",      "step",         "algorithm",      "time_us",
                  "p99_us",     "longest_us", "motions",    "hits",         "missed_hits",  "missed_percent", "late",
                  "late_most",  "early",      "early_most", "phantom_hits", "false_starts", "failed",         "grazing",
                  "normal_deg", "faults",     "command"},
      .rows = {}};
  for (const RowGroup& group : groups) {
    const Row& row = group.row();
    const CastMotion motion = cast_motion_of(row.fields);
    if (motion.kind.empty() || row.fields.algorithm == "null") continue;
    const auto value = [&](const char* name, double unit = 1.0) {
      const auto found = group.value(name);
      return found ? Cell(*found / unit) : Cell();
    };
    const auto hits = group.value("hits"), missed = group.value("missed_hits");
    const auto time = group.mean_time();
    table.rows.push_back({run_name(results, row.file),
                          bodies_of(row.fields),
                          motion.kind,
                          motion.percent,
                          fmt::format("{:g} %", motion.percent),
                          group.algorithm(),
                          time ? Cell(time->value / k_us) : Cell(),
                          value("p99_ns", k_us),
                          value("max_ns", k_us),
                          value("configurations"),
                          value("hits"),
                          value("missed_hits"),
                          hits && missed && *hits > 0.0 ? Cell(100.0 * *missed / *hits) : Cell(),
                          value("late_hits"),
                          value("late_max"),
                          value("early"),
                          value("early_max"),
                          value("phantom_hits"),
                          value("false_starts"),
                          value("failed"),
                          value("grazing"),
                          value("normal_max_deg"),
                          to_string(group.faults),
                          reproduction(row, results.files[row.file])});
  }
  return table;
}

}  // namespace sixdof::report
