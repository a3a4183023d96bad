#include <sixdof/results/paper_scenarios.h>

#include <algorithm>

#include <fmt/format.h>

#include <sixdof/query/variant.h>
#include <sixdof/results/resolution.h>

namespace sixdof::results {
namespace {

constexpr std::string_view k_own = "own";

/// "_by_wall_traction"; empty for the own law.
std::string suffix_of(std::string_view law) {
  if (law == k_own) return {};
  std::string suffix = fmt::format("_by_{}", law);
  std::ranges::replace(suffix, '-', '_');
  return suffix;
}

/// Over the whole path where the window is shorter; nu is of the signal, whatever the law.
std::optional<double> value_of(const RowGroup& group, const std::string& measure, const std::string& suffix) {
  if (!suffix.empty() && !measure.starts_with("nu_")) return group.value(measure + suffix);
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

std::vector<PaperScenarioLine> paper_scenario_lines(
    const std::vector<RowGroup>& groups,
    const std::function<std::string_view(std::string_view scenario, std::string_view algorithm)>& law_of) {
  std::vector<PaperScenarioLine> lines;
  for (const RowGroup& group : groups) {
    const RowFields& fields = group.fields();
    const auto time = group.mean_time();
    if (fields.query != "scenario" || fields.algorithm == "null" || !time) continue;
    const std::string base = base_name(fields.algorithm);
    std::string_view law = law_of(fields.scenario, base);
    // A row has no suffix for the law that it was judged by.
    if (!group.value("sigma_F" + suffix_of(law)) && !group.value("sigma_T" + suffix_of(law))) law = k_own;
    PaperScenarioLine& line = lines.emplace_back();
    line.scenario = fields.scenario;
    line.algorithm = fields.algorithm;
    line.law = law == k_own ? std::string() : std::string(law);
    line.resolution = resolution_text(group);
    line.printed_resolution = printed_resolution(fields.scenario, base);
    line.mean_ns = time->value;
    for (const std::string& measure : paper_measures()) {
      line.measures.push_back({.name = measure,
                               .value = value_of(group, measure, suffix_of(law)),
                               .printed = paper_value(fields.scenario, base, measure)});
    }
  }
  return lines;
}

}  // namespace sixdof::results
