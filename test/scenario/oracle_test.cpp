// Ideal models against the exact overlap of the scenarios' own meshes, along the whole path.

#include <cmath>

#include <gtest/gtest.h>

#include <sixdof/measure/direction.h>
#include <sixdof/oracle/overlap.h>
#include <sixdof/scenario/scenario.h>

namespace sixdof {
namespace {

constexpr double k_order_margin = 0.3;  // of an order from two tessellations
constexpr double k_slope_error = 2e-3;  // relative: of a slope from a finite step

std::unique_ptr<Scenario> with(const char* name, int facets, const char* round) {
  Settings settings = scenario_settings(name);
  settings.set("facets", std::to_string(facets));
  settings.set("round", round);
  return make_scenario(name, settings);
}

/// The oracle of a scenario's pair with its trees and solids.
struct Oracle {
  explicit Oracle(const Scenario& scenario)
      : tree_a(scenario.a()), tree_b(scenario.b()), a(scenario.a(), tree_a), b(scenario.b(), tree_b), query(a, b) {}
  Overlap evaluate(const Pose& X_AB, const Eigen::Vector3d& reference) { return query.evaluate(X_AB, reference); }

  Tree tree_a, tree_b;
  Solid a, b;
  OverlapQuery query;
};

/// Largest errors along the path, relative to the largest value on it.
struct Errors {
  double volume = 0.0;
  double force = 0.0;
  double torque = 0.0;
};

Errors largest_errors(const Scenario& scenario, int steps) {
  Oracle oracle(scenario);
  Errors errors;
  double volume = 0.0;
  double force = 0.0;
  for (const double progress : scenario.steps(static_cast<std::size_t>(steps))) {
    const Pose pose = scenario.pose(progress);
    const Overlap overlap = oracle.evaluate(pose, pose * scenario.description().reference_b);
    const auto ideal = scenario.ideal(IdealLaw::gradient, progress);
    volume = std::max(volume, ideal->penalty);
    force = std::max({force, ideal->force.norm(), ideal->torque.norm() / scenario.description().reference_length});
    errors.volume = std::max(errors.volume, std::abs(overlap.volume - ideal->penalty));
    errors.force = std::max(errors.force, (overlap.area + ideal->force).norm());
    errors.torque = std::max(errors.torque, (overlap.moment + ideal->torque).norm());
  }
  return {errors.volume / volume, errors.force / force,
          errors.torque / (force * scenario.description().reference_length)};
}

/// Order of an error under halving of the facets' length.
double order(double coarse, double fine) { return std::log2(coarse / fine); }

TEST(IdealAgainstOracle, InscribedRoundPartsConvergeWithTheSquareOfTheFacets) {
  // Away from the ends of the block the polygon is the only error; at the ends, and for the sphere, it dominates.
  for (const char* name : {"Ia", "Ib", "II"}) {
    const Errors coarse = largest_errors(*with(name, 48, "inscribed"), 61);
    const Errors fine = largest_errors(*with(name, 96, "inscribed"), 61);
    EXPECT_NEAR(order(coarse.volume, fine.volume), 2.0, k_order_margin)
        << name << ' ' << coarse.volume << ' ' << fine.volume;
    EXPECT_GT(order(coarse.force, fine.force), 1.5) << name << ' ' << coarse.force << ' ' << fine.force;
    EXPECT_LT(fine.volume, 0.02) << name;
  }
}

TEST(IdealAgainstOracle, EqualAreasHaveSmallerErrors) {
  for (const char* name : {"Ia", "Ib", "II"}) {
    const Errors inscribed = largest_errors(*with(name, 96, "inscribed"), 61);
    const Errors equal = largest_errors(*with(name, 96, "equal_area"), 61);
    EXPECT_LT(equal.volume, 0.2 * inscribed.volume) << name;
    EXPECT_LT(equal.volume, 1e-3) << name;
    EXPECT_LT(equal.force, 2e-3) << name;
    EXPECT_LT(equal.torque, 2e-3) << name;
  }
}

TEST(IdealAgainstOracle, ConeIsExactWhereItsTipIsOverTheBlock) {
  const auto scenario = make_scenario("Ia");
  Oracle oracle(*scenario);
  constexpr double k_rounding = 1e-12;
  for (const double progress : scenario->steps(37)) {
    if (!scenario->in_window(progress)) continue;
    const Pose pose = scenario->pose(progress);
    const Overlap overlap = oracle.evaluate(pose, pose * scenario->description().reference_b);
    const auto ideal = scenario->ideal(IdealLaw::gradient, progress);
    EXPECT_NEAR(overlap.volume / ideal->penalty, 1.0, k_rounding);
    EXPECT_LT((overlap.area + ideal->force).norm(), k_rounding * ideal->force.norm());
    EXPECT_LT(overlap.moment.norm(), k_rounding * ideal->force.norm() * 900.0);
  }
}

// III has no round part in contact: exact. At phi = 0 the gradient is a set.
TEST(IdealAgainstOracle, PinsHaveFlatWalls) {
  const auto scenario = make_scenario("III");
  Oracle oracle(*scenario);
  constexpr double k_rounding = 1e-12;  // of integrals of about 1e4
  for (const double progress : scenario->steps(23)) {
    if (!scenario->in_window(progress)) continue;
    const Pose pose = scenario->pose(progress);
    const Overlap overlap = oracle.evaluate(pose, pose * scenario->description().reference_b);
    const auto ideal = scenario->ideal(IdealLaw::gradient, progress);
    EXPECT_NEAR(overlap.volume, ideal->penalty, k_rounding * 1e4) << progress;
    EXPECT_LT((overlap.area + ideal->force).norm(), k_rounding * 1e4) << progress;
    EXPECT_LT((overlap.moment + ideal->torque).norm(), k_rounding * 1e4) << progress;
    const auto energy = scenario->ideal(IdealLaw::energy, progress);
    EXPECT_LT((overlap.volume * overlap.area + energy->force).norm(), k_rounding * 1e8) << progress;
    EXPECT_LT((overlap.volume * overlap.moment + energy->torque).norm(), k_rounding * 1e8) << progress;
  }
}

TEST(IdealAgainstOracle, OrbitingPinsConvergeWithTheirRoundPin) {
  const auto worst = [](int facets) {
    const auto scenario = with("IV", facets, "equal_area");
    Oracle oracle(*scenario);
    Errors errors;
    for (const double progress : scenario->steps(28)) {
      const Pose pose = scenario->pose(progress);
      const Overlap overlap = oracle.evaluate(pose, pose * scenario->description().reference_b);
      const auto ideal = scenario->ideal(IdealLaw::gradient, progress);
      errors.volume = std::max(errors.volume, std::abs(overlap.volume / ideal->penalty - 1.0));
      errors.force = std::max(errors.force, (overlap.area + ideal->force).norm() / ideal->force.norm());
      errors.torque = std::max(errors.torque, (overlap.moment + ideal->torque).norm() / (20.0 * ideal->force.norm()));
    }
    return errors;
  };
  const Errors coarse = worst(48);
  const Errors fine = worst(192);
  EXPECT_GT(order(coarse.volume, fine.volume), 2.0) << coarse.volume << ' ' << fine.volume;
  EXPECT_LT(fine.volume, 2e-4);
  EXPECT_LT(fine.force, 2e-4);
  EXPECT_LT(fine.torque, 2e-4);
}

/// The superfluous contact exists: moving B down by a small step adds the plate's whole contact area times the step to
/// V, moving it up subtracts only what the ideal says.
TEST(IdealAgainstOracle, ThePlateLiesOnTheBlock) {
  constexpr double k_step = 1e-4;
  for (const char* name : {"III", "IV"}) {
    const auto scenario = make_scenario(name);
    Oracle oracle(*scenario);
    for (const double progress : {0.06, 0.43, 0.81}) {
      const auto slope = [&](double step) {
        Pose pose = scenario->pose(progress);
        const double here = oracle.evaluate(pose, pose.t).volume;
        pose.t.z() += step;
        return (oracle.evaluate(pose, pose.t).volume - here) / step;
      };
      const double lift = scenario->ideal(IdealLaw::gradient, progress)->force.z();
      EXPECT_NEAR(slope(k_step), -lift, k_slope_error * lift) << name << ' ' << progress;  // 96 facets in IV
      // A plate of 80 x 40; less than half of it is over the holes or, in III, beside the block.
      EXPECT_LT(slope(-k_step), -1000.0) << name << ' ' << progress;
    }
  }
}

}  // namespace
}  // namespace sixdof
