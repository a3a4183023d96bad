// Each deliberately bad algorithm is a perfect one (a scenario's own ideal) with one fault. The measure meant for that
// fault must detect it, at the bound that the perfect algorithm passes.

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/measure/metrics.h>
#include <sixdof/scenario/evaluation.h>

#include "../scenario/ideal_query.h"
#include "bench/common/all_algorithms.h"
#include "bounds.h"

namespace sixdof {
namespace {

using test::IdealQuery;
using Spoil = IdealQuery::Spoil;

std::map<std::string, double> measures_of(const char* name, const Spoil& spoil, double late_steps = 0.0) {
  const auto scenario = make_scenario(name);
  IdealQuery query(*scenario, IdealLaw::volume, spoil, late_steps / static_cast<double>(k_gate_steps));
  const Recording recording = record(*scenario, query, k_gate_steps);
  const Measures measures = evaluate(*scenario, recording, IdealLaw::volume);
  return {measures.begin(), measures.end()};
}

/// The fault exceeds the bound, the perfect algorithm passes it.
void expect_caught(const char* scenario, const char* measure, double bound, const Spoil& spoil, double late = 0.0) {
  EXPECT_EQ(judge(std::abs(measures_of(scenario, {}).at(measure)), bound), Verdict::holds) << scenario << " perfect";
  EXPECT_EQ(judge(std::abs(measures_of(scenario, spoil, late).at(measure)), bound), Verdict::worse)
      << scenario << " spoilt";
}

constexpr double k_rounding = 1e-9;

TEST(BadAlgorithm, NoiseIsCaughtByNoise) {
  for (const char* scenario : {"Ia", "II", "IV"}) {
    const auto random = std::make_shared<std::mt19937_64>(5);
    const Spoil shake = [random](Response& r, double, std::size_t) {
      std::normal_distribution<double> normal;
      const double size = 0.01 * r.force.norm();
      r.force += size * Eigen::Vector3d(normal(*random), normal(*random), normal(*random));
    };
    expect_caught(scenario, "noise_F", k_rounding, shake);
  }
}

TEST(BadAlgorithm, WrongSignIsCaughtByGamma) {
  const Spoil flip = [](Response& r, double, std::size_t) {
    r.force = -r.force;
    r.torque = -r.torque;
  };
  for (const char* scenario : {"Ia", "Ib", "II", "IV"}) expect_caught(scenario, "gamma_F_deg", k_rounding, flip);
  expect_caught("III", "gamma_T_deg", k_rounding, flip);
  // The paper's sigma and nu compare magnitudes only and do not detect it.
  EXPECT_NEAR(measures_of("II", flip).at("sigma_F"), 0.0, k_rounding);
  EXPECT_NEAR(measures_of("II", flip).at("nu_F"), 1.0, k_rounding);
}

TEST(BadAlgorithm, TunnellingIsCaughtByMisses) {
  // A force near the plate's ends only, none between them.
  const Spoil tunnel = [](Response& r, double progress, std::size_t) {
    if (progress > 0.4 && progress < 0.6) r = Response{.reference = r.reference};
  };
  expect_caught("Ib", "misses", 0.0, tunnel);
  const Spoil silent = [](Response& r, double, std::size_t) { r = Response{.reference = r.reference}; };
  expect_caught("Ib", "misses", 0.0, silent);
}

TEST(BadAlgorithm, GainErrorIsCaughtByTheGain) {
  const Spoil louder = [](Response& r, double, std::size_t) {
    r.force *= 1.1;
    r.torque *= 1.1;
  };
  const auto off = [](double gain) { return std::abs(gain - 1.0); };
  for (const char* scenario : {"Ia", "Ib", "II", "IV"}) {
    EXPECT_EQ(judge(off(measures_of(scenario, {}).at("gain_F")), k_rounding), Verdict::holds);
    EXPECT_EQ(judge(off(measures_of(scenario, louder).at("gain_F")), k_rounding), Verdict::worse);
  }
  EXPECT_EQ(judge(off(measures_of("III", louder).at("gain_T")), k_rounding), Verdict::worse);
  // The paper's sigma does not change under a gain.
  EXPECT_NEAR(measures_of("II", louder).at("sigma_F"), 0.0, k_rounding);
}

TEST(BadAlgorithm, GainErrorOnPartOfThePathIsCaughtBySigma) {
  const Spoil louder = [](Response& r, double progress, std::size_t) {
    if (progress > 0.5) r.force *= 1.1;
  };
  for (const char* scenario : {"Ia", "II", "IV"}) expect_caught(scenario, "sigma_F", k_rounding, louder);
}

TEST(BadAlgorithm, ALagOfThreeStepsIsCaughtByTheLag) {
  for (const char* scenario : {"II", "III", "IV"}) {
    constexpr double k_late = 3.0;
    const auto late = measures_of(scenario, {}, k_late);
    EXPECT_NEAR(late.at("lag"), k_late, 0.5) << scenario;
    // Half a step: the largest error of the parabola between steps.
    EXPECT_EQ(judge(std::abs(measures_of(scenario, {}).at("lag")), 0.5), Verdict::too_loose) << scenario;
    EXPECT_EQ(judge(std::abs(late.at("lag")), 0.5), Verdict::worse) << scenario;
  }
  // In II the direction rotates along the path, so a lag is an angle as well.
  EXPECT_NEAR(measures_of("II", {}, 3.0).at("gamma_F_deg"), 3.0 * 360.0 / k_gate_steps, 1e-6);
}

TEST(Table, JudgesBothWays) {
  EXPECT_EQ(judge(0.011, 0.01), Verdict::worse);
  EXPECT_EQ(judge(0.01, 0.01), Verdict::holds);
  EXPECT_EQ(judge(0.005, 0.01), Verdict::holds);
  EXPECT_EQ(judge(0.0049, 0.01), Verdict::too_loose);
  EXPECT_EQ(judge(0.0, 1e-9), Verdict::holds);  // rounding
  EXPECT_EQ(judge(0.0, 0.0), Verdict::holds);
  EXPECT_EQ(judge(1.0, 0.0), Verdict::worse);
  EXPECT_EQ(judge(std::nan(""), 1.0), Verdict::worse);
  EXPECT_EQ(judge(179.9, 179.9, Kind::records), Verdict::holds);
  EXPECT_EQ(judge(179.6, 179.9, Kind::records), Verdict::changed);
  EXPECT_EQ(judge(180.2, 179.9, Kind::records), Verdict::changed);
  EXPECT_EQ(judge(std::nan(""), 1.0, Kind::records), Verdict::changed);
}

/// The bound of a gate must be below the worst possible value.
TEST(Table, EveryGateCanFail) {
  const auto worst = [](std::string_view measure) {
    if (measure.starts_with("gamma")) return 180.0;
    if (measure.starts_with("sigma")) return 1.0;
    return std::numeric_limits<double>::infinity();
  };
  for (const Bound& bound : bounds()) {
    if (bound.kind == Kind::gate) {
      EXPECT_LT(bound.bound, 0.9 * worst(bound.measure)) << bound.scenario << ' ' << bound.algorithm;
    }
    if (bound.kind == Kind::gate && bound.measure == "misses") {
      EXPECT_EQ(bound.bound, 0.0) << bound.scenario << ' ' << bound.algorithm;
    }
  }
}

/// Every algorithm of default runs on every scenario. An algorithm that is recorded to miss the contact has only sigma,
/// misses and failures.
TEST(Table, LeavesNoAlgorithmAndNoScenarioOut) {
  Registry registry;
  register_all_algorithms(registry);
  for (const std::string& scenario : scenario_names()) {
    const std::string which = scenario == "III" ? "T" : "F";
    for (const auto& made : registry.all()) {
      const std::string& algorithm = made->traits().name;
      if (!made->traits().answers.respond || !made->traits().in_default_runs() || algorithm == "null") continue;
      std::map<std::string_view, Kind> kinds;
      for (const Bound& bound : bounds()) {
        if (bound.scenario == scenario && bound.algorithm == algorithm) kinds.emplace(bound.measure, bound.kind);
      }
      std::vector<std::string> wanted{"sigma_" + which, "misses", "failed"};
      if (kinds["misses"] == Kind::gate) {
        wanted.insert(wanted.end(),
                      {"gamma_" + which + "_deg", "noise_" + which, "jump_" + which, "gain_" + which, "nu_" + which});
      }
      for (const std::string& measure : wanted) {
        EXPECT_TRUE(kinds.contains(measure)) << scenario << ' ' << algorithm << ' ' << measure;
      }
    }
  }
}

TEST(Table, NamesMeasuresAndGivesReasons) {
  EXPECT_FALSE(bounds().empty());
  for (const Bound& bound : bounds()) {
    EXPECT_NE(find_metric(bound.measure), nullptr) << bound.measure;
    EXPECT_FALSE(bound.reason.empty());
    EXPECT_GE(bound.bound, 0.0);
  }
}

}  // namespace
}  // namespace sixdof
