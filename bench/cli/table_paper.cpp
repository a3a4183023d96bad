#include <fmt/format.h>

#include <sixdof/query/variant.h>
#include <sixdof/results/paper_scenarios.h>
#include "bench/cli/table.h"
#include "bench/cli/table_numbers.h"

namespace sixdof::cli {
namespace {

/// "0.031 (0.043)": the value, and what the paper prints.
std::string measure_cell(const results::PaperMeasure& measure) {
  const bool is_angle = measure.name.ends_with("_deg");
  const auto text = [&](double value) { return is_angle ? as_degrees(value) : fmt::format("{:.3g}", value); };
  const std::string value = measure.value ? text(*measure.value) : "-";
  return measure.printed ? fmt::format("{} ({})", value, text(*measure.printed)) : value;
}

}  // namespace

Sheet paper_sheet_of(const TableInput& input) {
  Sheet sheet;
  sheet.title = "Scenarios at the paper's resolutions; in parentheses what the paper prints";
  sheet.columns = {{"", "scenario", true},
                   {"", "algorithm", true},
                   {"", "voxels and points, or spheres", true},
                   {"", "law", true},
                   {"", "cpu, us"}};
  for (const std::string& measure : results::paper_measures()) sheet.columns.push_back({"whole path", measure});
  for (const results::PaperScenarioLine& line : results::paper_scenario_lines(input.groups)) {
    const std::string printed = line.printed_resolution.empty() ? "" : fmt::format(" ({})", line.printed_resolution);
    auto& cells =
        sheet.lines.emplace_back(std::vector{line.scenario, base_name(line.algorithm), line.resolution + printed,
                                             line.law.empty() ? "-" : line.law, as_microseconds(line.mean_ns)});
    for (const results::PaperMeasure& measure : line.measures) cells.push_back(measure_cell(measure));
  }
  return sheet;
}

}  // namespace sixdof::cli
