#include <sixdof/oracle/convex_hull.h>

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/geometry/predicates.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/models/recipe.h>

#include "../geometry/shapes.h"

namespace sixdof {
namespace {

constexpr double k_rounding = 1e-12;  // of a sum over some hundred triangles, relative

/// A mesh that has these vertices and no other meaning.
Mesh cloud(std::vector<Eigen::Vector3d> points) {
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i + 2 < points.size(); ++i) triangles.push_back({i, i + 1, i + 2});
  return Mesh::build(std::move(points), std::move(triangles), "cloud");
}

/// Closed, convex, and not one vertex of the mesh is outside: by exact signs.
void expect_hull_of(const Mesh& mesh) {
  const Mesh hull = convex_hull(mesh);
  EXPECT_TRUE(hull.solid()) << hull.why_not_solid();
  EXPECT_TRUE(hull.topology().manifold);
  EXPECT_EQ(hull.topology().euler_characteristic, 2);
  EXPECT_EQ(hull.topology().components, 1u);
  const auto& p = hull.vertices();
  std::size_t outside = 0;
  for (const auto& [a, b, c] : hull.triangles()) {
    for (const Eigen::Vector3d& v : mesh.vertices()) outside += orient3d(p[a], p[b], p[c], v) > 0 ? 1 : 0;
  }
  EXPECT_EQ(outside, 0u) << mesh.name();
  EXPECT_EQ(hull.box().min(), mesh.box().min()) << "vertices keep their bits";
  EXPECT_EQ(hull.box().max(), mesh.box().max());
  EXPECT_EQ(convex_hull(mesh).hash(), hull.hash());
}

TEST(ConvexHull, HoldsEveryVertexOfAMesh) {
  for (const char* const name : {"torus-1k", "cone-1k", "bumpy-sphere-1k"}) {
    const Mesh mesh = load_model(name);
    expect_hull_of(mesh);
    EXPECT_GE(convex_hull(mesh).volume(), mesh.volume() * (1.0 - k_rounding));
  }
}

TEST(ConvexHull, OfAConvexBodyIsTheBody) {
  const Mesh sphere = make_sphere({}, 1280);
  expect_hull_of(sphere);
  EXPECT_EQ(convex_hull(sphere).vertices().size(), sphere.vertices().size());
  const Mesh box = make_box({{2.0, 1.6, 1.2}}, 300);
  expect_hull_of(box);
  EXPECT_NEAR(convex_hull(box).volume(), 2.0 * 1.6 * 1.2, k_rounding);
}

TEST(ConvexHull, OfPointsInCommonPlanesAndLines) {
  std::vector<Eigen::Vector3d> grid;
  for (int i = 0; i < 125; ++i) grid.emplace_back(i % 5, i / 5 % 5, i / 25);
  expect_hull_of(cloud(grid));
  EXPECT_NEAR(convex_hull(cloud(grid)).volume(), 64.0, 64.0 * k_rounding);
  // The same where rounding moves each point a little in or out of its plane, and far from the origin.
  shapes::Generator random(7);
  const Pose X = shapes::random_pose(random, 1e3);
  for (Eigen::Vector3d& point : grid) point = X * point;
  expect_hull_of(cloud(grid));
}

TEST(ConvexHull, OfRandomPoints) {
  shapes::Generator random(11);
  for (int count = 4; count < 200; count += 13) {
    std::vector<Eigen::Vector3d> inside, around;
    for (int i = 0; i < count; ++i) {
      inside.push_back(shapes::uniform_vector(random, 1.0));
      around.push_back(shapes::unit_vector(random));
    }
    expect_hull_of(cloud(inside));
    expect_hull_of(cloud(around));
    EXPECT_EQ(convex_hull(cloud(around)).vertices().size(), static_cast<std::size_t>(count)) << "all are corners";
  }
}

TEST(ConvexHull, RefusesPointsInAPlane) {
  const Mesh flat = Mesh::build({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}, "flat");
  EXPECT_THROW(convex_hull(flat), BadMesh);
  EXPECT_THROW(convex_hull(cloud({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}})), BadMesh);
}

}  // namespace
}  // namespace sixdof
