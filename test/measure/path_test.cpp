#include <sixdof/measure/path.h>

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

constexpr double k_rounding = 16 * std::numeric_limits<double>::epsilon();
constexpr double k_turn = 2.0 * std::numbers::pi;

TEST(Leakage, IsScaledByTheReferenceLength) {
  const std::vector<Eigen::Vector3d> forces{{3, 4, 0}, {0, 0, 12}};
  const std::vector<Eigen::Vector3d> torques{{0, 6, 8}, {0, 24, 0}};
  const double length = 30.0;
  EXPECT_NEAR(*leakage(torques, forces, 1.0 / length), std::sqrt((100.0 + 576.0) / (25.0 + 144.0)) / length,
              k_rounding);
  EXPECT_NEAR(*leakage(forces, torques, length), std::sqrt((25.0 + 144.0) / (100.0 + 576.0)) * length,
              k_rounding * length);
  EXPECT_FALSE(leakage(forces, std::vector<Eigen::Vector3d>(2, Eigen::Vector3d::Zero()), 1.0));
  EXPECT_THROW(leakage(forces, {}, 1.0), BadArgument);
}

std::vector<Eigen::Vector3d> orbit(std::size_t count, double late) {
  std::vector<Eigen::Vector3d> values;
  for (std::size_t k = 0; k < count; ++k) {
    const double angle = k_turn * (static_cast<double>(k) - late) / static_cast<double>(count);
    values.emplace_back(0.7 * std::cos(angle), 0.7 * std::sin(angle), 0.2);
  }
  return values;
}

TEST(Lag, FindsShiftsBetweenStampsAndTheirSign) {
  const std::vector<Eigen::Vector3d> ideal = orbit(400, 0.0);
  constexpr double k_parabola = 1e-3;  // a cosine is not a parabola; at 1 degree per stamp the rest is far below
  EXPECT_NEAR(*lag(ideal, orbit(400, 3.0), 10), 3.0, k_parabola);
  EXPECT_NEAR(*lag(ideal, orbit(400, -2.25), 10), -2.25, k_parabola);
  EXPECT_NEAR(*lag(ideal, ideal, 10), 0.0, k_parabola);
}

TEST(Lag, IsFoundUpToItsReachOnBothSides) {
  const std::vector<Eigen::Vector3d> ideal = orbit(400, 0.0);
  constexpr double k_parabola = 1e-2;
  EXPECT_NEAR(*lag(ideal, orbit(400, 9.0), 10), 9.0, k_parabola);
  EXPECT_NEAR(*lag(ideal, orbit(400, -9.0), 10), -9.0, k_parabola);
  EXPECT_FALSE(lag(ideal, orbit(400, -30.0), 10));
  EXPECT_TRUE(lag(orbit(21, 0.0), orbit(21, 0.0), 10));  // one stamp more than twice the reach
}

/// A shift by 10 of 400 stamps turns the varying part by 9 degrees: 1 - correlation is about a^2 (1 - cos 9 degrees).
TEST(Lag, NeedsAnIdealThatVaries) {
  const auto wobble = [](double amplitude, double late) {
    std::vector<Eigen::Vector3d> values;
    for (int k = 0; k < 400; ++k) {
      const double angle = k_turn * (k - late) / 400.0;
      values.emplace_back(1.0, amplitude * std::cos(angle), amplitude * std::sin(angle));
    }
    return values;
  };
  EXPECT_FALSE(lag(wobble(5e-3, 0.0), wobble(5e-3, 3.0), 10));             // 3e-7
  EXPECT_NEAR(*lag(wobble(2e-2, 0.0), wobble(2e-2, 3.0), 10), 3.0, 1e-2);  // 5e-6
}

