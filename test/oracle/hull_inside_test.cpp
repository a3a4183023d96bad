// Hulls of points against the distance of triangles, and in a sphere.

#include <sixdof/oracle/hull_inside.h>

#include <algorithm>
#include <array>
#include <random>

#include <gtest/gtest.h>

#include <sixdof/geometry/predicates.h>
#include <sixdof/geometry/triangle_distance.h>

#include "bodies.h"

namespace sixdof::detail {
namespace {

using Eigen::Vector3d;

constexpr double k_clearance = 1e-12;

Vector3d random_point(std::mt19937_64& random, double reach) {
  std::uniform_real_distribution<double> uniform(-reach, reach);
  return {uniform(random), uniform(random), uniform(random)};
}

/// Distance of a triangle from a tetrahedron, by the tetrahedron's faces; 0 if a corner lies inside.
double distance_to_tetrahedron(const Tree::Corners& triangle, std::array<Vector3d, 4> p) {
  if (orient3d_value(p[0], p[1], p[2], p[3]) < 0.0) std::swap(p[0], p[1]);
  const std::array<std::array<int, 3>, 4> faces{{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
  double least = 1e9;
  bool inside = true;
  for (const auto& f : faces) {
    const TriangleCorners face{p[static_cast<std::size_t>(f[0])], p[static_cast<std::size_t>(f[1])],
                               p[static_cast<std::size_t>(f[2])]};
    least = std::min(least, triangle_triangle_distance(triangle, face).distance);
    inside = inside && orient3d_value(face[0], face[1], face[2], triangle[0]) > 0.0;
  }
  return inside ? 0.0 : least;
}

TEST(HullInside, SeparatesATetrahedronFromATriangleExactlyWhereTheyAreApart) {
  std::mt19937_64 random(21);
  int apart = 0, close = 0;
  for (int i = 0; i < 3000; ++i) {
    std::array<Vector3d, 4> p;
    for (Vector3d& x : p) x = random_point(random, 0.5);
    const Vector3d offset = random_point(random, 0.6);
    Tree::Corners t;
    for (Vector3d& x : t) x = offset + random_point(random, 0.3);
    const double distance = distance_to_tetrahedron(t, p);
    if (distance > 0.0 && distance < 1e-9) continue;
    EXPECT_EQ(is_hull_clear(t, p, k_clearance), distance > 0.0) << distance;
    apart += distance > 0.0;
    close += distance > 0.0 && distance < 0.05;
  }
  EXPECT_GE(apart, 500);
  EXPECT_GE(close, 50);
}

TEST(HullInside, KeepsTheClearance) {
  const Tree::Corners t{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  const std::array<Vector3d, 3> p{Vector3d(0.2, 0.2, 0.01), Vector3d(0.3, 0.2, 0.02), Vector3d(0.2, 0.4, 0.03)};
  EXPECT_TRUE(is_hull_clear(t, p, 0.009));
  EXPECT_FALSE(is_hull_clear(t, p, 0.011));
}

TEST(HullInside, OfASphereAndOfADent) {
  std::mt19937_64 random(22);
  const Mesh mesh = bodies::moved(bodies::bumpy_sphere(4, 0.0), bodies::random_pose(random, 0.7));
  const Tree tree(mesh);
  const Vector3d c = mesh.center();
  std::array<Vector3d, 6> p;
  for (int i = 0; i < 50; ++i) {
    for (Vector3d& x : p) x = c + 0.495 * random_point(random, 1.0).normalized();
    EXPECT_TRUE(is_hull_clear(tree, p, k_clearance));
    p[3] = c + 0.51 * (p[3] - c).normalized();
    EXPECT_FALSE(is_hull_clear(tree, p, k_clearance));
  }
  // Both ends lie inside a torus; the way between them crosses the hole.
  const Mesh ring = bodies::bumpy_torus(40, 20, 0.0);
  const Tree tree_of_ring(ring);
  const std::array<Vector3d, 2> across{Vector3d(0.5, 0.02, 0.01), Vector3d(-0.5, 0.03, -0.02)};
  EXPECT_FALSE(is_hull_clear(tree_of_ring, across, k_clearance));
  const std::array<Vector3d, 2> along{Vector3d(0.5, 0.02, 0.01), Vector3d(0.49, 0.12, -0.02)};
  EXPECT_TRUE(is_hull_clear(tree_of_ring, along, k_clearance));
}

}  // namespace
}  // namespace sixdof::detail
