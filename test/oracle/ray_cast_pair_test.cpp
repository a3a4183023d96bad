#include <sixdof/oracle/ray_cast_pair.h>

#include <random>

#include <gtest/gtest.h>

#include "../configuration/shapes.h"

namespace sixdof {
namespace {

/// Corners lie within 2 of the origin; a handful of roundings of such numbers.
constexpr double k_rounding = 1e-14;

TriangleCorners random_triangle(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> coordinate(-0.5, 0.5);
  const auto point = [&] { return Eigen::Vector3d(coordinate(random), coordinate(random), coordinate(random)); };
  const Eigen::Vector3d center = point();
  return {center + size * point(), center + size * point(), center + size * point()};
}

TEST(MovingPair, HasTheDistanceOfTheTrianglesWhereTheyAre) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> translation(-1.0, 1.0);
  int intersecting = 0;
  for (int i = 0; i < 20'000; ++i) {
    TriangleCorners a = random_triangle(random, i % 2 == 0 ? 1.0 : 0.05);
    TriangleCorners b = random_triangle(random, i % 3 == 0 ? 1.0 : 0.05);
    if (i % 7 == 0) b[1] = b[0] + (a[1] - a[0]);          // parallel edges
    if (i % 11 == 0) a[2] = a[0] + 0.3 * (a[1] - a[0]);   // a triangle without area
    if (i % 13 == 0) b[2] = b[0] + 1e-7 * (b[2] - b[0]);  // a needle
    if (i % 17 == 0) b = {a[0] + Eigen::Vector3d(0.1, 0.2, 0.3), a[1] + Eigen::Vector3d(0.1, 0.2, 0.3), b[2]};
    const Eigen::Vector3d u = test::random_direction(random);
    const ray_cast::MovingPair pair(a, b, u);
    const double t = 0.3 * translation(random);
    const Eigen::Vector3d shift = t * u;
    const ClosestPoints expected = triangle_triangle_distance(a, {b[0] + shift, b[1] + shift, b[2] + shift});
    const ray_cast::MovingPair::Distance distance = pair.distance_at(t);
    ASSERT_NEAR(distance.value, expected.distance, k_rounding) << i;
    intersecting += expected.distance == 0.0 ? 1 : 0;
    if (expected.distance == 0.0) continue;
    EXPECT_NEAR(distance.slope, distance.axis.dot(u), k_rounding);
    EXPECT_NEAR(distance.axis.norm(), 1.0, k_rounding);
    // The axis separates the triangles by the distance.
    double gap = 10.0;
    for (const Eigen::Vector3d& p : a) {
      for (const Eigen::Vector3d& q : b) gap = std::min(gap, distance.axis.dot(q + shift - p));
    }
    if (expected.distance > 1e-3) {
      EXPECT_NEAR(gap, expected.distance, 1e3 * k_rounding) << i;
    }
  }
  EXPECT_GT(intersecting, 200);
}

}  // namespace
}  // namespace sixdof
