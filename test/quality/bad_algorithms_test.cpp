// Each deliberately bad algorithm is a perfect one (a scenario's own ideal) with one fault. The measure meant for that
// fault must detect it, at the bound that the perfect algorithm passes.

#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

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
  EXPECT_LE(std::abs(measures_of(scenario, {}).at(measure)), bound) << scenario << " perfect";
  EXPECT_GT(std::abs(measures_of(scenario, spoil, late).at(measure)), bound) << scenario << " spoilt";
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
  for (const char* scenario : {"Ia", "Ib", "II", "III", "IV"}) {
    const char* const gain = scenario == std::string_view("III") ? "gain_T" : "gain_F";
    EXPECT_NEAR(measures_of(scenario, {}).at(gain), 1.0, k_rounding) << scenario;
    EXPECT_NEAR(measures_of(scenario, louder).at(gain), 1.1, k_rounding) << scenario;
  }
  // The paper's sigma does not change under a gain.
  EXPECT_NEAR(measures_of("II", louder).at("sigma_F"), 0.0, k_rounding);
}

TEST(BadAlgorithm, GainErrorOnPartOfThePathIsCaughtBySigma) {
  const Spoil louder = [](Response& r, double progress, std::size_t) {
    if (progress > 0.5) r.force *= 1.1;
  };
  for (const char* scenario : {"Ia", "II", "IV"}) expect_caught(scenario, "sigma_F", k_rounding, louder);
}

TEST(BadAlgorithm, ATremblingDirectionIsCaughtByItsSpectrum) {
  for (const char* scenario : {"Ia", "II", "IV"}) {
    const Spoil tremble = [](Response& r, double, std::size_t number) {
      const double angle = number % 2 == 0 ? 0.1 : -0.1;  // every other step: the highest frequency
      r.force = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * r.force;
    };
    EXPECT_NEAR(measures_of(scenario, {}).at("nu_direction_F"), 1.0, k_rounding) << scenario;
    // cos 0.1 of the direction stays, the rest of its energy is at half of the rate.
    EXPECT_NEAR(measures_of(scenario, tremble).at("nu_direction_F"), std::pow(std::cos(0.1), 2), k_rounding)
        << scenario;
    EXPECT_NEAR(measures_of(scenario, tremble).at("nu_F"), 1.0, k_rounding) << "magnitudes do not show it";
  }
}

TEST(BadAlgorithm, AWrongPenaltyIsCaughtThoughTheForceIsRight) {
  const Spoil half = [](Response& r, double progress, std::size_t) {
    if (progress > 0.5) r.penalty *= 0.5;
  };
  for (const char* scenario : {"Ia", "Ib", "II", "III", "IV"}) {
    expect_caught(scenario, "sigma_q", k_rounding, half);
    expect_caught(scenario, "sigma_gain_q", k_rounding, half);
    const char* const force = scenario == std::string_view("III") ? "sigma_T" : "sigma_F";
    EXPECT_NEAR(measures_of(scenario, half).at(force), 0.0, k_rounding) << scenario;
  }
}

TEST(BadAlgorithm, ALagOfThreeStepsIsCaughtByTheLag) {
  constexpr double k_late = 3.0;
  constexpr double k_half_step = 0.5;  // the largest error of the parabola between steps
  for (const char* scenario : {"II", "III", "IV"}) {
    EXPECT_NEAR(measures_of(scenario, {}).at("lag"), 0.0, k_half_step) << scenario;
    EXPECT_NEAR(measures_of(scenario, {}, k_late).at("lag"), k_late, k_half_step) << scenario;
  }
  // In II the direction rotates along the path, so a lag is an angle as well.
  constexpr double k_degrees_per_step = 360.0 / k_gate_steps;
  EXPECT_NEAR(measures_of("II", {}, k_late).at("gamma_F_deg"), k_late * k_degrees_per_step,
              k_rounding * k_degrees_per_step);
}

Bound bound_of(std::string_view measure, double bound, Kind kind) {
  return {"II", "exact", IdealLaw::volume, measure, bound, "", kind};
}

TEST(Table, BoundsFailWhereAValueIsWorse) {
  using enum Kind;
  const Bound rounding = bound_of("gamma_F_deg", 1e-9, required), never = bound_of("misses", 0.0, required);
  EXPECT_TRUE(holds(rounding, 0.0) && holds(rounding, -1e-9) && holds(never, 0.0));
  EXPECT_FALSE(holds(rounding, 2e-9) || holds(rounding, -2e-9) || holds(never, 1.0));
  EXPECT_FALSE(holds(rounding, std::nan("")) || holds(bound_of("lag", 1.0, characterised), std::nan("")));

  const Bound angle = bound_of("gamma_F_deg", 10.0, characterised);
  EXPECT_TRUE(holds(angle, 2.6) && holds(angle, 10.0) && holds(angle, 20.0));
  EXPECT_FALSE(holds(angle, 20.1));
  EXPECT_EQ(largest_defect(bound_of("gamma_F_deg", 100.0, characterised)), 140.0) << "half-way to 180";
  EXPECT_EQ(largest_defect(bound_of("sigma_F", 0.6, characterised)), 0.8) << "half-way to 1";

  const Bound energy = bound_of("nu_F", 0.5, characterised);  // 1.5 or 1 / 1.5
  EXPECT_TRUE(holds(energy, 1.0) && holds(energy, 1.9) && holds(energy, 0.51));
  EXPECT_FALSE(holds(energy, 2.1) || holds(energy, 0.49) || holds(energy, 0.0));
}

TEST(Table, MuchBetterFailsUntilTheTableSaysSo) {
  using enum Kind;
  EXPECT_FALSE(holds(bound_of("gamma_F_deg", 10.0, characterised), 2.4));
  EXPECT_FALSE(holds(bound_of("sigma_q", 0.1, characterised), 0.0));
  EXPECT_TRUE(holds(bound_of("sigma_F", 0.176, required), 0.0)) << "a limit";
  EXPECT_TRUE(holds(bound_of("noise_F", 0.1, characterised), 0.0) && holds(bound_of("nu_T", 0.1, characterised), 1.0));
}

TEST(Table, AGainHoldsWithinAFactor) {
  const Bound gain = bound_of("gain_F", 100.0, Kind::scale);
  EXPECT_TRUE(holds(gain, 100.0) && holds(gain, 149.0) && holds(gain, 67.0));
  EXPECT_FALSE(holds(gain, 151.0) || holds(gain, 66.0) || holds(gain, -100.0) || holds(gain, std::nan("")));
}

TEST(Table, EveryBoundCanFail) {
  for (const Bound& bound : bounds()) {
    if (bound.kind == Kind::weakness) continue;
    EXPECT_FALSE(holds(bound, worst_value(bound.measure))) << bound.measure;
    if (bound.kind == Kind::scale) {
      EXPECT_EQ(find_metric(bound.measure)->better, Better::neither) << bound.measure;
    }
  }
}

/// Every algorithm of default runs on every scenario. An algorithm that is known to miss the contact has only sigma,
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
      if (kinds["misses"] == Kind::required) {
        wanted.insert(wanted.end(), {"gamma_" + which + "_deg", "noise_" + which, "jump_" + which, "gain_" + which,
                                     "nu_" + which, "nu_direction_" + which, "sigma_q", "gain_q"});
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
    EXPECT_EQ(std::isnan(bound.bound), bound.kind == Kind::weakness) << bound.scenario << ' ' << bound.algorithm;
  }
}

}  // namespace
}  // namespace sixdof
