#include <sixdof/oracle/solid.h>

#include <algorithm>

#include <gtest/gtest.h>

#include "bodies.h"

namespace sixdof {
namespace {

using bodies::Body;
using Eigen::Vector3d;

/// Relative rounding of a flux and of its sum over a mesh.
constexpr double k_rounding = 1e-14;

/// A side from lowest to middle index in both triangles at it has one potential, stored twice.
TEST(Solid, TrianglesAgreeOnThePotentialOfACommonSide) {
  const Body body(bodies::bumpy_sphere(4));
  const std::vector<Triangle>& triangles = body.mesh.triangles();
  std::vector<std::vector<std::uint32_t>> fan(body.mesh.vertices().size());
  std::vector<bool> lowest(body.mesh.vertices().size(), true);
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[body.tree.mesh_triangle()[i]];
    for (const std::uint32_t v : t) {
      fan[v].push_back(i);
      lowest[v] = lowest[v] && v == *std::min_element(t.begin(), t.end());
    }
  }
  std::size_t compared = 0;
  for (std::uint32_t v = 0; v < fan.size(); ++v) {
    if (!lowest[v]) continue;
    for (const std::uint32_t i : fan[v]) {
      for (const std::uint32_t j : fan[v]) {
        const auto middle = [&](std::uint32_t t) {
          Triangle sorted = triangles[body.tree.mesh_triangle()[t]];
          std::sort(sorted.begin(), sorted.end());
          return sorted[1];
        };
        if (i >= j || middle(i) != middle(j)) continue;
        EXPECT_TRUE(body.solid.potential(i).volume == body.solid.potential(j).volume);
        EXPECT_TRUE(body.solid.potential(i).first == body.solid.potential(j).first);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 0u);
}

TEST(Solid, PiecesHaveTheirVolumeAndCentroid) {
  const Mesh sphere = bodies::bumpy_sphere(3), torus = bodies::bumpy_torus(20, 10);
  const Mesh far = bodies::moved(torus, {Eigen::Matrix3d::Identity(), {2.0, 0.3, -0.4}}, 0.5);
  const Body both(bodies::together(sphere, far));
  ASSERT_EQ(both.solid.pieces().size(), 2u);
  const std::array<const Mesh*, 2> parts{&sphere, &far};
  for (std::size_t i = 0; i < 2; ++i) {
    const Solid::Piece& piece = both.solid.pieces()[i];
    const Solid::Moments total = both.solid.to_moments(piece.total);
    EXPECT_NEAR(total.volume, parts[i]->volume(), k_rounding);
    const Vector3d first = parts[i]->volume() * (parts[i]->centroid() - both.tree.center());
    EXPECT_LT((total.first - first).norm(), k_rounding);
    // The pole is a vertex of the piece.
    const auto& vertices = parts[i]->vertices();
    EXPECT_NE(std::find(vertices.begin(), vertices.end(), piece.pole), vertices.end());
  }
}

TEST(Solid, MomentsOfATriangleAreThoseOfItsTetrahedron) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 100; ++i) {
    const auto point = [&] { return bodies::random_pose(random, 1.0).t; };
    const Vector3d a = point(), b = point(), c = point();
    const Solid::Moments m = triangle_moments(a, b, c);
    EXPECT_NEAR(m.volume, a.dot(b.cross(c)) / 6.0, k_rounding);
    // |p|^2 n / 2 over the faces of the tetrahedron with the origin is its first moment: volume times centroid.
    const Vector3d o = Vector3d::Zero();
    const Vector3d all =
        m.first + triangle_moments(o, c, b).first + triangle_moments(o, a, c).first + triangle_moments(o, b, a).first;
    EXPECT_LT((all - m.volume * (a + b + c) / 4.0).norm(), k_rounding);
  }
}

TEST(Solid, MemoryIsBoundedPerTriangle) {
  const Body body(bodies::bumpy_torus(100, 50));
  // Four 16-byte potentials and the order of the corners.
  EXPECT_LE(body.solid.bytes(), 67 * body.mesh.triangles().size());
}

}  // namespace
}  // namespace sixdof
