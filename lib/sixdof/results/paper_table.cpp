#include <sixdof/results/paper_table.h>

#include <algorithm>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/measure/metrics.h>
#include <sixdof/results/paper.h>

namespace sixdof::results {
namespace {

std::optional<double> value_of(const ScenarioMeasures& measures, const std::string& name) {
  const auto found = measures.values.find(name);
  return found == measures.values.end() ? std::nullopt : std::optional(found->second);
}

/// What the measure's formula is called where it is computed as printed.
std::string printed_formula(std::string_view measure) {
  constexpr std::string_view k_sigma = "sigma_";
  if (!measure.starts_with(k_sigma)) return std::string(measure);
  return fmt::format("sigma_paper_{}", measure.substr(k_sigma.size()));
}

std::optional<Reading> reading(std::string_view measure, std::optional<double> value, double printed) {
  if (!value) return std::nullopt;
  return Reading{.value = *value, .worse = worse_than_printed(measure, *value, printed)};
}

PaperLine line_of(const EqualTimeAnswer& answer, const PaperValue& paper) {
  const std::string measure(paper.measure);
  const auto read = [&](std::optional<double> value) { return reading(paper.measure, value, paper.value); };
  PaperLine line{.tau_ns = answer.tau_ns,
                 .scenario = answer.scenario,
                 .algorithm = answer.algorithm,
                 .measure = measure,
                 .printed = paper.value,
                 .resolution = answer.resolution,
                 .remark = answer.remark,
                 .mean_ns = answer.found.mean_ns,
                 .as_printed = read(value_of(answer.found, printed_formula(measure) + "_all_by_paper")),
                 .whole_path = read(value_of(answer.found, measure + "_all")),
                 .window = read(value_of(answer.found, measure)),
                 .window_at_defaults = std::nullopt,
                 .mean_ns_at_defaults = std::nullopt};
  if (!line.whole_path) line.whole_path = line.window;
  if (answer.at_defaults) {
    line.window_at_defaults = read(value_of(*answer.at_defaults, measure));
    line.mean_ns_at_defaults = answer.at_defaults->mean_ns;
  }
  return line;
}

}  // namespace

bool worse_than_printed(std::string_view measure, double value, double printed) {
  const Metric* const metric = find_metric(measure);
  if (metric == nullptr) throw BadArgument(fmt::format("{} is not in the table of metrics", measure));
  return is_better(metric->better, printed, value);
}

std::vector<PaperLine> paper_lines(std::span<const EqualTimeAnswer> answers) {
  std::vector<double> taus;
  for (const EqualTimeAnswer& answer : answers) {
    if (std::ranges::find(taus, answer.tau_ns) == taus.end()) taus.push_back(answer.tau_ns);
  }
  std::vector<PaperLine> lines;
  for (const double tau : taus) {
    for (const PaperValue& paper : k_paper_values) {
      for (const EqualTimeAnswer& answer : answers) {
        const bool is_it = answer.scenario == paper.scenario && answer.algorithm == paper.algorithm;
        if (is_it && answer.tau_ns == tau) lines.push_back(line_of(answer, paper));
      }
    }
  }
  return lines;
}

}  // namespace sixdof::results
