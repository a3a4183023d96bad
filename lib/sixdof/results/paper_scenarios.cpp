#include <sixdof/results/paper_scenarios.h>

#include <algorithm>

#include <fmt/format.h>

#include <sixdof/query/variant.h>
#include <sixdof/results/resolution.h>

namespace sixdof::results {
namespace {

/// Over the whole path where the window is shorter.
std::optional<double> value_of(const RowGroup& group, const std::string& measure) {
  const auto whole = group.value(measure + "_all");
  return whole ? whole : group.value(measure);
}

std::string printed_resolution(std::string_view scenario, std::string_view algorithm) {
  const auto* const found = std::ranges::find(k_paper_resolutions, scenario, &PaperResolution::scenario);
  if (algorithm != k_paper_resolution_of || found == std::ranges::end(k_paper_resolutions)) return {};
  return fmt::format("{}x{}x{}, {}", found->voxels[0], found->voxels[1], found->voxels[2], count_text(found->points));
}

}  // namespace

const std::vector<std::string>& paper_measures() {
  static const std::vector<std::string> list{"sigma_F", "gamma_F_deg", "nu_F", "sigma_T", "gamma_T_deg", "nu_T"};
  return list;
}

std::vector<PaperScenarioLine> paper_scenario_lines(const std::vector<RowGroup>& groups) {
  std::vector<PaperScenarioLine> lines;
  for (const RowGroup& group : groups) {
    const RowFields& fields = group.fields();
    const auto time = group.mean_time();
    if (fields.query != "scenario" || fields.algorithm == "null" || !time) continue;
    const std::string base = base_name(fields.algorithm);
    PaperScenarioLine& line = lines.emplace_back();
    line.scenario = fields.scenario;
    line.algorithm = fields.algorithm;
    line.law = fields.law;
    line.resolution = resolution_text(group);
    line.printed_resolution = printed_resolution(fields.scenario, base);
    line.mean_ns = time->value;
    for (const std::string& measure : paper_measures()) {
      line.measures.push_back(
          {.name = measure, .value = value_of(group, measure), .printed = paper_value(fields.scenario, base, measure)});
    }
  }
  return lines;
}

}  // namespace sixdof::results