TEST(Lag, IsNotReadFromAConstant) {
  const std::vector<Eigen::Vector3d> constant(100, Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(lag(constant, constant, 10));
  EXPECT_FALSE(lag(orbit(100, 0.0), std::vector<Eigen::Vector3d>(100, Eigen::Vector3d::Zero()), 10));
  EXPECT_FALSE(lag(orbit(400, 0.0), orbit(400, 30.0), 10));  // beyond the reach
  EXPECT_FALSE(lag(orbit(20, 0.0), orbit(20, 0.0), 10));
}

TEST(Jump, TellsADiscontinuityFromASlope) {
  // A slope of 5 over the path, and a step of 0.25 at an odd place.
  const auto steep = [](double s) { return Eigen::Vector3d(5.0 * s, 0.0, 1.0); };
  const auto stepped = [](double s) { return Eigen::Vector3d(0.0, s > 0.6180339 ? 0.25 : 0.0, 5.0 * s); };
  constexpr std::size_t k_halvings = 12;
  std::vector<double> progress;
  std::vector<Eigen::Vector3d> slope;
  std::vector<Eigen::Vector3d> step;
  for (int k = 0; k <= 50; ++k) {
    progress.push_back(k / 50.0);
    slope.push_back(steep(progress.back()));
    step.push_back(stepped(progress.back()));
  }
  const Jump smooth = largest_jump(progress, slope, steep, 3, k_halvings);
  EXPECT_NEAR(smooth.coarse, 0.1, k_rounding);
  EXPECT_NEAR(smooth.refined, 0.1 / 4096.0, k_rounding * 100);
  const Jump jumping = largest_jump(progress, step, stepped, 3, k_halvings);
  EXPECT_NEAR(jumping.coarse, std::hypot(0.25, 0.1), k_rounding);
  EXPECT_NEAR(jumping.refined, 0.25, 1e-4);
  EXPECT_NEAR(jumping.where, 0.6180339, 0.02 / 4096.0);
  EXPECT_THROW(largest_jump(progress, {}, stepped, 3, 3), BadArgument);
  // More candidates than intervals, and nothing that changes: the first interval's middle.
  const std::vector<double> ends{0.2, 0.6};
  const std::vector<Eigen::Vector3d> same(2, Eigen::Vector3d(1, 2, 3));
  const Jump none = largest_jump(
      ends, same, [](double) { return Eigen::Vector3d(1, 2, 3); }, 5, 4);
  EXPECT_EQ(none.refined, 0.0);
  EXPECT_NEAR(none.where, 0.4, k_rounding);
  EXPECT_EQ(largest_jump(std::span(progress).first(1), Vectors(step).first(1), stepped, 3, 3).coarse, 0.0);
}

std::vector<Pose> circle(std::size_t count, double radius) {
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < count; ++k) {
    const double angle = k_turn * (static_cast<double>(k) + 0.3) / static_cast<double>(count);
    poses.push_back({Eigen::Matrix3d::Identity(), {radius * std::cos(angle), radius * std::sin(angle), 0.4}});
  }
  return poses;
}

TEST(LoopWork, VanishesForARadialForceAndIsOneForADrivingOne) {
  const std::vector<Pose> poses = circle(90, 50.0);
  std::vector<Eigen::Vector3d> radial;
  std::vector<Eigen::Vector3d> driving;
  for (const Pose& pose : poses) {
    const Eigen::Vector3d out(pose.t.x(), pose.t.y(), 0.0);
    radial.push_back(3.0 * out.normalized());
    driving.push_back(3.0 * Eigen::Vector3d::UnitZ().cross(out).normalized());
  }
  const std::vector<Eigen::Vector3d> none(poses.size(), Eigen::Vector3d::Zero());
  EXPECT_NEAR(*loop_work(radial, none, poses, Eigen::Vector3d::Zero()), 0.0, k_rounding);
  // Mean of the two tangents of a chord of angle t, along the chord: cos(t / 2).
  EXPECT_NEAR(*loop_work(driving, none, poses, Eigen::Vector3d::Zero()), std::cos(k_turn / 180.0), k_rounding);
  std::vector<Eigen::Vector3d> braking;
  for (const Eigen::Vector3d& force : driving) braking.push_back(-force);
  EXPECT_NEAR(*loop_work(braking, none, poses, Eigen::Vector3d::Zero()), std::cos(k_turn / 180.0), k_rounding);
  EXPECT_FALSE(loop_work(none, none, poses, Eigen::Vector3d::Zero()));
  EXPECT_THROW(loop_work(none, none, {}, Eigen::Vector3d::Zero()), BadArgument);
}

TEST(LoopWork, CountsTheTorqueOfATurn) {
  // A full turn about an oblique axis under a torque that has a part along it.
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 2) / 3.0;
  const Eigen::Vector3d torque(0.3, 0.5, 1.1);
  std::vector<Pose> poses;
  for (int k = 0; k < 40; ++k) {
    const Eigen::Matrix3d rotation(Eigen::AngleAxisd(k_turn * k / 40.0, axis));
    poses.push_back({rotation, Eigen::Vector3d(4, 5, 6) - rotation * Eigen::Vector3d(0.5, -0.25, 2.0)});
  }
  const std::vector<Eigen::Vector3d> torques(poses.size(), torque);
  const std::vector<Eigen::Vector3d> none(poses.size(), Eigen::Vector3d::Zero());
  const double expected = std::abs(torque.dot(axis)) / torque.norm();
  EXPECT_NEAR(*loop_work(none, torques, poses, {0.5, -0.25, 2.0}), expected, 1e-12);
  // The reference point stands still, so a force there does no work but one elsewhere does not enter either.
  EXPECT_NEAR(*loop_work(torques, torques, poses, {0.5, -0.25, 2.0}), expected, 1e-12);
  // A point off the axis goes round too; a force along its way adds its work to the torque's.
  const Eigen::Vector3d off(1.5, 0.75, 2.0);
  std::vector<Eigen::Vector3d> along;
  double length = 0.0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Eigen::Vector3d here = poses[k] * off;
    const Eigen::Vector3d step = poses[(k + 1) % poses.size()] * off - here;
    length += step.norm();
    along.push_back(axis.cross(here - Eigen::Vector3d(4, 5, 6)).normalized());
  }
  const double force_work = length * std::cos(k_turn / 80.0);
  const double torque_work = k_turn * torque.dot(axis);
  EXPECT_NEAR(*loop_work(along, torques, poses, off), (force_work + torque_work) / (length + k_turn * torque.norm()),
              1e-12);
}

}  // namespace
}  // namespace sixdof
