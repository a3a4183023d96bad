#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/scenario/evaluation.h>
#include <sixdof/scenario/path_settings.h>
#include "bench/harness/failure_counters.h"
#include "bench/harness/timing.h"
#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

/// The path is passed once to measure the answers and once or twice in the timed loop.
constexpr double k_passes = 3.0;

/// Fewest steps that a short time budget leaves: the coarsest path on which the measures still mean something.
constexpr std::size_t k_fewest_steps = 100;

/// The ideal that an algorithm is judged by.
IdealLaw law_of(const Traits& traits) { return traits.law == ResponseLaw::none ? IdealLaw::volume : own_law(traits); }

/// One row, and what its first call measured.
struct ScenarioRow {
  const Resources& resources;
  const Algorithm& algorithm;
  std::string name;  ///< Of the scenario.
  IdealLaw law = law_of(algorithm.traits());
  Settings settings = settings_along(name, algorithm, resources.assignments.at(algorithm.traits().name));
  std::unique_ptr<Scenario> scenario = {};
  std::unique_ptr<Query> query = {};
  Recording recording = {};
  std::vector<Pose> poses = {};  ///< Those of the recording that have an answer.
  Failures failures = {};        ///< In the timed loop.
  Measures measures = {};

  void run(benchmark::State& state, double seconds) {
    if (!query) prepare(seconds);
    const auto ask = [this](const Pose& pose) { return query->respond(pose); };
    time_mean(state, poses, GuardedQuery(*query, ask, failures));
    for (const auto& [measure, value] : measures) {
      if (measure != "mean_ns" && measure != "processor_ns")
        state.counters[measure] = value;  // the row has its own times
    }
    state.counters["failed"].value += static_cast<double>(failures.count());
    count_statuses(state.counters, failures);
    for (const auto& [counted, count] : query->footprint().counts) state.counters[counted] = count;
    state.counters["steps"] = static_cast<double>(recording.size());
    std::string label = fmt::format("law={} {}", to_string(law), settings.to_string());
    const std::string& failure = recording.first_failure.empty() ? failures.first() : recording.first_failure;
    if (!failure.empty()) label += fmt::format("; first failure: {}", failure);
    state.SetLabel(label);
  }

  void prepare(double seconds) {
    scenario = make_scenario(name);
    auto prepared = resources.cache.prepare(algorithm, settings, scenario->a(), scenario->b());
    // The time of a few steps tells how many the row can afford; a multiple of four keeps closed paths symmetric.
    constexpr std::size_t k_trial = 12;
    const Recording trial = record(*scenario, *prepared, k_trial);
    double step_ns = 0.0;
    for (const double t : trial.times_ns) step_ns += t / static_cast<double>(k_trial);
    const double affordable = seconds * 1e9 / (k_passes * std::max(1.0, step_ns));
    const std::size_t steps = affordable >= static_cast<double>(k_default_steps)
                                  ? k_default_steps
                                  : std::max(k_fewest_steps, static_cast<std::size_t>(affordable) / 4 * 4);
    recording = record(*scenario, *prepared, steps);
    for (std::size_t k = 0; k < recording.size(); ++k) {
      if (recording.status[k] == Status::ok) poses.push_back(recording.poses[k]);
    }
    if (poses.empty()) throw Error(fmt::format("no step has an answer: {}", recording.first_failure));
    measures = evaluate(*scenario, recording, law);
    for (const auto& measure : evaluate_jumps(*scenario, *prepared, recording, law)) measures.push_back(measure);
    add_other_laws();
    query = std::move(prepared);
  }

  /// Magnitude and direction by every law but the own one: results of algorithms are compared by one law as well.
  void add_other_laws() {
    for (const IdealLaw other : {IdealLaw::depth, IdealLaw::volume, IdealLaw::gradient, IdealLaw::traction,
                                 IdealLaw::wall_traction, IdealLaw::normals, IdealLaw::descent}) {
      if (other == law) continue;
      std::string suffix = fmt::format("_by_{}", to_string(other));
      std::replace(suffix.begin(), suffix.end(), '-', '_');
      for (const auto& [measure, value] : evaluate(*scenario, recording, other)) {
        for (const char* const wanted : {"sigma_F", "sigma_T", "gamma_F_deg", "gamma_T_deg"}) {
          if (measure == wanted) measures.emplace_back(measure + suffix, value);
        }
      }
    }
  }
};

}  // namespace

std::vector<PlannedRow> scenario_rows(const Resources& resources) {
  std::vector<PlannedRow> rows;
  for (const std::string& scenario : scenario_names()) {
    for (const auto& algorithm : resources.registry.all()) {
      if (!algorithm->traits().timed || !algorithm->traits().answers.respond) continue;
      const auto row = std::make_shared<ScenarioRow>(ScenarioRow{resources, *algorithm, scenario});
      rows.push_back({.name = fmt::format("scenario/{}/algorithm:{}", scenario, algorithm->traits().name),
                      .run = [row](benchmark::State& state, const Share& share) { row->run(state, share.seconds); },
                      .fields = {.query = "scenario",
                                 .algorithm = algorithm->traits().name,
                                 .settings = row->settings.to_string(),
                                 .runtime = algorithm->traits().runtime,
                                 .scenario = scenario,
                                 .law = std::string(to_string(row->law)),
                                 .isolated = is_isolated(*algorithm)},
                      .manual_time = is_isolated(*algorithm)});
    }
  }
  return rows;
}

}  // namespace sixdof::bench
