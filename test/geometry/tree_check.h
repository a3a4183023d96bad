#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/tree.h>

/// Checks that hold for every tree, however it was made.
namespace sixdof {

/// The volume stored with a node or leaf is that of its lane in the parent.
inline void check_volume(const Tree::Volume& volume, const Tree::Node& node, std::size_t lane) {
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(volume.lower[k], node.lower[k][lane]);
    EXPECT_EQ(volume.upper[k], node.upper[k][lane]);
    EXPECT_EQ(volume.normal[k], node.normal[k][lane]);
  }
  EXPECT_EQ(volume.slab_lower, node.slab_lower[lane]);
  EXPECT_EQ(volume.slab_upper, node.slab_upper[lane]);
}

/// Checks all that the doc comment of Tree states.
inline void check_tree(const Mesh& mesh, const Tree& tree) {
  const std::size_t n = mesh.triangles().size();
  ASSERT_EQ(tree.mesh_triangle().size(), n);
  std::vector<int> seen(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t original = tree.mesh_triangle()[i];
    ASSERT_LT(original, n);
    ++seen[original];
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(tree.corners()[i][k], mesh.vertices()[mesh.triangles()[original][k]]);
    }
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(n));

  double radius = 0.0;
  for (const Eigen::Vector3d& v : mesh.vertices()) radius = std::max(radius, (v - tree.center()).norm());
  EXPECT_GE(tree.radius(), radius);
  EXPECT_LE(tree.radius(), radius * (1.0 + 1e-14));  // a square root and its margin: a few units in the last place

  std::vector<int> covered(n, 0);
  std::uint32_t index = 0;
  for (const Tree::Node& node : tree.nodes()) {
    ASSERT_GE(node.child_count, 1u);
    ASSERT_LE(node.child_count, Tree::k_width);
    std::uint32_t first = node.first_triangle;
    for (std::size_t i = 0; i < Tree::k_width; ++i) {
      if (i >= node.child_count) {
        for (std::size_t k = 0; k < 3; ++k) {
          EXPECT_EQ(node.lower[k][i], Tree::k_empty);
          EXPECT_EQ(node.upper[k][i], -Tree::k_empty);
        }
        continue;
      }
      std::uint32_t count = 0;
      if (node.child[i].is_leaf()) {
        ASSERT_EQ(node.child[i].first(), first);
        count = node.child[i].count();
        for (std::uint32_t t = first; t < first + count; ++t) ++covered[t];
        const Tree::Leaf& leaf = tree.leaves()[node.leaf(i)];
        EXPECT_EQ(leaf.child.first(), first);
        EXPECT_EQ(leaf.child.count(), count);
        check_volume(leaf.volume, node, i);
        for (std::uint32_t t = 0; t < Tree::k_leaf_triangles; ++t) {
          const Tree::Corners& corners = tree.corners()[first + std::min(t, count - 1)];
          for (std::size_t corner = 0; corner < 3; ++corner) {
            for (std::size_t k = 0; k < 3; ++k) {
              const auto axis = static_cast<Eigen::Index>(k);
              EXPECT_EQ(leaf.corner[corner][k][t], static_cast<float>(corners[corner][axis] - tree.center()[axis]));
            }
          }
        }
      } else {
        ASSERT_GT(node.child[i].node(), index);
        ASSERT_LT(node.child[i].node(), tree.nodes().size());
        const Tree::Node& child = tree.nodes()[node.child[i].node()];
        ASSERT_EQ(child.first_triangle, first);
        count = child.triangle_count;
        check_volume(child.volume, node, i);
      }
      const Eigen::Vector3d normal(node.normal[0][i], node.normal[1][i], node.normal[2][i]);
      EXPECT_LE(normal.norm(), 1.0);
      EXPECT_GE(normal.norm(), 1.0 - 1e-6);
      for (std::uint32_t t = first; t < first + count; ++t) {
        for (const Eigen::Vector3d& corner : tree.corners()[t]) {
          const Eigen::Vector3d p = corner - tree.center();
          for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_LE(node.lower[k][i], p[static_cast<Eigen::Index>(k)]);
            ASSERT_GE(node.upper[k][i], p[static_cast<Eigen::Index>(k)]);
          }
          ASSERT_LE(node.slab_lower[i], normal.dot(p));
          ASSERT_GE(node.slab_upper[i], normal.dot(p));
        }
      }
      first += count;
    }
    EXPECT_EQ(first, node.first_triangle + node.triangle_count);
    ++index;
  }
  EXPECT_EQ(std::count(covered.begin(), covered.end(), 1), static_cast<std::ptrdiff_t>(n));
  EXPECT_EQ(tree.nodes()[0].triangle_count, n);
}

}  // namespace sixdof
