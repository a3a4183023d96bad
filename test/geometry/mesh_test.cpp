#include <sixdof/geometry/mesh.h>

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

#include "shapes.h"

namespace sixdof {
namespace {

constexpr double k_far_rounding = 1e-8;  // of a body 4e6 from the origin: eps * offset / size in each of three factors

using ::testing::HasSubstr;
using Vertices = std::vector<Eigen::Vector3d>;
using Triangles = std::vector<Triangle>;

// A tetrahedron without symmetry; its volume is det / 6 = 2.4 * 1.7 * 3.1 / 6.
Vertices tetrahedron_vertices() { return {{0.3, -0.2, 0.7}, {2.7, -0.2, 0.7}, {0.9, 1.5, 0.7}, {0.5, 0.4, 3.8}}; }
Triangles tetrahedron_triangles() { return {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}; }
constexpr double k_tetrahedron_volume = 2.4 * 1.7 * 3.1 / 6.0;
constexpr double k_rounding = 1e-14;  // a few operations on numbers near 1

TEST(Mesh, TetrahedronIsASolidOfKnownVolumeAndCentroid) {
  const Mesh mesh = Mesh::build(tetrahedron_vertices(), tetrahedron_triangles(), "tetrahedron");
  EXPECT_TRUE(mesh.solid()) << mesh.why_not_solid();
  EXPECT_TRUE(mesh.topology().manifold);
  EXPECT_EQ(mesh.topology().edges, 6u);
  EXPECT_EQ(mesh.topology().euler_characteristic, 2);
  EXPECT_EQ(mesh.topology().components, 1u);
  EXPECT_NEAR(mesh.volume(), k_tetrahedron_volume, k_rounding);
  const auto v = tetrahedron_vertices();
  EXPECT_TRUE(mesh.centroid().isApprox((v[0] + v[1] + v[2] + v[3]) / 4.0, k_rounding));
  EXPECT_NEAR(mesh.diagonal(), Eigen::Vector3d(2.4, 1.7, 3.1).norm(), k_rounding);
}

TEST(Mesh, VolumeIsAccurateFarFromTheOrigin) {
  Vertices far = tetrahedron_vertices();
  for (auto& p : far) p += Eigen::Vector3d(1e6, -3e6, 2e6);
  // Rounding of the vertices themselves: eps * offset / size in each of three factors.
  EXPECT_NEAR(Mesh::build(far, tetrahedron_triangles()).volume(), k_tetrahedron_volume, k_far_rounding);
}

TEST(Mesh, WeldsExactlyEqualVerticesOnly) {
  Vertices soup;
  Triangles triangles;
  for (const Triangle& t : tetrahedron_triangles()) {
    for (const auto v : t) soup.push_back(tetrahedron_vertices()[v]);
    const auto n = static_cast<std::uint32_t>(soup.size());
    triangles.push_back({n - 3, n - 2, n - 1});
  }
  const Mesh welded = Mesh::build(soup, triangles);
  EXPECT_TRUE(welded.solid());
  EXPECT_EQ(welded.repairs().welded_vertices, 8u);

  soup[0].x() = std::nextafter(soup[0].x(), 1.0);
  const Mesh cracked = Mesh::build(soup, triangles);
  EXPECT_FALSE(cracked.topology().closed);
  EXPECT_THAT(cracked.why_not_solid(), HasSubstr("border edges"));
}

TEST(Mesh, NegativeZeroIsZero) {
  Vertices v{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {-0.0, 0.0, -0.0}, {0.0, 0.5, 1.5}};
  const Mesh mesh = Mesh::build(v, {{0, 2, 1}, {3, 1, 4}, {1, 2, 4}, {2, 0, 4}});
  EXPECT_TRUE(mesh.solid());
  EXPECT_EQ(mesh.repairs().welded_vertices, 1u);
}

TEST(Mesh, CountsDroppedAndDegenerateElements) {
  Vertices v = tetrahedron_vertices();
  v.push_back({9.0, 9.0, 9.0});
  v.push_back(0.5 * (v[0] + v[1]));
  Triangles t = tetrahedron_triangles();
  t.push_back({0, 0, 2});
  const Mesh mesh = Mesh::build(v, t);
  EXPECT_EQ(mesh.repairs().collapsed_triangles, 1u);
  EXPECT_EQ(mesh.repairs().unreferenced_vertices, 2u);
  EXPECT_TRUE(mesh.solid());

  // Splitting edge (0, 1) in only one of its triangles leaves a zero-area triangle that closes the surface.
  const Mesh split = Mesh::build(v, {{0, 2, 5}, {5, 2, 1}, {0, 5, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  EXPECT_TRUE(split.solid()) << split.why_not_solid();
  EXPECT_EQ(split.repairs().zero_area_triangles, std::vector<std::uint32_t>{2});
}

TEST(Mesh, ClassifiesOpenFlippedInsideOutAndNonManifold) {
  const Triangles t = tetrahedron_triangles();
  const Vertices v = tetrahedron_vertices();
  const Mesh with_border = Mesh::build(v, {t[0], t[1], t[2]});
  EXPECT_EQ(with_border.topology().border_edges, 3u);

  const Mesh flipped = Mesh::build(v, {t[0], t[1], t[2], {0, 2, 3}});
  EXPECT_TRUE(flipped.topology().closed);
  EXPECT_FALSE(flipped.topology().oriented);
  EXPECT_EQ(flipped.topology().misoriented_edges, 3u);

  const Mesh inside_out = Mesh::build(v, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}});
  EXPECT_TRUE(inside_out.topology().oriented);
  EXPECT_THAT(inside_out.why_not_solid(), HasSubstr("inside out"));

  // Two tetrahedra with one common vertex.
  Vertices two = v;
  for (std::size_t i = 1; i < 4; ++i) two.push_back(2.0 * v[0] - v[i]);
  const Mesh touching = Mesh::build(two, {t[0], t[1], t[2], t[3], {0, 4, 5}, {0, 6, 4}, {4, 6, 5}, {5, 6, 0}});
  EXPECT_EQ(touching.topology().nonmanifold_vertices, 1u);
  EXPECT_FALSE(touching.topology().manifold);
  EXPECT_EQ(touching.topology().components, 2u);
  EXPECT_TRUE(touching.solid());
}

TEST(Mesh, RefusesInvalidInputAndNamesTheElement) {
  Vertices v = tetrahedron_vertices();
  const auto message = [](const Vertices& vertices, const Triangles& triangles) -> std::string {
    try {
      Mesh::build(vertices, triangles);
    } catch (const BadMesh& e) {
      return e.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message(v, {}), HasSubstr("no triangles"));
  EXPECT_THAT(message(v, {{0, 2, 1}, {0, 1, 4}}), HasSubstr("triangle 1: vertex index 4 of 4"));
  EXPECT_THAT(message(v, {{0, 0, 1}}), HasSubstr("collapses"));
  v[2].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message(v, tetrahedron_triangles()), HasSubstr("vertex 2"));
  v[2].y() = std::numeric_limits<double>::infinity();
  EXPECT_THAT(message(v, tetrahedron_triangles()), HasSubstr("vertex 2"));
  v[2].y() = 1e308;
  v[3].y() = -1e308;
  EXPECT_THAT(message(v, tetrahedron_triangles()), HasSubstr("too large"));
}

TEST(Mesh, HashDependsOnContentNotOnTheName) {
  const Mesh a = Mesh::build(tetrahedron_vertices(), tetrahedron_triangles(), "one");
  const Mesh b = Mesh::build(tetrahedron_vertices(), tetrahedron_triangles(), "other");
  Vertices changed = tetrahedron_vertices();
  changed[3].z() = std::nextafter(changed[3].z(), 10.0);
  EXPECT_EQ(a.hash(), b.hash());
  EXPECT_EQ(a.hash().size(), 32u);
  EXPECT_NE(a.hash(), Mesh::build(changed, tetrahedron_triangles()).hash());
}

TEST(Mesh, WithOtherVerticesIsTheMeshBuiltOfThem) {
  const Mesh mesh = shapes::bumpy_sphere(2, 0.2, 0.7, {0.3, -0.2, 0.9});
  std::vector<Eigen::Vector3d> vertices = mesh.vertices();
  for (Eigen::Vector3d& p : vertices) p = Eigen::Vector3d(p.x() + 0.3 * std::sin(3.0 * p.y()), -0.0, 1.0) + 0.7 * p;
  const Mesh moved = mesh.with_vertices(vertices), built = Mesh::build(vertices, mesh.triangles(), mesh.name());
  EXPECT_EQ(moved.hash(), built.hash());
  EXPECT_EQ(moved.name(), mesh.name());
  EXPECT_EQ(moved.volume(), built.volume());
  EXPECT_EQ(moved.area(), built.area());
  EXPECT_EQ(moved.diagonal(), built.diagonal());
  EXPECT_EQ(moved.topology().edges, built.topology().edges);
  EXPECT_TRUE(moved.solid());
}

TEST(Mesh, RefusesVerticesThatChangeItsTriangles) {
  const Mesh mesh = shapes::bumpy_sphere(0, 0.0);
  std::vector<Eigen::Vector3d> vertices = mesh.vertices();
  vertices[5] = vertices[2];
  EXPECT_THROW(mesh.with_vertices(vertices), BadMesh);
  vertices[5].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(mesh.with_vertices(vertices), BadMesh);
  vertices.pop_back();
  EXPECT_THROW(mesh.with_vertices(vertices), BadMesh);
}

}  // namespace
}  // namespace sixdof
