#include <algorithm>

#include <cgal_overlap.h>
#include <gtest/gtest.h>

#include <sixdof/models/model_catalogue.h>
#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/overlap.h>

#include "bodies.h"

/// The exact overlap against CGAL's corefinement, which builds the intersection as a mesh.
namespace sixdof {
namespace {

using bodies::Body;
using Eigen::Vector3d;

std::vector<std::array<double, 3>> transformed_vertices(const Mesh& mesh, const Pose& X_AB) {
  std::vector<std::array<double, 3>> result;
  for (const Vector3d& p : mesh.vertices()) {
    const Vector3d q = transform_point(X_AB, p);
    result.push_back({q.x(), q.y(), q.z()});
  }
  return result;
}

/// CGAL rounds the points of the intersection and sums a hundred thousand tetrahedra about the origin.
constexpr double k_relative_rounding = 1e-12;

/// B rotated at random, its box centre within `reach` of A's.
void expect_agreement(const Mesh& a, const Mesh& b, int poses, unsigned seed, double reach = 0.25) {
  const Body body_a(a), body_b(b);
  const reference::CgalOverlap ab(reference::to_cgal(a), reference::to_cgal(b)),
      ba(reference::to_cgal(b), reference::to_cgal(a));
  std::mt19937_64 random(seed);
  int met = 0;
  for (int i = 0; i < poses; ++i) {
    Pose X_AB = bodies::random_pose(random, reach);
    X_AB.t += a.center() - X_AB.R * b.center();
    const Overlap o = bodies::overlap(body_a, body_b, X_AB);
    met += o.crossings > 0;
    EXPECT_NEAR(o.volume, ab.volume(transformed_vertices(b, X_AB)), k_relative_rounding * a.volume());
    const Pose X_BA = X_AB.inverse();
    EXPECT_NEAR(bodies::overlap(body_b, body_a, X_BA).volume, ba.volume(transformed_vertices(a, X_BA)),
                k_relative_rounding * b.volume());
  }
  EXPECT_GE(met, 1);
}

TEST(OverlapAgainstCorefinement, AThousandTriangles) {
  expect_agreement(bodies::bumpy_torus(32, 16), bodies::bumpy_sphere(3), 10, 41);
}

TEST(OverlapAgainstCorefinement, TenThousandTriangles) {
  expect_agreement(bodies::bumpy_torus(100, 50), bodies::bumpy_sphere(5), 4, 42);
}

TEST(OverlapAgainstCorefinement, AHundredThousandTriangles) {
  expect_agreement(bodies::bumpy_torus(320, 160), bodies::bumpy_torus(319, 157, 0.2), 1, 43);
}

/// Scans, which the fixture real_models fetches: triangles of all sizes and shapes. The second is scaled to the size of
/// the first.
TEST(OverlapAgainstCorefinement, ScannedObjects) {
  const std::pair<const char*, const char*> pairs[] = {
      {"knot", "bear"}, {"elephant", "knot"}, {"elephant", "elephant"}};
  for (const auto& [name_a, name_b] : pairs) {
    const Mesh a = load_model(name_a), b = load_model(name_b);
    std::vector<Vector3d> scaled = b.vertices();
    for (Vector3d& p : scaled) p *= a.diagonal() / b.diagonal();
    expect_agreement(a, Mesh::build(scaled, b.triangles()), 3, 44, 0.25 * a.diagonal());
  }
}

}  // namespace
}  // namespace sixdof
