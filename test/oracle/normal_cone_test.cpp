#include <sixdof/oracle/normal_cone.h>

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "../geometry/shapes.h"
#include "bodies.h"

namespace sixdof {
namespace {

using Eigen::Vector3d;

constexpr double k_rounding = 1e-6;  // degrees: angles near 0 keep half of the digits of the components

/// At an angle from x towards z, lifted towards y.
Vector3d direction(double degrees, double lift = 0.0) {
  const double a = degrees * std::numbers::pi / 180.0, b = lift * std::numbers::pi / 180.0;
  return {std::cos(a) * std::cos(b), std::sin(b), std::sin(a) * std::cos(b)};
}

TEST(NormalCone, AngleToARay) {
  const std::vector<Vector3d> ray{direction(20.0)};
  for (const double angle : {0.0, 37.0, 90.0, 142.0, 180.0}) {
    EXPECT_NEAR(angle_to_cone(direction(20.0 + angle), ray), angle, k_rounding);
  }
  EXPECT_EQ(angle_to_cone(direction(20.0), {}), 180.0);
}

TEST(NormalCone, AngleToAnArc) {
  const std::vector<Vector3d> arc{direction(10.0), direction(80.0)};
  EXPECT_NEAR(angle_to_cone(direction(33.0), arc), 0.0, k_rounding);
  EXPECT_NEAR(angle_to_cone(direction(33.0, 25.0), arc), 25.0, k_rounding) << "beside the arc";
  EXPECT_NEAR(angle_to_cone(direction(-5.0), arc), 15.0, k_rounding) << "before it begins";
  EXPECT_NEAR(angle_to_cone(direction(97.0), arc), 17.0, k_rounding);
  EXPECT_NEAR(angle_to_cone(-direction(33.0), arc), 180.0 - 47.0, k_rounding) << "behind: the nearer end";
}

TEST(NormalCone, AngleToACorner) {
  const std::vector<Vector3d> corner{Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  EXPECT_NEAR(angle_to_cone(Vector3d(0.6, 0.2, 0.7).normalized(), corner), 0.0, k_rounding);
  const Vector3d below(0.6, 0.7, -0.3);
  EXPECT_NEAR(angle_to_cone(below.normalized(), corner),
              std::atan2(0.3, std::hypot(0.6, 0.7)) * 180.0 / std::numbers::pi, k_rounding);
}

/// The least angle to many directions of a cone.
TEST(NormalCone, AgreesWithSamples) {
  shapes::Generator random(5);
  for (int i = 0; i < 40; ++i) {
    std::vector<Vector3d> generators;
    for (int k = 0; k < 5; ++k) {
      generators.push_back((shapes::unit_vector(random) + Vector3d(0.3, 0.8, 1.1)).normalized());
    }
    const Vector3d n = shapes::unit_vector(random);
    const double angle = angle_to_cone(n, generators);
    double least = 180.0;
    for (int k = 0; k < 40'000; ++k) {
      Vector3d sum = Vector3d::Zero();
      // Squares: more directions near the border of the cone.
      for (const Vector3d& g : generators) {
        const double x = shapes::uniform(random, 0.0, 1.0);
        sum += x * x * g;
      }
      least = std::min(least, std::atan2(n.cross(sum).norm(), n.dot(sum)) * 180.0 / std::numbers::pi);
    }
    EXPECT_LE(angle, least + k_rounding);
    EXPECT_NEAR(angle, least, 4.0) << "samples lie about so close";
  }
}

std::size_t count_near(const Tree& tree, const Vector3d& p) {
  std::vector<Vector3d> normals;
  normals_near(tree, p, 1e-9, normals);
  return normals.size();
}

TEST(NormalCone, NormalsOfABox) {
  const Mesh box = bodies::box({-0.7, -0.4, -0.9}, {0.8, 0.6, 0.5});
  const Tree tree(box);
  for (const double off : {0.0, 0.05}) {  // on the surface, and outside
    std::vector<Vector3d> normals;
    normals_near(tree, {0.21, 0.33, 0.5 + off}, 1e-9, normals);
    ASSERT_EQ(normals.size(), 1u);
    EXPECT_NEAR((normals[0] - Vector3d::UnitZ()).norm(), 0.0, 1e-15);
    EXPECT_EQ(count_near(tree, {0.8 + off, 0.33, 0.5 + off}), 2u) << "of an edge";
    EXPECT_EQ(count_near(tree, {0.8 + off, 0.6 + off, 0.5 + off}), 3u) << "of a corner";
  }
  EXPECT_EQ(count_near(tree, {0.21, 0.33, 0.45}), 1u) << "inside";
}

}  // namespace
}  // namespace sixdof
