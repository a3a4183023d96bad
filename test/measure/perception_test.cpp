// Perceptual scores of series made by hand: an error that is just at a threshold scores 1 in its unit and little in the
// others.

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <sixdof/base/error.h>
#include <sixdof/measure/perception.h>
#include <sixdof/measure/perception_thresholds.h>

namespace sixdof {
namespace {

constexpr double k_decibel_rounding = 1e-9;  // of a logarithm times 20
constexpr double k_leakage_of_window =
    0.01;  // the window spreads a tone over three lines, whose thresholds differ by some percent
constexpr double k_rounding = 1e-12;  // of a mean over the series

using perception::k_felt_mass;
using perception::k_full_force;

constexpr double k_rate = 1000.0;
constexpr std::size_t k_steps = 1000;

/// A force of constant magnitude and generic direction that turns slowly.
std::vector<Eigen::Vector3d> steady_force() {
  std::vector<Eigen::Vector3d> forces;
  for (std::size_t k = 0; k < k_steps; ++k) {
    const double angle = 0.3 + 0.5 * static_cast<double>(k) / k_steps;
    forces.emplace_back(3.0 * std::cos(angle), 3.0 * std::sin(angle), 1.5);
  }
  return forces;
}

TEST(Perception, RightResponseScoresZero) {
  const auto ideal = steady_force();
  const auto scores = perceptual_scores(ideal, ideal, 1.0, k_rate).value();
  EXPECT_EQ(scores.magnitude, 0.0);
  EXPECT_EQ(scores.direction, 0.0);
  EXPECT_EQ(scores.vibration, 0.0);
  EXPECT_EQ(scores.jump, 0.0);
  EXPECT_EQ(scores.pooled(), 0.0);
}

TEST(Perception, GainErrorOfTenPercentScoresOne) {
  const auto ideal = steady_force();
  auto measured = ideal;
  for (auto& force : measured) force *= 1.1;
  const auto scores = perceptual_scores(ideal, measured, 1.0, k_rate).value();
  EXPECT_NEAR(scores.magnitude, 1.0, k_rounding);
  EXPECT_NEAR(scores.direction, 0.0, k_rounding);
  EXPECT_LT(scores.vibration, 0.05);
  EXPECT_LT(scores.jump, 0.01);
  EXPECT_NEAR(perceptual_scores(ideal, measured, 1.1, k_rate)->magnitude, 0.0, k_rounding)
      << "a fitted gain absorbs it";
}

TEST(Perception, TurnOfThirtyDegreesScoresOne) {
  const auto ideal = steady_force();
  auto measured = ideal;
  for (auto& force : measured) {
    const Eigen::Vector3d axis = force.cross(Eigen::Vector3d(0.2, -0.7, 1.0)).normalized();
    const double angle = std::numbers::pi / 6.0;
    force = std::cos(angle) * force + std::sin(angle) * axis.cross(force);
  }
  const auto scores = perceptual_scores(ideal, measured, 1.0, k_rate).value();
  EXPECT_NEAR(scores.direction, 1.0, k_rounding);
  EXPECT_NEAR(scores.magnitude, 0.0, k_rounding);
  EXPECT_LT(scores.vibration, 0.5) << "a slow turn is no vibration";
}

/// Amplitude in N at which a vibration of the felt mass is just felt.
double threshold_force(double hz) {
  return vibration_threshold(hz) * k_felt_mass * std::pow(2.0 * std::numbers::pi * hz, 2);
}

TEST(Perception, BuzzOfHundredHertzAtItsThresholdScoresOne) {
  const auto ideal = steady_force();
  auto measured = ideal;
  const double unit = ideal[0].norm() / k_full_force;  // the peak is sent as the full force
  for (std::size_t k = 0; k < k_steps; ++k) {
    const double phase = 0.7 + 2.0 * std::numbers::pi * 100.0 * static_cast<double>(k) / k_rate;
    measured[k] += unit * threshold_force(100.0) * std::sin(phase) * Eigen::Vector3d(0.6, 0.0, 0.8);
  }
  const auto scores = perceptual_scores(ideal, measured, 1.0, k_rate).value();
  // A piece of 250 ms has lines 4 Hz apart; the window spreads the tone over three, whose thresholds differ by some
  // percent.
  EXPECT_NEAR(scores.vibration, 1.0, k_leakage_of_window);
  EXPECT_LT(scores.magnitude, 0.2) << "far below what is noticed as a change of force";
  EXPECT_LT(scores.direction, 0.1);
}

TEST(Perception, ThresholdHasThePublishedShape) {
  EXPECT_DOUBLE_EQ(vibration_threshold(250.0), perception::k_least_displacement);
  EXPECT_NEAR(20.0 * std::log10(vibration_threshold(62.5) / vibration_threshold(125.0)), 12.0, k_decibel_rounding)
      << "per octave";
  EXPECT_DOUBLE_EQ(vibration_threshold(10.0), vibration_threshold(40.0)) << "flat below";
  EXPECT_GT(vibration_threshold(500.0), vibration_threshold(250.0));
}

TEST(Perception, VibrationOutsideOfTheBandIsNotScored) {
  std::vector<double> slow, fast;
  for (std::size_t k = 0; k < 250; ++k) {
    slow.push_back(std::sin(2.0 * std::numbers::pi * 20.0 * static_cast<double>(k) / k_rate));
    fast.push_back(std::sin(2.0 * std::numbers::pi * 400.0 * static_cast<double>(k) / k_rate));
  }
  EXPECT_LT(buzz(slow, k_rate), 1e-6 * buzz(fast, k_rate) + 1e-3);
  EXPECT_LT(buzz(fast, k_rate), 1e-3);
}

TEST(Perception, JumpOfTenPercentScoresOne) {
  std::vector<Eigen::Vector3d> ideal(k_steps, Eigen::Vector3d(0.0, 2.0, 0.0)), measured = ideal;
  for (std::size_t k = 600; k < k_steps; ++k) measured[k] += Eigen::Vector3d(0.0, 0.2, 0.0);
  EXPECT_NEAR(perceptual_scores(ideal, measured, 1.0, k_rate)->jump, 1.0, k_rounding);
}

TEST(Perception, PoolsAsRootOfSquares) {
  const PerceptualScores scores{.magnitude = 1.0, .direction = 2.0, .vibration = 2.0, .jump = 4.0};
  EXPECT_DOUBLE_EQ(scores.pooled(), 5.0);
}

TEST(Perception, NothingToScoreIsEmpty) {
  const std::vector<Eigen::Vector3d> zero(10, Eigen::Vector3d::Zero()), one(10, Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(perceptual_scores(zero, one, 1.0, k_rate));
  EXPECT_FALSE(perceptual_scores(one, zero, 1.0, k_rate));
  EXPECT_THROW(perceptual_scores(one, std::span(one).first(9), 1.0, k_rate), BadArgument);
}

}  // namespace
}  // namespace sixdof
