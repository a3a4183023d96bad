#include "bench/study/equivalent_rows.h"

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include "bench/study/equivalent_scenario.h"

namespace sixdof::study {
namespace {

constexpr std::array<std::pair<const char*, double>, 4> k_units{{{"s", 1e9}, {"ms", 1e6}, {"us", 1e3}, {"ns", 1.0}}};

std::string prefix(const EquivalentResult& result) {
  const std::string given = result.options.goal == Goal::time ? "tau:" + time_text(result.options.target)
                                                              : fmt::format("eta:{}", result.options.target);
  return fmt::format("equivalent/scenario:{}/algorithm:{}/{}", result.scenario, result.algorithm, given);
}

results::Row measured_row(const EquivalentResult& result, const Measurement& measured, std::string name) {
  const Settings settings = with_resolution(result.settings, result.axes, measured.at);
  results::Row row{.name = std::move(name),
                   .fields = {.query = "equivalent",
                              .algorithm = result.algorithm,
                              .settings = settings.to_string(),
                              .scenario = result.scenario,
                              .isolated = result.isolated,
                              .question = "respond"},
                   .values = {{results::k_processor_mean, measured.time_ns},
                              {results::k_wall_mean, measured.time_ns},
                              {"measured_ns", measured.time_ns},
                              {"bytes", measured.bytes}},
                   .label = fmt::format("law={}", result.law)};
  if (std::isfinite(measured.eta)) {
    row.values["eta_measured"] = measured.eta;
  } else {
    row.error = "eta is not defined: no force in the scenario's window";
  }
  for (const auto& counter : measured.counters) row.values.insert_or_assign(counter.first, counter.second);
  return row;
}

results::Row step_row(const EquivalentResult& result, const SearchStep& step, std::string name) {
  results::Row row = measured_row(result, step.measured, std::move(name));
  row.values["eta_predicted"] = step.eta_predicted;
  row.values["predicted_ns"] = step.time_predicted_ns;
  row.values[result.options.goal == Goal::time ? "tau_ns" : "eta_wanted"] = result.options.target;
  row.label += fmt::format(" time={} eta={}", to_string(step.time_form), to_string(step.eta_form));
  if (step.reach == Reach::inside) row.label += " inside";
  if (step.reach == Reach::below) row.label += " all-below";
  if (step.reach == Reach::above) row.label += " all-above";
  return row;
}

/// What a reader of the answer alone has to know: "all faster, not converged".
std::string remark(const SearchResult& search) {
  std::string text;
  if (search.answer().reach == Reach::inside) text = "better than at tau";
  if (search.answer().reach == Reach::below) text = "all faster";
  if (search.answer().reach == Reach::above) text = "all slower";
  if (!search.converged) text += text.empty() ? "not converged" : ", not converged";
  return text;
}

results::ScenarioMeasures measures_of(const Measurement& measured) {
  return {.values = {measured.counters.begin(), measured.counters.end()}, .mean_ns = measured.time_ns};
}

}  // namespace

std::vector<results::Row> equivalent_rows(const EquivalentResult& result) {
  std::vector<results::Row> rows;
  rows.push_back(step_row(result, result.search.answer(), prefix(result)));
  if (!result.search.converged) rows.back().label += " not-within-tolerance";
  for (std::size_t k = 0; k < result.search.steps.size(); ++k) {
    rows.push_back(step_row(result, result.search.steps[k], fmt::format("{}/step:{}", prefix(result), k)));
  }
  for (const Measurement& point : result.search.grid) {
    rows.push_back(measured_row(result, point,
                                fmt::format("{}/{}:{}/{}:{}", prefix(result), result.axes[0].parameter, point.at[0],
                                            result.axes[1].parameter, point.at[1])));
  }
  if (result.at_defaults) rows.push_back(measured_row(result, *result.at_defaults, prefix(result) + "/defaults"));
  return rows;
}

std::vector<results::EqualTimeAnswer> equal_time_answers(std::span<const EquivalentResult> searches) {
  std::vector<results::EqualTimeAnswer> answers;
  for (const EquivalentResult& result : searches) {
    if (result.options.goal != Goal::time) continue;
    const Measurement& found = result.search.answer().measured;
    results::EqualTimeAnswer answer{.scenario = result.scenario,
                                    .algorithm = result.algorithm,
                                    .tau_ns = result.options.target,
                                    .resolution = resolution_text(result.axes, found.at),
                                    .remark = remark(result.search),
                                    .found = measures_of(found)};
    if (result.at_defaults) answer.at_defaults = measures_of(*result.at_defaults);
    answers.push_back(std::move(answer));
  }
  return answers;
}

PredictionError prediction_error(std::span<const EquivalentResult> results, bool first) {
  PredictionError error;
  for (const EquivalentResult& result : results) {
    const SearchStep& step = first ? result.search.first() : result.search.answer();
    const double difference = std::abs(step.eta_predicted - step.measured.eta);
    if (!std::isfinite(difference) || step.measured.eta <= 0.0) continue;
    ++error.searches;
    error.difference += difference;
    error.relative += difference / step.measured.eta;
  }
  if (error.searches > 0) {
    error.difference /= static_cast<double>(error.searches);
    error.relative /= static_cast<double>(error.searches);
  }
  return error;
}

std::string given_text(const SearchOptions& options) {
  return options.goal == Goal::time ? fmt::format("tau = {}", time_text(options.target))
                                    : fmt::format("eta = {:.4g}", options.target);
}

std::string resolution_text(const std::array<ResolutionAxis, 2>& axes, const Resolution& at) {
  return fmt::format("{}={} {}={}", axes[0].parameter, at[0], axes[1].parameter, at[1]);
}

std::string time_text(double nanoseconds) {
  for (const auto& [unit, length] : k_units) {
    // 0.9 ms is as readable as 900 us.
    if (nanoseconds >= 0.1 * length) return fmt::format("{:.6g}{}", nanoseconds / length, unit);
  }
  return fmt::format("{:.6g}ns", nanoseconds);
}

double parse_time_ns(const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  const std::string_view unit(stop, static_cast<std::size_t>(end - stop));
  if (error == std::errc()) {
    for (const auto& [name, length] : k_units) {
      if (unit != name) continue;
      if (!(value > 0.0 && std::isfinite(value))) throw BadArgument(fmt::format("{}: must be above zero", text));
      return value * length;
    }
  }
  throw BadArgument(fmt::format("{}: must be a number with a unit, ns, us, ms or s: 0.9ms", text));
}

}  // namespace sixdof::study
