#include <algorithm>

#include <cgal_overlap.h>
#include <gtest/gtest.h>

#include <sixdof/oracle/overlap.h>

#include "bodies.h"

/// The exact overlap against CGAL's corefinement, which builds the intersection as a mesh.
namespace sixdof {
namespace {

using bodies::Body;
using Eigen::Vector3d;

reference::CgalMesh convert(const Mesh& mesh) {
  reference::CgalMesh result;
  for (const Vector3d& p : mesh.vertices()) result.vertices.push_back({p.x(), p.y(), p.z()});
  result.triangles = mesh.triangles();
  return result;
}

std::vector<std::array<double, 3>> placed(const Mesh& mesh, const Pose& X_AB) {
  std::vector<std::array<double, 3>> result;
  for (const Vector3d& p : mesh.vertices()) {
    const Vector3d q = place(X_AB, p);
    result.push_back({q.x(), q.y(), q.z()});
  }
  return result;
}

/// CGAL rounds the points of the intersection and sums a hundred thousand tetrahedra about the origin.
constexpr double k_share_of_volume = 1e-12;

void expect_agreement(const Mesh& a, const Mesh& b, int poses, unsigned seed) {
  const Body body_a(a), body_b(b);
  const reference::CgalOverlap ab(convert(a), convert(b)), ba(convert(b), convert(a));
  std::mt19937_64 random(seed);
  int met = 0;
  for (int i = 0; i < poses; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.25);
    const Overlap o = bodies::overlap(body_a, body_b, X_AB);
    met += o.crossings > 0;
    EXPECT_NEAR(o.volume, ab.volume(placed(b, X_AB)), k_share_of_volume * a.volume());
    const Pose X_BA = X_AB.inverse();
    EXPECT_NEAR(bodies::overlap(body_b, body_a, X_BA).volume, ba.volume(placed(a, X_BA)),
                k_share_of_volume * b.volume());
  }
  EXPECT_GE(met, std::min(poses, 1));
}

TEST(overlap_against_corefinement, a_thousand_triangles) {
  expect_agreement(bodies::bumpy_torus(32, 16), bodies::bumpy_sphere(3), 10, 41);
}

TEST(overlap_against_corefinement, ten_thousand_triangles) {
  expect_agreement(bodies::bumpy_torus(100, 50), bodies::bumpy_sphere(5), 4, 42);
}

TEST(overlap_against_corefinement, a_hundred_thousand_triangles) {
  expect_agreement(bodies::bumpy_torus(320, 160), bodies::bumpy_torus(319, 157, 0.2), 1, 43);
}

}  // namespace
}  // namespace sixdof
