#include <sixdof/oracle/shells.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../geometry/shapes.h"

namespace sixdof {
namespace {

constexpr double k_rounding = 1e-14;  // of the volume of a box

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

/// Two boxes, one in the other; the second is there twice and its last triangle is missing in the copy.
Mesh boxes() {
  const Mesh outer = shapes::box({1.0, 1.1, 1.2}), inner = shapes::box({0.3, 0.4, 0.5}, {0.1, 0.2, 0.3});
  std::vector<Eigen::Vector3d> vertices = outer.vertices();
  std::vector<Triangle> triangles = outer.triangles();
  for (int copy = 0; copy < 2; ++copy) {
    const auto n = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), inner.vertices().begin(), inner.vertices().end());
    for (const Triangle& t : inner.triangles()) triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  triangles.pop_back();
  return Mesh::build(std::move(vertices), std::move(triangles), "boxes");
}

TEST(Shells, AreWhatEdgesConnect) {
  const Mesh mesh = boxes();
  ASSERT_EQ(mesh.topology().components, 2u);  // it sees no copies
  const Shells shells = find_shells(mesh);
  ASSERT_EQ(shells.all.size(), 3u);
  const auto first = shells.of_triangle.begin();
  EXPECT_THAT(std::vector(first, first + 12), Each(0u));
  EXPECT_THAT(std::vector(first + 12, first + 24), Each(1u));
  EXPECT_THAT(std::vector(first + 24, first + 35), Each(2u));
  const Shell &outer = shells.all[0], &inner = shells.all[1], &copy = shells.all[2];
  EXPECT_TRUE(outer.closed && inner.closed && !copy.closed);
  EXPECT_TRUE(!outer.doubled && !inner.doubled && copy.doubled);
  EXPECT_NEAR(outer.volume, 8.0 * 1.0 * 1.1 * 1.2, k_rounding);
  EXPECT_NEAR(inner.volume, 8.0 * 0.3 * 0.4 * 0.5, k_rounding);
  EXPECT_EQ(copy.first_triangle, 24u);
  EXPECT_EQ(copy.triangles, 11u);
}

TEST(Shells, HaveWindingNumbersOfTheirOwn) {
  Mesh mesh = boxes();
  const Tree tree(mesh);
  std::vector<std::uint32_t> group = find_shells(mesh).of_triangle;
  for (std::uint32_t& g : group) g = g == 2 ? 7 : g;  // the open copy, apart
  const auto around = [&](const Eigen::Vector3d& p) {
    auto windings = windings_of_groups(tree, group, p);
    windings.erase(7);
    return windings;
  };
  EXPECT_THAT(around({2.0, 0.0, 0.0}), IsEmpty());
  EXPECT_THAT(around({0.9, 0.91, 0.92}), ElementsAre(Pair(0u, 1)));
  EXPECT_THAT(around({0.13, 0.24, 0.35}), ElementsAre(Pair(0u, 1), Pair(1u, 1)));
}

}  // namespace
}  // namespace sixdof
