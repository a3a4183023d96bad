#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/scenario/evaluation.h>
#include "bench/harness/timing.h"
#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

/// The path is passed once to measure the answers and once or twice in the timed loop.
constexpr double k_passes = 3.0;

/// Fewest steps that a short time budget leaves: the coarsest path on which the measures still mean something.
constexpr std::size_t k_fewest_steps = 100;

/// One row, and what its first call measured.
class ScenarioRow {
 public:
  ScenarioRow(const Resources& resources, const Algorithm& algorithm, std::string scenario)
      : resources_(resources), algorithm_(algorithm), name_(std::move(scenario)) {}

  void run(benchmark::State& state, double seconds) {
    if (!query_) prepare(seconds);
    const auto ask = [this](const Pose& pose) { return query_->respond(pose); };
    time_mean(state, poses_, GuardedQuery(*query_, ask, failures_));
    for (const auto& [name, value] : measures_) {
      if (name != "mean_ns" && name != "processor_ns") state.counters[name] = value;  // the row has its own times
    }
    state.counters["failed"].value += static_cast<double>(failures_.count());
    state.counters["steps"] = static_cast<double>(recording_.size());
    state.SetLabel(label());
  }

 private:
  void prepare(double seconds) {
    const ResponseLaw own = algorithm_.traits().law;
    law_ = parse_ideal_law("own", own == ResponseLaw::none ? ResponseLaw::volume : own);
    scenario_ = make_scenario(name_);
    auto query =
        resources_.cache.prepare(algorithm_, resources_.settings_of(algorithm_), scenario_->a(), scenario_->b());
    // The time of a few steps tells how many the row can afford; a multiple of four keeps closed paths symmetric.
    constexpr std::size_t k_trial = 12;
    const Recording trial = record(*scenario_, *query, k_trial);
    double step_ns = 0.0;
    for (const double t : trial.times_ns) step_ns += t / static_cast<double>(k_trial);
    const double affordable = seconds * 1e9 / (k_passes * std::max(1.0, step_ns));
    const std::size_t steps = affordable >= static_cast<double>(k_default_steps)
                                  ? k_default_steps
                                  : std::max(k_fewest_steps, static_cast<std::size_t>(affordable) / 4 * 4);
    recording_ = record(*scenario_, *query, steps);
    for (std::size_t k = 0; k < recording_.size(); ++k) {
      if (recording_.status[k] == Status::ok) poses_.push_back(recording_.poses[k]);
    }
    if (poses_.empty()) throw Error(fmt::format("no step has an answer: {}", recording_.first_failure));
    measures_ = evaluate(*scenario_, recording_, law_);
    for (const auto& measure : evaluate_jumps(*scenario_, *query, recording_, law_)) measures_.push_back(measure);
    add_other_laws();
    query_ = std::move(query);
  }

  /// Magnitude and direction by every law but the declared one: in III and IV the ideal wrench of an algorithm is not
  /// that of its penalty's law.
  void add_other_laws() {
    for (const IdealLaw law :
         {IdealLaw::depth, IdealLaw::volume, IdealLaw::gradient, IdealLaw::traction, IdealLaw::wall_traction}) {
      if (law == law_) continue;
      std::string suffix = fmt::format("_by_{}", to_string(law));
      std::replace(suffix.begin(), suffix.end(), '-', '_');
      for (const auto& [name, value] : evaluate(*scenario_, recording_, law)) {
        const bool wanted = name == "sigma_F" || name == "sigma_T" || name == "gamma_F_deg" || name == "gamma_T_deg";
        if (wanted) measures_.emplace_back(name + suffix, value);
      }
    }
  }

  std::string label() const {
    std::string text = fmt::format("law={} {}", to_string(law_), resources_.settings_of(algorithm_).to_string());
    const std::string& failure = recording_.first_failure.empty() ? failures_.first() : recording_.first_failure;
    if (!failure.empty()) text += fmt::format("; first failure: {}", failure);
    return text;
  }

  const Resources& resources_;
  const Algorithm& algorithm_;
  std::string name_;
  IdealLaw law_ = IdealLaw::volume;
  std::unique_ptr<Scenario> scenario_;
  std::unique_ptr<Query> query_;
  Recording recording_;
  std::vector<Pose> poses_;  ///< Those of the recording that have an answer.
  Failures failures_;        ///< In the timed loop.
  Measures measures_;
};

}  // namespace

std::vector<Row> scenario_rows(const Resources& resources) {
  std::vector<Row> rows;
  for (const std::string& scenario : scenario_names()) {
    for (const auto& algorithm : resources.registry.all()) {
      if (!algorithm->traits().answers.respond) continue;
      const auto row = std::make_shared<ScenarioRow>(resources, *algorithm, scenario);
      rows.push_back({.name = fmt::format("scenario/{}/algorithm:{}", scenario, algorithm->traits().name),
                      .run = [row](benchmark::State& state, double seconds) { row->run(state, seconds); }});
    }
  }
  return rows;
}

}  // namespace sixdof::bench
