#include <sixdof/stability/bodies.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace sixdof::stability {
namespace {

constexpr double k_rounding = 1e-14;        // of a sum over the sides
constexpr double k_sixth_rounding = 1e-16;  // of a volume of 1/6

TEST(Bodies, AreSolidWithTheVolumesOfTheirFormulas) {
  EXPECT_TRUE(box({2.0, 3.0, 0.5})->solid());
  EXPECT_DOUBLE_EQ(box({2.0, 3.0, 0.5})->volume(), 3.0);
  const MeshPointer corner = tetrahedron(
      {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()});
  EXPECT_TRUE(corner->solid());
  EXPECT_NEAR(corner->volume(), 1.0 / 6.0, k_sixth_rounding);
  // A prism over a regular polygon of n sides: n / 2 sin(2 pi / n) r^2 times its height.
  const MeshPointer prism = cylinder(0.5, 0.7, 24);
  EXPECT_TRUE(prism->solid());
  EXPECT_NEAR(prism->volume(), 12.0 * std::sin(std::numbers::pi / 12.0) * 0.25 * 1.4, k_rounding);
}

TEST(Bodies, RoundOnesConvergeFromInside) {
  const double ideal = 4.0 / 3.0 * std::numbers::pi;
  double error = ideal;
  for (const std::size_t sides : {8, 16, 32}) {
    const MeshPointer ball = sphere(1.0, sides);
    ASSERT_TRUE(ball->solid());
    const double now = ideal - ball->volume();
    EXPECT_GT(now, 0.0);
    EXPECT_LT(now, 0.4 * error) << sides;
    error = now;
    EXPECT_DOUBLE_EQ(ball->box().min().z(), -1.0);
    EXPECT_DOUBLE_EQ(ball->box().max().z(), 1.0);
  }
}

TEST(Bodies, ACapsuleHasItsLength) {
  const MeshPointer mesh = capsule(0.37, 0.5);
  EXPECT_TRUE(mesh->solid());
  EXPECT_DOUBLE_EQ(mesh->box().max().z(), 0.87);
  EXPECT_DOUBLE_EQ(mesh->box().min().z(), -0.87);
  EXPECT_DOUBLE_EQ(mesh->box().max().x(), 0.37);
}

TEST(Bodies, ZToTurnsThePole) {
  const Eigen::Vector3d direction = Eigen::Vector3d(0.3, -0.4, 0.866).normalized();
  EXPECT_LT((z_to(direction).pose() * Eigen::Vector3d::UnitZ() - direction).norm(), 1e-15);
}

}  // namespace
}  // namespace sixdof::stability
