#include "bench/study/equivalent_scenario.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>

namespace sixdof::study {
namespace {

constexpr double k_undefined = std::numeric_limits<double>::quiet_NaN();

double find(const Measures& measures, const std::string& name) {
  const auto found = std::ranges::find(measures, name, &Measures::value_type::first);
  return found == measures.end() ? k_undefined : found->second;
}

/// The law whose ideals are the formulas as printed; empty where the paper prints none.
std::optional<IdealLaw> printed_law(const ScenarioStudy& study) {
  const Traits& traits = study.algorithm.traits();
  if (traits.law == ResponseLaw::none) return std::nullopt;
  const IdealLaw law = parse_ideal_law("paper", traits);
  return study.scenario.ideal(law, 0.0) ? std::optional(law) : std::nullopt;
}

using Counters = std::vector<std::pair<std::string, double>>;

void add(Counters& counters, std::string name, double value) {
  if (std::isfinite(value)) counters.emplace_back(std::move(name), value);
}

/// The measures that the paper prints, of the wrench that is rated, by the names of results::ScenarioMeasures.
Counters readings(const ScenarioStudy& study, const Recording& recording, const Measures& measures) {
  const std::string wrench(rated_wrench(study.scenario.name()));
  const std::string sigma = "sigma_" + wrench, gamma = "gamma_" + wrench + "_deg", nu = "nu_" + wrench;
  Counters counters;
  for (const std::string& name : {sigma, gamma, nu}) {
    add(counters, name, find(measures, name));
    add(counters, name + "_all", find(measures, name + "_all"));
  }
  const std::optional<IdealLaw> law = printed_law(study);
  if (!law) return counters;
  const Measures printed = evaluate(study.scenario, recording, *law);
  for (const std::string& name : {"sigma_paper_" + wrench, gamma, nu}) {
    // Where all of the path is in the window there is no measure of the whole path.
    const double whole = find(printed, name + "_all");
    add(counters, name + "_all_by_paper", std::isfinite(whole) ? whole : find(printed, name));
  }
  return counters;
}

/// Sets the parameter, so that texts of a grid are checked like those of the command line. @returns the number
double checked_number(const Traits& traits, const std::string& parameter, const std::string& text) {
  Settings settings(traits.parameters);
  settings.set(parameter, text);
  return settings.number(parameter);
}

std::string text_of(double value) { return fmt::format("{}", value); }

ResolutionAxis axis_of(const Traits& traits, const Parameter& parameter, const Grids& grids, double reach) {
  ResolutionAxis axis{.parameter = parameter.name, .integer = parameter.integer};
  if (const auto given = grids.find(parameter.name); given != grids.end()) {
    for (const double value : given->second) {
      axis.grid.push_back(checked_number(traits, parameter.name, text_of(value)));
    }
  } else {
    const std::size_t last = parameter.sweep.size() - 1;
    for (const std::size_t i : {std::size_t{0}, (last + 1) / 2, last}) {
      axis.grid.push_back(checked_number(traits, parameter.name, parameter.sweep[i]));
    }
  }
  const auto [least, largest] = std::ranges::minmax(axis.grid);
  axis.low = std::max(parameter.low, least / reach);
  axis.high = std::min(parameter.high, largest * reach);
  if (axis.integer) {
    axis.low = std::ceil(axis.low);
    axis.high = std::floor(axis.high);
  }
  return axis;
}

}  // namespace

std::string_view rated_wrench(std::string_view scenario) { return scenario == "III" ? "T" : "F"; }

std::array<ResolutionAxis, 2> resolution_axes(const Traits& traits, const Grids& grids, double reach) {
  std::vector<const Parameter*> swept;
  for (const Parameter& parameter : traits.parameters) {
    if (!parameter.sweep.empty() && parameter.choices.empty()) swept.push_back(&parameter);
  }
  if (swept.size() != 2) {
    throw BadArgument(fmt::format("{} has {} swept parameter{} instead of two, one for each body", traits.name,
                                  swept.size(), swept.size() == 1 ? "" : "s"));
  }
  return {axis_of(traits, *swept[0], grids, reach), axis_of(traits, *swept[1], grids, reach)};
}

Settings with_resolution(const Settings& settings, const std::array<ResolutionAxis, 2>& axes, const Resolution& at) {
  Settings complete = settings;
  for (const std::size_t i : {0, 1}) complete.set(axes[i].parameter, text_of(at[i]));
  return complete;
}

Measurement measure_scenario(const ScenarioStudy& study, const std::array<ResolutionAxis, 2>& axes,
                             const Resolution& at) {
  const Settings settings = with_resolution(study.settings, axes, at);
  const auto query = study.algorithm.prepare(study.scenario.a(), study.scenario.b(), settings);
  const Recording recording = record(study.scenario, *query, study.steps);
  if (!recording.first_failure.empty()) {
    throw Error(fmt::format("{} in {} with {}: {}", study.algorithm.traits().name, study.scenario.name(),
                            settings.to_string(), recording.first_failure));
  }
  const Measures measures = evaluate(study.scenario, recording, study.law);
  const std::string wrench(rated_wrench(study.scenario.name()));
  const double sigma = find(measures, "sigma_" + wrench);
  const double gamma = find(measures, "gamma_" + wrench + "_deg") * std::numbers::pi / 180.0;

  Counters counters = readings(study, recording, measures);
  add(counters, "misses", find(measures, "misses"));

  double least = std::numeric_limits<double>::infinity();
  for (std::size_t pass = 0; pass < k_timing_passes; ++pass) {
    least = std::min(least, record(study.scenario, *query, study.steps).processor_ns);
  }
  return {.at = at,
          .time_ns = least,
          .eta = study.weights.sigma * sigma + study.weights.gamma * gamma,
          .bytes = static_cast<double>(query->footprint().bytes),
          .counters = std::move(counters)};
}

}  // namespace sixdof::study
