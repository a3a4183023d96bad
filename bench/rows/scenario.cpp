#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include "bench/harness/timing.h"
#include "bench/rows/families.h"
#include <sixdof/scenario/evaluation.h>

namespace sixdof::bench {
namespace {

/// The path is run through once to measure the answers and at least once in the timed loop, which may take two rounds.
constexpr double k_passes = 3.0;

/// Fewest stamps that a short time budget leaves: the coarsest path on which the measures still mean something.
constexpr std::size_t k_fewest_stamps = 100;

/// One row, and what it found in its first call.
class ScenarioRow {
 public:
  ScenarioRow(Suite& suite, const Algorithm& algorithm, std::string scenario)
      : suite_(suite), algorithm_(algorithm), name_(std::move(scenario)) {}

  void run(benchmark::State& state) {
    if (!query_) prepare();
    time_mean(state, recording_.poses, [this](const Pose& pose) { return query_->respond(pose); });
    for (const auto& [name, value] : measures_) {
      if (name != "mean_ns" && name != "processor_ns") state.counters[name] = value;  // the row's own times
    }
    state.counters["stamps"] = static_cast<double>(recording_.size());
    state.SetLabel(fmt::format("law={} {}", to_string(law_), suite_.settings(algorithm_).to_string()));
  }

 private:
  void prepare() {
    const ResponseLaw own = algorithm_.traits().law;
    law_ = parse_ideal_law("own", own == ResponseLaw::none ? ResponseLaw::volume : own);
    scenario_ = make_scenario(name_);
    auto query = suite_.stock().prepare(algorithm_, suite_.settings(algorithm_), scenario_->a(), scenario_->b());
    // A few stamps tell how many the row's time allows; a multiple of four keeps closed paths symmetric.
    constexpr std::size_t k_probe = 12;
    const Recording probe = record(*scenario_, *query, k_probe);
    double probe_ns = 0.0;
    for (const double t : probe.times_ns) probe_ns += t / static_cast<double>(k_probe);
    const double affordable = suite_.row_budget_s() * 1e9 / (k_passes * std::max(1.0, probe_ns));
    const std::size_t stamps = affordable >= static_cast<double>(k_default_stamps)
                                   ? k_default_stamps
                                   : std::max(k_fewest_stamps, static_cast<std::size_t>(affordable) / 4 * 4);
    recording_ = record(*scenario_, *query, stamps);
    measures_ = evaluate(*scenario_, recording_, law_);
    for (const auto& measure : evaluate_jumps(*scenario_, *query, recording_, law_)) measures_.push_back(measure);
    add_other_laws();
    query_ = std::move(query);
  }

  /// Magnitude and direction by every law but the declared one: in III and IV the ideal of a wrench is not the one its
  /// penalty's law has.
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

  Suite& suite_;
  const Algorithm& algorithm_;
  std::string name_;
  IdealLaw law_ = IdealLaw::volume;
  std::unique_ptr<Scenario> scenario_;
  std::unique_ptr<Query> query_;
  Recording recording_;
  Measures measures_;
};

}  // namespace

void add_scenario_rows(Suite& suite) {
  for (const std::string& scenario : scenario_names()) {
    for (const auto& algorithm : suite.registry().all()) {
      if (!algorithm->traits().answers.respond) continue;
      const auto row = std::make_shared<ScenarioRow>(suite, *algorithm, scenario);
      suite.add(fmt::format("scenario/{}/algorithm:{}", scenario, algorithm->traits().name),
                [row](benchmark::State& state) { row->run(state); });
    }
  }
}

}  // namespace sixdof::bench
