#include <sixdof/oracle/seed_corners.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/models/model_catalogue.h>

#include "../configuration/shapes.h"

namespace sixdof::detail {
namespace {

constexpr double k_float_rounding = 1e-5;  // relative to the radius: of corners in floats

/// The least squared distance of a corner from p, one by one.
double least_squared(const Tree& tree, const Eigen::Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Tree::Corners& triangle : tree.corners()) {
    for (const Eigen::Vector3d& corner : triangle) least = std::min(least, (corner - tree.center() - p).squaredNorm());
  }
  return least;
}

TEST(FindCorner, FindsACornerAboutAsCloseAsTheClosest) {
  std::mt19937_64 random(71);
  std::uniform_real_distribution<double> factor(0.2, 2.5);
  std::vector<CornerVolume> stack;
  for (const char* name : {"torus-knot-2000", "box-300", "bumpy-sphere-600", "cone-1k"}) {
    const Tree tree(load_model(name));
    const double equal = 32.0 * tree.radius() * tree.radius() / static_cast<double>(tree.leaves().size());
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d p = factor(random) * tree.radius() * test::random_direction(random);
      const float at[3] = {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
      const double least = least_squared(tree, p);
      for (const float tolerance : {1.0f, 1.1f}) {
        Corner corner{1e30f, 0, 0, {}};
        ASSERT_TRUE(find_corner(tree, at, CornerEffort{.tolerance = tolerance}, corner, stack)) << name;
        EXPECT_LE(static_cast<double>(corner.squared), 1.0001 * static_cast<double>(tolerance) * least + equal) << name;
        // It is a corner of the triangle that it names, at that distance.
        double nearest = std::numeric_limits<double>::infinity();
        const Eigen::Vector3d point(corner.point[0], corner.point[1], corner.point[2]);
        for (const Eigen::Vector3d& c : tree.corners()[triangle_of(tree, corner)]) {
          nearest = std::min(nearest, (c - tree.center() - point).norm());
        }
        EXPECT_LE(nearest, 1e-6 * tree.radius());
        EXPECT_NEAR((point - p).norm(), std::sqrt(static_cast<double>(corner.squared)),
                    k_float_rounding * tree.radius());
        // Nothing is closer than that by more than the tolerance.
        Corner closer = corner;
        closer.squared = static_cast<float>(0.999 * least);
        EXPECT_FALSE(find_corner(tree, at, CornerEffort{.tolerance = tolerance}, closer, stack));
        EXPECT_EQ(closer.leaf, corner.leaf);
      }
    }
  }
}

TEST(FindCorner, OfFewLeavesFindsOneThatIsNotMuchFarther) {
  std::mt19937_64 random(72);
  std::vector<CornerVolume> stack;
  const Tree tree(load_model("torus-knot-2000"));
  double sum = 0.0, sum_of_all = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p = 1.5 * tree.radius() * test::random_direction(random);
    const float at[3] = {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
    Corner of_all{1e30f, 0, 0, {}}, of_few = of_all;
    ASSERT_TRUE(find_corner(tree, at, CornerEffort{.leaf_areas = 0.0f}, of_all, stack));
    ASSERT_TRUE(find_corner(tree, at, CornerEffort{.leaf_areas = 0.0f, .most_leaves = 2}, of_few, stack));
    EXPECT_NEAR(static_cast<double>(of_all.squared), least_squared(tree, p),
                k_float_rounding * tree.radius() * tree.radius());
    EXPECT_GE(of_few.squared, of_all.squared);
    sum += std::sqrt(static_cast<double>(of_few.squared));
    sum_of_all += std::sqrt(static_cast<double>(of_all.squared));
  }
  EXPECT_GT(sum, sum_of_all);  // the limit holds
  EXPECT_LT(sum, 1.2 * sum_of_all);
}

TEST(SeedCorners, AreCornersSpreadOverTheSurface) {
  for (const char* name : {"torus-knot-2000", "box-300", "bumpy-sphere-600"}) {
    const Tree tree(load_model(name));
    const SeedCorners seeds(tree);
    for (std::size_t i = 0; i < SeedCorners::k_count; ++i) {
      const Tree::Leaf& leaf = tree.leaves()[seeds.leaf[i]];
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(seeds.point[k][i], leaf.corner[0][k][0]) << name;
    }
    // Every corner has a seed nearby.
    for (const Tree::Corners& triangle : tree.corners()) {
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < SeedCorners::k_count; ++i) {
        const Eigen::Vector3d seed(seeds.point[0][i], seeds.point[1][i], seeds.point[2][i]);
        nearest = std::min(nearest, (triangle[0] - tree.center() - seed).norm());
      }
      EXPECT_LT(nearest, 0.6 * tree.radius()) << name;
    }
  }
}

}  // namespace
}  // namespace sixdof::detail
