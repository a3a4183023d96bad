#include <sixdof/measure/path.h>

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

constexpr double k_sampled_shift = 1e-2;   // steps; the largest difference is 5e-6
constexpr double k_slope_left = 1e-4;      // what the slopes beside the step leave after the halvings
constexpr double k_work_rounding = 1e-12;  // of a sum along the path

constexpr double k_rounding = 16 * std::numeric_limits<double>::epsilon();
constexpr double k_full_angle = 2.0 * std::numbers::pi;

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
    const double angle = k_full_angle * (static_cast<double>(k) - late) / static_cast<double>(count);
    values.emplace_back(0.7 * std::cos(angle), 0.7 * std::sin(angle), 0.2);
  }
  return values;
}

TEST(Lag, FindsShiftsBetweenStepsAndTheirSign) {
  const std::vector<Eigen::Vector3d> ideal = orbit(400, 0.0);
  constexpr double k_parabola = 1e-3;  // a cosine is not a parabola; at 1 degree per step the difference is far below
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
  EXPECT_TRUE(lag(orbit(21, 0.0), orbit(21, 0.0), 10));  // one step more than twice the reach
}

/// A shift by 10 of 400 steps rotates the varying part by 9 degrees: 1 - correlation is about a^2 (1 - cos 9 degrees).
TEST(Lag, NeedsAnIdealThatVaries) {
  const auto wobble = [](double amplitude, double late) {
    std::vector<Eigen::Vector3d> values;
    for (int k = 0; k < 400; ++k) {
      const double angle = k_full_angle * (k - late) / 400.0;
      values.emplace_back(1.0, amplitude * std::cos(angle), amplitude * std::sin(angle));
    }
    return values;
  };
  EXPECT_FALSE(lag(wobble(5e-3, 0.0), wobble(5e-3, 3.0), 10));                        // 3e-7
  EXPECT_NEAR(*lag(wobble(2e-2, 0.0), wobble(2e-2, 3.0), 10), 3.0, k_sampled_shift);  // 5e-6
}

TEST(Lag, IsNotReadFromAConstant) {
  const std::vector<Eigen::Vector3d> constant(100, Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(lag(constant, constant, 10));
  EXPECT_FALSE(lag(orbit(100, 0.0), std::vector<Eigen::Vector3d>(100, Eigen::Vector3d::Zero()), 10));
  EXPECT_FALSE(lag(orbit(400, 0.0), orbit(400, 30.0), 10));  // beyond the reach
  EXPECT_FALSE(lag(orbit(20, 0.0), orbit(20, 0.0), 10));
}

TEST(Jump, TellsADiscontinuityFromASlope) {
  // A slope of 5 over the path, and a step of 0.25 between two steps of the path.
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
  EXPECT_NEAR(largest_jump(progress, slope, steep, 3, k_halvings), 0.1 / 4096.0, k_rounding * 100);
  EXPECT_NEAR(largest_jump(progress, step, stepped, 3, k_halvings), 0.25, k_slope_left);
  EXPECT_THROW(largest_jump(progress, {}, stepped, 3, 3), BadArgument);
  // More candidates than intervals, and nothing that changes.
  const std::vector<Eigen::Vector3d> same(2, Eigen::Vector3d(1, 2, 3));
  const auto constant = [](double) { return Eigen::Vector3d(1, 2, 3); };
  EXPECT_EQ(largest_jump(std::vector<double>{0.2, 0.6}, same, constant, 5, 4), 0.0);
  EXPECT_EQ(largest_jump(std::span(progress).first(1), Vectors(step).first(1), stepped, 3, 3), 0.0);
}

std::vector<Pose> circle(std::size_t count, double radius) {
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < count; ++k) {
    const double angle = k_full_angle * (static_cast<double>(k) + 0.3) / static_cast<double>(count);
    poses.push_back({Eigen::Matrix3d::Identity(), {radius * std::cos(angle), radius * std::sin(angle), 0.4}});
  }
  return poses;
}

TEST(LoopWork, IsZeroForARadialForceAndOneForATangentialOne) {
  const std::vector<Pose> poses = circle(90, 50.0);
  std::vector<Eigen::Vector3d> radial;
  std::vector<Eigen::Vector3d> tangential;
  for (const Pose& pose : poses) {
    const Eigen::Vector3d out(pose.t.x(), pose.t.y(), 0.0);
    radial.push_back(3.0 * out.normalized());
    tangential.push_back(3.0 * Eigen::Vector3d::UnitZ().cross(out).normalized());
  }
  const std::vector<Eigen::Vector3d> none(poses.size(), Eigen::Vector3d::Zero());
  EXPECT_NEAR(*loop_work(radial, none, poses, Eigen::Vector3d::Zero()), 0.0, k_rounding);
  // Mean of the two tangents of a chord of angle t, along the chord: cos(t / 2).
  EXPECT_NEAR(*loop_work(tangential, none, poses, Eigen::Vector3d::Zero()), std::cos(k_full_angle / 180.0), k_rounding);
  std::vector<Eigen::Vector3d> opposite;
  for (const Eigen::Vector3d& force : tangential) opposite.push_back(-force);
  EXPECT_NEAR(*loop_work(opposite, none, poses, Eigen::Vector3d::Zero()), std::cos(k_full_angle / 180.0), k_rounding);
  EXPECT_FALSE(loop_work(none, none, poses, Eigen::Vector3d::Zero()));
  EXPECT_THROW(loop_work(none, none, {}, Eigen::Vector3d::Zero()), BadArgument);
}

TEST(LoopWork, CountsTheTorqueOfARotation) {
  // A full rotation about an oblique axis under a torque that has a component along it.
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 2) / 3.0;
  const Eigen::Vector3d torque(0.3, 0.5, 1.1);
  std::vector<Pose> poses;
  for (int k = 0; k < 40; ++k) {
    const Eigen::Matrix3d rotation(Eigen::AngleAxisd(k_full_angle * k / 40.0, axis));
    poses.push_back({rotation, Eigen::Vector3d(4, 5, 6) - rotation * Eigen::Vector3d(0.5, -0.25, 2.0)});
  }
  const std::vector<Eigen::Vector3d> torques(poses.size(), torque);
  const std::vector<Eigen::Vector3d> none(poses.size(), Eigen::Vector3d::Zero());
  const double expected = std::abs(torque.dot(axis)) / torque.norm();
  EXPECT_NEAR(*loop_work(none, torques, poses, {0.5, -0.25, 2.0}), expected, k_work_rounding);
  // The reference point does not move, so the force does no work.
  EXPECT_NEAR(*loop_work(torques, torques, poses, {0.5, -0.25, 2.0}), expected, k_work_rounding);
  // A point off the axis moves along a circle; a force along it adds its work to the torque's.
  const Eigen::Vector3d off(1.5, 0.75, 2.0);
  std::vector<Eigen::Vector3d> along;
  double length = 0.0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Eigen::Vector3d here = poses[k] * off;
    const Eigen::Vector3d step = poses[(k + 1) % poses.size()] * off - here;
    length += step.norm();
    along.push_back(axis.cross(here - Eigen::Vector3d(4, 5, 6)).normalized());
  }
  const double force_work = length * std::cos(k_full_angle / 80.0);
  const double torque_work = k_full_angle * torque.dot(axis);
  EXPECT_NEAR(*loop_work(along, torques, poses, off),
              (force_work + torque_work) / (length + k_full_angle * torque.norm()), k_work_rounding);
}

}  // namespace
}  // namespace sixdof
