#include <sixdof/algorithm/ist/sphere.h>

#include <cmath>

#include <gtest/gtest.h>

#include "random_spheres.h"

namespace sixdof::ist {
namespace {

constexpr double k_rounding = 1e-12;     // of a closed form with cancellation next to contact
constexpr double k_tiny_volume = 1e-13;  // of spheres that overlap by 1e-7: a lens is as large as its depth squared

/// Intersection volume of two spheres by slices across the line of centres: each is the smaller of two concentric
/// discs.
double overlap_by_slices(double r1, double r2, double d) {
  constexpr int n = 200'000;
  const double low = std::max(-r1, d - r2), high = std::min(r1, d + r2);
  if (low >= high) return 0.0;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double x = low + (high - low) * (i + 0.5) / n;
    sum += std::min(r1 * r1 - x * x, r2 * r2 - (x - d) * (x - d));
  }
  return std::numbers::pi * sum * (high - low) / n;
}

TEST(Sphere, OverlapVolumeAgreesWithSlices) {
  constexpr double k_slicing = 1e-9;  // midpoint rule with 2e5 slices on a piecewise parabola
  const double cases[][3] = {{1.0, 0.7, 1.1}, {0.7, 1.0, 0.5}, {0.3, 2.0, 1.9}, {1.3, 1.3, 0.01}, {1.0, 0.4, 0.6001}};
  for (const auto& [r1, r2, d] : cases) {
    EXPECT_NEAR(overlap_volume(r1, r2, d), overlap_by_slices(r1, r2, d), k_slicing) << r1 << ' ' << r2 << ' ' << d;
    EXPECT_DOUBLE_EQ(overlap_volume(r1, r2, d), overlap_volume(r2, r1, d));
  }
}

TEST(Sphere, OverlapVolumeIsContinuousAtContainmentAndAtTouching) {
  const double small = Sphere{{}, 0.4}.volume();
  EXPECT_DOUBLE_EQ(overlap_volume(1.0, 0.4, 0.3), small);
  EXPECT_NEAR(overlap_volume(1.0, 0.4, 0.6 + 1e-7), small, k_rounding);
  EXPECT_DOUBLE_EQ(overlap_volume(1.0, 0.4, 1.4), 0.0);
  EXPECT_NEAR(overlap_volume(1.0, 0.4, 1.4 - 1e-7), 0.0, k_tiny_volume);
  EXPECT_DOUBLE_EQ(overlap_volume(1.0, 1.0, 0.0), (Sphere{{}, 1.0}.volume()));
}

TEST(Sphere, EnclosingSphereEnclosesAndIsNearlySmallest) {
  const std::vector<Sphere> spheres = random_spheres(300, 11);
  const Sphere ball = enclosing_sphere(spheres);
  double reach = 0.0;
  for (const Sphere& s : spheres) reach = std::max(reach, (s.center - ball.center).norm() + s.radius);
  EXPECT_LE(reach, ball.radius);
  EXPECT_LE(ball.radius, reach * (1.0 + 1e-12));

  // Two spheres: the smallest ball is known.
  const std::vector<Sphere> two{{{0.3, -0.7, 1.1}, 0.5}, {{2.3, 0.9, 0.4}, 0.2}};
  const double smallest = 0.5 * ((two[0].center - two[1].center).norm() + 0.7);
  EXPECT_GE(enclosing_sphere(two).radius, smallest * (1.0 - 1e-12));
  EXPECT_LE(enclosing_sphere(two).radius, smallest * 1.05);
}

}  // namespace
}  // namespace sixdof::ist
