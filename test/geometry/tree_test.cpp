#include <sixdof/geometry/tree.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>

#include "shapes.h"
#include "tree_check.h"

namespace sixdof {
namespace {

TEST(Tree, IsValidOnASmoothSurface) {
  const Mesh mesh = shapes::bumpy_sphere(4, 0.2, 0.7, {0.3, -0.2, 0.9});
  check_tree(mesh, Tree(mesh));
}

TEST(Tree, IsValidOnASoup) {
  shapes::Generator generator(11);
  const Mesh mesh = shapes::soup(generator, 777, 3.0, 0.4);
  check_tree(mesh, Tree(mesh));
}

TEST(Tree, IsValidFarFromTheOriginAndAtEveryScale) {
  for (const double scale : {1e-9, 1e-6, 1.0, 1e6, 1e9}) {
    const Mesh mesh = shapes::bumpy_sphere(2, 0.3, scale, scale * 1e6 * Eigen::Vector3d(0.7, -0.9, 0.4));
    check_tree(mesh, Tree(mesh));
  }
}

TEST(Tree, IsValidForEverySmallNumberOfTriangles) {
  shapes::Generator generator(12);
  for (std::size_t n = 1; n <= 70; ++n) {
    const Mesh mesh = shapes::soup(generator, n, 1.0, 0.2);
    check_tree(mesh, Tree(mesh));
  }
}

TEST(Tree, IsValidForDuplicatesAndTrianglesWithEqualCentres) {
  shapes::Generator generator(13);
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < 100; ++i) {
    const Eigen::Vector3d u = shapes::unit_vector(generator);
    vertices.insert(vertices.end(), {u, -u, Eigen::Vector3d(0.3 * u.y(), u.x(), 0.1)});
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const Mesh mesh = Mesh::build(vertices, triangles);
  check_tree(mesh, Tree(mesh));
}

TEST(Tree, IsTheSameBitsForEveryThreadCount) {
  const Mesh mesh = shapes::bumpy_sphere(7, 0.2);  // 327,680 triangles: binned in parts, subtrees are tasks
  const auto build = [&](unsigned threads) {
    std::optional<Tree> tree;
    parallel::with_threads(threads, [&] { tree.emplace(mesh); });
    return *std::move(tree);
  };
  const Tree one = build(1);
  const Tree four = build(4);
  ASSERT_EQ(one.nodes().size(), four.nodes().size());
  EXPECT_EQ(std::memcmp(one.nodes().data(), four.nodes().data(), one.nodes().size_bytes()), 0);
  ASSERT_EQ(one.leaves().size(), four.leaves().size());
  EXPECT_TRUE(std::equal(one.mesh_triangle().begin(), one.mesh_triangle().end(), four.mesh_triangle().begin()));
}

TEST(Tree, IsFilledWell) {
  // Memory and speed depend on it. Typical: 4.0 triangles per leaf, 7.8 children per node.
  constexpr double k_triangles_per_leaf = 3.9;
  constexpr double k_children_per_node = 7.5;
  const Mesh sphere = shapes::bumpy_sphere(5, 0.2);
  std::vector<Triangle> triangles(sphere.triangles().begin(), sphere.triangles().end());
  triangles.resize(triangles.size() - 77);  // no multiple of what a full node holds
  const Mesh mesh = Mesh::build({sphere.vertices().begin(), sphere.vertices().end()}, triangles);
  const Tree tree(mesh);
  double children = 0.0;
  double leaves = 0.0;
  for (const Tree::Node& node : tree.nodes()) {
    children += node.child_count;
    for (std::size_t i = 0; i < node.child_count; ++i) leaves += node.child[i].is_leaf() ? 1.0 : 0.0;
  }
  EXPECT_GE(static_cast<double>(mesh.triangles().size()) / leaves, k_triangles_per_leaf);
  EXPECT_GE(children / static_cast<double>(tree.nodes().size()), k_children_per_node);
  RecordProperty("triangles_per_leaf", std::to_string(static_cast<double>(mesh.triangles().size()) / leaves));
  RecordProperty("children_per_node", std::to_string(children / static_cast<double>(tree.nodes().size())));
}

TEST(Tree, SeparatesPartsThatLieFarFromEachOther) {
  // Their numbers of triangles are no multiples of what a full node holds.
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
  for (const int level : {3, 1, 2}) {  // 1280, 80 and 320 triangles
    const Mesh ball = shapes::bumpy_sphere(level, 0.2, 1.0, {1000.0 * level, 0.0, 0.0});
    const auto base = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), ball.vertices().begin(), ball.vertices().end());
    for (const Triangle& t : ball.triangles()) triangles.push_back({base + t[0], base + t[1], base + t[2]});
  }
  const Mesh mesh = Mesh::build(vertices, triangles);
  const Tree tree(mesh);
  check_tree(mesh, tree);
  for (const Tree::Node& node : tree.nodes()) {
    for (std::size_t i = 0; i < node.child_count; ++i) EXPECT_LT(node.upper[0][i] - node.lower[0][i], 10.0f);
  }
}

TEST(Tree, RefusesDiagonalsOutOfRange) {
  EXPECT_THROW(Tree(shapes::box({1e16, 1.0, 1.0})), BadMesh);
  EXPECT_THROW(Tree(shapes::box({1e-17, 1e-17, 1e-17})), BadMesh);
}

}  // namespace
}  // namespace sixdof
