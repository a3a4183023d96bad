#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/geometry/tree_builder.h>

#include "shapes.h"
#include "tree_check.h"

namespace sixdof {
namespace {

tree_builder::Surface surface_of(const Mesh& mesh) { return {mesh.vertices(), mesh.triangles()}; }

/// The mesh after a smooth motion of a size.
Mesh bent(const Mesh& mesh, double by) {
  std::vector<Eigen::Vector3d> vertices = mesh.vertices();
  for (Eigen::Vector3d& p : vertices) {
    p += by * Eigen::Vector3d(std::sin(3.1 * p.y()), std::cos(2.3 * p.z()), std::sin(4.7 * p.x() + 0.3));
  }
  return mesh.with_vertices(std::move(vertices));
}

Mesh soup_of(std::size_t triangles) {
  shapes::Generator generator(21);
  return shapes::soup(generator, triangles, 2.0, 0.3);
}

bool same_bytes(const Tree& x, const Tree& y) {
  const auto same = [](const auto& a, const auto& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
  };
  return same(x.nodes(), y.nodes()) && same(x.leaves(), y.leaves()) && same(x.mesh_triangle(), y.mesh_triangle());
}

TEST(TreeRefit, ContainsTheTrianglesWhereTheyAre) {
  for (const Mesh& mesh :
       {shapes::bumpy_sphere(4, 0.2, 0.7, {0.3, -0.2, 0.9}), soup_of(777), soup_of(3), soup_of(33)}) {
    Tree tree(mesh);
    for (const double by : {1e-6, 0.01, 0.3, 3.0}) {
      const Mesh moved = bent(mesh, by);
      tree.refit(surface_of(moved));
      check_tree(moved, tree);
      const Tree built(moved);
      EXPECT_EQ(tree.center(), built.center());
      EXPECT_EQ(tree.radius(), built.radius());
    }
  }
}

TEST(TreeRefit, AtTheSamePlacesChangesNoBox) {
  const Mesh mesh = shapes::bumpy_sphere(4, 0.2);
  const Tree built(mesh);
  Tree tree = built;
  tree.refit(surface_of(mesh));
  for (std::size_t i = 0; i < built.nodes().size(); ++i) {
    EXPECT_EQ(std::memcmp(tree.nodes()[i].lower, built.nodes()[i].lower, sizeof(built.nodes()[i].lower)), 0) << i;
    EXPECT_EQ(std::memcmp(tree.nodes()[i].upper, built.nodes()[i].upper, sizeof(built.nodes()[i].upper)), 0) << i;
  }
}

TEST(TreeRefit, RefusesMeshesWithoutRoomAndKeepsTheTree) {
  const Mesh mesh = shapes::bumpy_sphere(2, 0.2);
  Tree tree(mesh);
  std::vector<Eigen::Vector3d> vertices = mesh.vertices();
  for (Eigen::Vector3d& p : vertices) p *= 1e20;
  EXPECT_THROW(tree.refit({vertices, mesh.triangles()}), BadMesh);
  check_tree(mesh, tree);
}

/// Nodes of about a hundred triangles, none below another.
std::vector<std::uint32_t> small_parts(const Tree& tree) {
  std::vector<std::uint32_t> parts;
  std::uint32_t end = 0;  // of the triangles that are in parts
  for (std::uint32_t i = 1; i < tree.nodes().size(); ++i) {
    const Tree::Node& node = tree.nodes()[i];
    if (node.triangle_count > 300 || node.first_triangle < end) continue;
    parts.push_back(i);
    end = node.first_triangle + node.triangle_count;
  }
  return parts;
}

TEST(TreeRebuild, OfPartsIsAValidTree) {
  const Mesh mesh = shapes::bumpy_sphere(4, 0.2), moved = bent(mesh, 0.8);
  Tree tree(mesh);
  tree.refit(surface_of(moved));
  const std::vector<std::uint32_t> all = small_parts(tree);
  ASSERT_GT(all.size(), 4u);
  const std::vector<std::uint32_t> some{all[1], all[2], all.back()};
  const std::size_t root_children = tree.nodes()[0].child_count;
  const std::vector<std::uint32_t> origin = tree.rebuild(surface_of(moved), some);
  check_tree(moved, tree);
  ASSERT_EQ(origin.size(), tree.nodes().size());
  EXPECT_EQ(origin[0], 0u);
  EXPECT_EQ(tree.nodes()[0].child_count, root_children);
  EXPECT_GE(std::count(origin.begin(), origin.end(), Tree::k_new), 3);
  EXPECT_LT(std::count(origin.begin(), origin.end(), Tree::k_new), static_cast<std::ptrdiff_t>(origin.size() / 2));
}

TEST(TreeRebuild, OfAllPartsWithoutMotionChangesNothing) {
  const Mesh mesh = shapes::bumpy_sphere(4, 0.2);
  const Tree built(mesh);
  Tree tree = built;
  tree.rebuild(surface_of(mesh), small_parts(tree));
  check_tree(mesh, tree);
  EXPECT_EQ(tree.nodes().size(), built.nodes().size());
}

TEST(TreeRebuild, IsTheSameForThoseThatAreBuiltWhole) {
  const Mesh mesh = shapes::bumpy_sphere(3, 0.2);
  EXPECT_TRUE(same_bytes(Tree(mesh), Tree(surface_of(mesh))));
}

}  // namespace
}  // namespace sixdof
