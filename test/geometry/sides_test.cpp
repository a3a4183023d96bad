#include <sixdof/geometry/sides.h>

#include <algorithm>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

auto key(const Side& s) { return std::tuple(s.low, s.high, s.corner, s.forward); }

/// The same by one sort of all sides.
std::vector<Side> sorted_by_comparison(const std::vector<Triangle>& triangles) {
  std::vector<Side> sides;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = triangles[t][k], to = triangles[t][(k + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), 3 * t + k, from < to});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return key(a) < key(b); });
  return sides;
}

TEST(SortedSides, AreByEdgeThenByCorner) {
  std::mt19937_64 generator(4711);
  for (const std::uint32_t vertices : {3u, 5u, 40u, 1000u}) {
    std::vector<Triangle> triangles(150);
    for (Triangle& t : triangles) {
      for (std::uint32_t& v : t) v = static_cast<std::uint32_t>(generator() % vertices);
    }
    const std::vector<Side> sides = sorted_sides(triangles);
    const std::vector<Side> expected = sorted_by_comparison(triangles);
    ASSERT_TRUE(std::ranges::equal(sides, expected, {}, key, key)) << vertices;
    std::size_t visited = 0;
    for_each_edge(sides, [&](std::span<const Side> edge) {
      for (const Side& s : edge) ASSERT_EQ(std::pair(s.low, s.high), std::pair(edge[0].low, edge[0].high));
      visited += edge.size();
    });
    EXPECT_EQ(visited, sides.size());
  }
  EXPECT_TRUE(sorted_sides({}).empty());
}

}  // namespace
}  // namespace sixdof
