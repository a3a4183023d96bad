#include <string>

#include <fmt/format.h>

#include <sixdof/report/tables.h>
#include <sixdof/results/refit_payoff.h>

namespace sixdof::report {
namespace {

constexpr double k_us = 1e3;  // in ns

Cell cell_of(std::optional<double> value, double unit = 1.0) { return value ? Cell(*value / unit) : Cell(); }

}  // namespace

DataTable deforming_table(const Results& results, const std::vector<RowGroup>& groups) {
  DataTable table{
      .name = "deforming",
      .title = "Meshes that deform",
      .columns = {"run", "question", "scene", "amplitude", "part", "algorithm", "time_us", "p99_us", "built_triangles",
                  "deformed_triangles", "missed_pairs", "wrong_pairs", "faults", "command"},
      .rows = {}};
  constexpr std::pair<const char*, const char*> k_parts[] = {
      {"update and query", "processor_ns"}, {"update", "update_ns"}, {"query", "answer_ns"}};
  for (const RowGroup& group : groups) {
    const Row& row = group.row();
    if (row.fields.query != "deform") continue;
    for (const auto& [part, counter] : k_parts) {
      const auto value = [&](const char* name, double unit = 1.0) { return cell_of(group.value(name), unit); };
      table.rows.push_back({run_name(results, row.file), row.fields.question, row.fields.scenario, value("amplitude"),
                            std::string(part), row.fields.algorithm, value(counter, k_us), value("p99_frame_ns", k_us),
                            value("built_triangles"), value("deformed_triangles"), value("missed_pairs"),
                            value("wrong_pairs"), to_string(group.faults), reproduction(row, results.files[row.file])});
    }
  }
  return table;
}

DataTable refit_payoff_table(const Results& results, const std::vector<RowGroup>& groups) {
  DataTable table{.name = "refit_payoff",
                  .title = "From which amplitude on building the tree anew is faster",
                  .columns = {"run", "question", "scene", "algorithm", "rebuild_wins_from", "least_amplitude",
                              "refit_over_rebuild_there", "largest_amplitude", "refit_over_rebuild_at_largest"},
                  .rows = {}};
  for (const results::Payoff& payoff : results::refit_payoffs(groups)) {
    const auto from = payoff.rebuild_wins_from();
    const results::PayoffPoint &least = payoff.points.front(), &largest = payoff.points.back();
    table.rows.push_back({run_name(results, payoff.file), payoff.question, payoff.family, payoff.refit,
                          from ? fmt::format("{:g} %", *from) : std::string("never"), least.amplitude,
                          least.refit_ns / least.rebuild_ns, largest.amplitude, largest.refit_ns / largest.rebuild_ns});
  }
  return table;
}

}  // namespace sixdof::report
