#include <sixdof/measure/direction.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

constexpr double k_rounding_degrees = 1e-13;  // some units in the last place of 180 degrees

TEST(Direction, AnglesAreAccurateNearZeroAndNear180) {
  // An arc cosine gives 0 or 8.5e-7 for the first angle.
  const double tiny = 1e-9;
  const double tiny_degrees = tiny * 180.0 / std::numbers::pi;
  EXPECT_NEAR(angle_degrees({1, 0, 0}, {1, tiny, 0}), tiny_degrees, 1e-6 * tiny_degrees);
  EXPECT_NEAR(180.0 - angle_degrees({1, 0, 0}, {-1, 0, tiny}), tiny_degrees, k_rounding_degrees);
  EXPECT_NEAR(angle_degrees({0.3, -0.2, 0.7}, {0.6, -0.4, 1.4}), 0.0, 1e-6 * tiny_degrees);
  EXPECT_NEAR(angle_degrees({0, 2, 0}, {0, 3, 3}), 45.0, k_rounding_degrees);
  EXPECT_NEAR(angle_degrees({0, 2e-200, 0}, {0, 3e-200, 3e-200}), 45.0, k_rounding_degrees);
  EXPECT_NEAR(angle_degrees({0, 2e200, 0}, {3e200, 0, 0}), 90.0, k_rounding_degrees);
  EXPECT_EQ(angle_degrees({0, 0, 0}, {3, 0, 0}), 0.0);
}

TEST(Direction, EveryStepIsCountedOnce) {
  const std::vector<Eigen::Vector3d> ideal{{1, 0, 0}, {0, 5, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 2}, {0.1, 0, 0}};
  const std::vector<Eigen::Vector3d> measured{{0, 2, 0}, {0, 0, 0}, {1, 1, 1}, {0, 0, 0}, {0, 3, 3}, {1e-13, 0, 0}};
  const DirectionError error = direction_error(ideal, measured);
  EXPECT_EQ(error.compared, 2u);
  EXPECT_EQ(error.misses, 2u);  // the last one is zero against its series' peak
  EXPECT_EQ(error.false_contacts, 1u);
  EXPECT_EQ(error.skipped, 1u);
  EXPECT_NEAR(*error.gamma_degrees, (90.0 + 45.0) / 2.0, k_rounding_degrees);
  EXPECT_NEAR(error.largest_degrees, 90.0, k_rounding_degrees);
}

TEST(Direction, NoCommonStepGivesNoAngle) {
  const std::vector<Eigen::Vector3d> ideal{{1, 0, 0}, {2, 0, 0}};
  const std::vector<Eigen::Vector3d> zero(2, Eigen::Vector3d::Zero());
  const DirectionError error = direction_error(ideal, zero);
  EXPECT_FALSE(error.gamma_degrees);
  EXPECT_EQ(error.misses, 2u);
  EXPECT_THROW(direction_error(ideal, Vectors(zero).first(1)), BadArgument);
}

}  // namespace
}  // namespace sixdof
