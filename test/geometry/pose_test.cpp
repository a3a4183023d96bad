#include <sixdof/geometry/pose.h>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

constexpr double k_rounding = 1e-15;

const Pose k_first = Pose::from_quaternion(0.5, -0.1, 0.7, std::sqrt(1.0 - 0.75), {0.3, -1.2, 2.1});
const Pose k_second = Pose::from_quaternion(-0.6, 0.48, 0.0, 0.64, {-4.0, 0.7, 0.1});

TEST(Pose, ComposesAndInverts) {
  const Eigen::Vector3d p(0.9, 0.2, -1.7);
  EXPECT_TRUE(((k_first * k_second) * p).isApprox(k_first * (k_second * p), 4 * k_rounding));
  EXPECT_TRUE((k_first.inverse() * (k_first * p)).isApprox(p, 4 * k_rounding));
}

TEST(Pose, QuaternionHasPositiveScalar) {
  EXPECT_TRUE(k_second.quaternion().isApprox(Eigen::Vector4d(0.6, -0.48, 0.0, -0.64), k_rounding));
}

TEST(Pose, RefusesNonRotations) {
  EXPECT_THROW(Pose::from_quaternion(0.707107, 0, 0, 0, {0, 0, 0}), BadArgument);
  EXPECT_THROW(Pose::from_quaternion(0, 0, 0, 0, {0, 0, 0}), BadArgument);
  EXPECT_THROW(Pose::from_quaternion(std::nan(""), 0, 0, 1, {0, 0, 0}), BadArgument);
  EXPECT_THROW(Pose::from_quaternion(1, 0, 0, 0, {0, std::numeric_limits<double>::infinity(), 0}), BadArgument);
  // Rounded to seven digits: normalised.
  const Pose rounded = Pose::from_quaternion(0.7071068, 0.7071068, 0, 0, {0, 0, 0});
  EXPECT_NEAR(rounded.R.determinant(), 1.0, 4 * k_rounding);
}

}  // namespace
}  // namespace sixdof
