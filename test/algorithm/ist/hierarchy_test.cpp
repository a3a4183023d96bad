#include <sixdof/algorithm/ist/hierarchy.h>

#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>

#include "random_spheres.h"

namespace sixdof::ist {
namespace {

constexpr double k_rounding = 1e-12;
constexpr double k_single = 1e-6;  // some roundings to single precision of numbers up to 1

/// Checks that every leaf below `node` lies in `bound` and in all its ancestors, counts leaves and returns the volume
/// below.
double check_subtree(const SphereTree& tree, std::size_t node, const Sphere& bound, std::vector<int>& seen,
                     std::vector<Sphere> ancestors) {
  ancestors.push_back(bound);
  double volume = 0.0;
  const std::size_t children = tree.children(node);
  EXPECT_GE(children, 1u);
  for (std::size_t slot = children; slot < SphereNode::k_slots; ++slot) EXPECT_LT(tree.nodes[node].r[slot], 0.0f);
  for (std::size_t slot = 0; slot < children; ++slot) {
    double below = 0.0;
    const Sphere ball = tree.ball(node, slot);
    if (tree.first_child[node] < 0) {
      const std::size_t leaf = static_cast<std::size_t>(~tree.first_child[node]) + slot;
      ++seen[leaf];
      below = tree.weight(static_cast<std::int32_t>(leaf)) * tree.leaves[leaf].volume();
      ancestors.push_back(ball);
      for (const Sphere& ancestor : ancestors) {
        const double reach = (tree.leaves[leaf].center - ancestor.center).norm() + tree.leaves[leaf].radius;
        EXPECT_LE(reach, ancestor.radius * (1.0 + k_rounding));
      }
      ancestors.pop_back();
      EXPECT_LT(ball.radius, tree.leaves[leaf].radius + k_single * tree.bound.radius);
    } else {
      below = check_subtree(tree, static_cast<std::size_t>(tree.first_child[node]) + slot, ball, seen, ancestors);
    }
    EXPECT_NEAR(tree.volumes[node][slot], below, k_rounding * below);
    volume += below;
  }
  return volume;
}

TEST(SphereTree, HasEveryLeafOnceAndInsideAllItsAncestors) {
  for (const std::size_t count : {1u, 2u, 4u, 5u, 17u, 3000u}) {
    SphereTree tree = build_sphere_tree(random_spheres(count, 5));
    for (const bool weighted : {false, true}) {
      if (weighted) {
        std::vector<double> weights(count);
        for (std::size_t i = 0; i < count; ++i) weights[i] = 1.0 + 0.01 * static_cast<double>(i % 97);
        set_weights(tree, std::move(weights));
      }
      std::vector<int> seen(tree.leaves.size(), 0);
      const double volume = check_subtree(tree, 0, tree.bound, seen, {});
      EXPECT_EQ(seen, std::vector<int>(count, 1));
      EXPECT_NEAR(volume, tree.volume, k_rounding * tree.volume);
    }
  }
}

/// Empty slots are tested too, so they cost time.
TEST(SphereTree, HasNearlyFullNodesOfLeaves) {
  const SphereTree tree = build_sphere_tree(random_spheres(3000, 7));
  const auto of_leaves =
      std::count_if(tree.first_child.begin(), tree.first_child.end(), [](std::int32_t child) { return child < 0; });
  EXPECT_GT(static_cast<double>(tree.leaves.size()) / static_cast<double>(of_leaves),
            3.0);  // with clusters only it would be 2
}

TEST(SphereTree, SplitsConcentricSpheres) {
  std::vector<Sphere> same(100, Sphere{{0.3, 0.4, 0.5}, 0.1});
  const SphereTree tree = build_sphere_tree(same);
  std::vector<int> seen(100, 0);
  check_subtree(tree, 0, tree.bound, seen, {});
  EXPECT_EQ(seen, std::vector<int>(100, 1));
}

TEST(SphereTree, HasTheSameBitsForAnyNumberOfThreads) {
  const auto build_with = [](unsigned threads) {
    SphereTree tree;
    parallel::with_threads(threads, [&] { tree = build_sphere_tree(random_spheres(9000, 6)); });
    return tree;
  };
  const SphereTree one = build_with(1), two = build_with(2);
  ASSERT_EQ(one.nodes.size(), two.nodes.size());
  EXPECT_EQ(std::memcmp(one.nodes.data(), two.nodes.data(), one.nodes.size() * sizeof(SphereNode)), 0);
  EXPECT_EQ(one.first_child, two.first_child);
  EXPECT_EQ(one.volumes, two.volumes);
}

TEST(SphereTree, RefusesAnEmptyPacking) { EXPECT_THROW(build_sphere_tree({}), BadArgument); }

}  // namespace
}  // namespace sixdof::ist
