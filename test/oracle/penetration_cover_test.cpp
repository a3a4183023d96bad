// The directions that a cover starts from. What it computes: penetration_test.cpp.

#include <sixdof/oracle/penetration_cover.h>

#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "bodies.h"

namespace sixdof::detail {
namespace {

using Eigen::Vector3d;

TEST(SphereTriangles, CoverTheSphereOnce) {
  ASSERT_EQ(sphere_triangles().size(), 20u);
  // The cone over a triangle of unit vectors has the solid angle 2 atan(|det| / (1 + sum of the cosines)).
  double sum = 0.0;
  for (const auto& t : sphere_triangles()) {
    const double cosines = t[0].dot(t[1]) + t[1].dot(t[2]) + t[2].dot(t[0]);
    sum += 2.0 * std::atan2(std::abs(t[0].dot(t[1].cross(t[2]))), 1.0 + cosines);
  }
  EXPECT_NEAR(sum, 4.0 * std::numbers::pi, 1e-12);
  std::mt19937_64 random(81);
  for (int i = 0; i < 200; ++i) {
    const Vector3d u = bodies::random_pose(random, 1.0).t.normalized();
    const auto contains = [&](const std::array<Vector3d, 3>& t) {
      Eigen::Matrix3d corners;
      corners << t[0], t[1], t[2];
      return (corners.inverse() * u).minCoeff() >= 0.0;
    };
    EXPECT_EQ(std::ranges::count_if(sphere_triangles(), contains), 1);
  }
}

TEST(SphereDirections, AreSpread) {
  ASSERT_EQ(sphere_directions().size(), 42u);
  for (const Vector3d& u : sphere_directions()) {
    EXPECT_NEAR(u.norm(), 1.0, 1e-15);
    double nearest = -1.0;
    for (const Vector3d& v : sphere_directions()) {
      if (&u != &v) nearest = std::max(nearest, u.dot(v));
    }
    EXPECT_NEAR(std::acos(nearest) * 180.0 / std::numbers::pi, 31.7, 0.1);
  }
}

}  // namespace
}  // namespace sixdof::detail
