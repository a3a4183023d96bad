#include <sixdof/models/refine.h>

#include <map>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/models/recipe.h>

#include "quality.h"

namespace sixdof {
namespace {

// Rounding of midpoints, summed over thousands of triangles of size near 1.
constexpr double k_rounding = 1e-12;

TEST(Subdivide, KeepsTheSolidAndGivesTheExactCount) {
  const Mesh coarse = make_torus_knot({}, 1500);
  for (const std::size_t n : {std::size_t{1500}, std::size_t{1502}, std::size_t{6001}, std::size_t{20000}}) {
    const Mesh fine = subdivide(coarse, n, "fine");
    EXPECT_EQ(fine.triangles().size(), n + n % 2);
    EXPECT_TRUE(fine.solid()) << fine.why_not_solid();
    EXPECT_TRUE(fine.topology().manifold);
    EXPECT_EQ(fine.topology().euler_characteristic, 0);
    EXPECT_NEAR(fine.volume(), coarse.volume(), k_rounding);
    EXPECT_NEAR(fine.area(), coarse.area(), k_rounding);
    EXPECT_TRUE(fine.centroid().isApprox(coarse.centroid(), k_rounding) ||
                (fine.centroid() - coarse.centroid()).norm() < k_rounding);
    EXPECT_EQ(fine.box().sizes(), coarse.box().sizes());
    EXPECT_GE(smallest_angle_deg(fine), 0.5 * smallest_angle_deg(coarse) - 1e-6);
    EXPECT_EQ(fine.name(), "fine");
  }
}

TEST(Subdivide, SplitsTheLongestEdgesFirst) {
  const Mesh coarse = make_torus({}, 1000);
  const auto longest = [](const Mesh& mesh) {
    double length = 0.0;
    for (const Triangle& t : mesh.triangles()) {
      for (std::size_t k = 0; k < 3; ++k) {
        length = std::max(length, (mesh.vertices()[t[k]] - mesh.vertices()[t[(k + 1) % 3]]).norm());
      }
    }
    return length;
  };
  // Four times the triangles halve the edges; the longest first keeps them within the square root of 2 of one another.
  EXPECT_LT(longest(subdivide(coarse, 4000, "")), 0.75 * longest(coarse));
  EXPECT_LT(longest(subdivide(coarse, 16000, "")), 0.375 * longest(coarse));
}

TEST(Subdivide, HandlesBordersAndEdgesOfManyTriangles) {
  // Three triangles at one edge; all other edges have one.
  const Mesh leaves = Mesh::build({{0, 0, 0.1}, {0, 0, 2.7}, {1.1, 0, 1}, {-0.6, 0.9, 1}, {-0.5, -0.8, 1}},
                                  {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}});
  const Mesh fine = subdivide(leaves, 50, "leaves");
  EXPECT_GE(fine.triangles().size(), 50U);
  EXPECT_LE(fine.triangles().size(), 52U);
  EXPECT_NEAR(fine.area(), leaves.area(), k_rounding);
  EXPECT_EQ(fine.topology().components, 1U);
  EXPECT_GE(fine.topology().nonmanifold_edges, 2U);
  // No vertex lies on an edge that is not split: the border edges are the outline of the three and nothing else.
  double outline = 0.0;
  for (const Eigen::Vector3d& tip :
       {Eigen::Vector3d(1.1, 0, 1), Eigen::Vector3d(-0.6, 0.9, 1), Eigen::Vector3d(-0.5, -0.8, 1)}) {
    outline += (tip - Eigen::Vector3d(0, 0, 0.1)).norm() + (tip - Eigen::Vector3d(0, 0, 2.7)).norm();
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const Triangle& t : fine.triangles()) {
    for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
  }
  double border = 0.0;
  for (const auto& [edge, count] : uses) {
    if (count == 1) border += (fine.vertices()[edge.first] - fine.vertices()[edge.second]).norm();
  }
  EXPECT_NEAR(border, outline, k_rounding);
}

TEST(Subdivide, RefusesMoreThanTheMaximum) {
  EXPECT_THROW(subdivide(make_torus({}, 100), k_maximum_triangles + 1, "big"), BadArgument);
}

}  // namespace
}  // namespace sixdof
