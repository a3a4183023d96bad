#include <sixdof/conformance/poses.h>

#include <algorithm>

#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>

namespace sixdof::conformance {
namespace {

std::ptrdiff_t count(const Pair& pair, Place place) { return std::ranges::count(pair.cases, place, &Case::place); }

/// Brute force knows distances and crossings of surfaces without the oracles.
TEST(ConformancePoses, HaveTheTruthOfBruteForce) {
  const auto brute_force = make_brute_force_algorithm();
  for (const Pair& pair : pairs()) {
    const auto query = brute_force->prepare(pair.a, pair.b, brute_force->settings());
    for (std::size_t i = 0; i < pair.cases.size(); i += 3) {
      const Case& each = pair.cases[i];
      const double distance = query->distance(each.pose.X_AB).value.distance;
      EXPECT_NEAR(distance, each.distance, 1e-14 * (pair.a.diagonal() + pair.b.diagonal()));
      EXPECT_EQ(distance == 0.0, each.place == Place::overlapping);
    }
  }
}

TEST(ConformancePoses, AreOfAllKindsAndClear) {
  std::ptrdiff_t apart = 0, overlapping = 0, contained = 0;
  for (const Pair& pair : pairs()) {
    EXPECT_TRUE(pair.a.solid() && pair.b.solid());
    apart += count(pair, Place::apart);
    overlapping += count(pair, Place::overlapping);
    contained += count(pair, Place::contained);
    for (const Case& each : pair.cases) {
      if (each.place == Place::apart) {
        EXPECT_GE(each.distance, 0.02 * pair.a.diagonal());
      }
      if (each.place == Place::overlapping) {
        EXPECT_GE(each.volume, 0.05 * std::min(pair.a.volume(), pair.b.volume()));
        EXPECT_GT(each.force.norm(), 0.0);
      }
      // No entry of a generic rotation is 0 or 1.
      EXPECT_GT(each.pose.X_AB.R.cwiseAbs().minCoeff(), 1e-6);
    }
  }
  EXPECT_EQ(apart, overlapping);
  EXPECT_GE(apart, 20);
  EXPECT_GE(contained, 10);
}

TEST(ConformancePoses, OfAnOpenSurface) {
  const Pair pair = open_pair();
  EXPECT_FALSE(pair.b.topology().closed);
  EXPECT_EQ(count(pair, Place::apart), count(pair, Place::overlapping));
}

}  // namespace
}  // namespace sixdof::conformance
