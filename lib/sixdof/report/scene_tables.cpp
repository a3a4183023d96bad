#include <string>

#include <fmt/format.h>

#include <sixdof/report/tables.h>

namespace sixdof::report {
namespace {

Cell cell_of(std::optional<double> value, double unit = 1.0) { return value ? Cell(*value / unit) : Cell(); }

}  // namespace

DataTable many_bodies_table(const Results& results, const std::vector<RowGroup>& groups) {
  constexpr double k_us = 1e3;  // in ns
  DataTable table{.name = "many_bodies",
                  .title = "Scenes of many bodies",
                  .columns = {"run", "question", "bodies", "scene", "algorithm", "time_us", "p99_us", "longest_us",
                              "first_frame_us", "missed_pairs", "wrong_pairs", "true_pairs", "pairs_looked_at",
                              "triangle_pairs", "bytes", "faults", "command"},
                  .rows = {}};
  for (const RowGroup& group : groups) {
    const Row& row = group.row();
    if (row.fields.query != "scene" || row.fields.scenario.empty()) continue;
    const auto value = [&](const char* name, double unit = 1.0) { return cell_of(group.value(name), unit); };
    table.rows.push_back({run_name(results, row.file), row.fields.question, value("bodies"), row.fields.scenario,
                          row.fields.algorithm, value("processor_ns", k_us), value("p99_frame_ns", k_us),
                          value("max_ns", k_us), value("first_frame_ns", k_us), value("missed_pairs"),
                          value("wrong_pairs"), value("true_pairs"), value("pairs_looked_at"), value("triangle_pairs"),
                          value("bytes"), to_string(group.faults), reproduction(row, results.files[row.file])});
  }
  return table;
}

}  // namespace sixdof::report
