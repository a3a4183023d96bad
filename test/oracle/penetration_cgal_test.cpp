#include <cgal_minkowski.h>
#include <gtest/gtest.h>

#include <sixdof/oracle/penetration.h>

#include "bodies.h"
#include "penetrating.h"

/// Intervals of penetration depths of small bodies that are not convex against Minkowski sums by CGAL.
namespace sixdof {
namespace {

using Eigen::Vector3d;

/// CGAL's points are rounded to doubles, and casts end at contacts to some 1e-10 of the way.
constexpr double k_rounding = 1e-9;

reference::CgalMesh reflected(const Mesh& mesh, const Pose& X) {
  reference::CgalMesh result;
  for (const Vector3d& p : mesh.vertices()) {
    const Vector3d q = -(X * p);
    result.vertices.push_back({q.x(), q.y(), q.z()});
  }
  for (const Triangle& t : mesh.triangles()) result.triangles.push_back({t[0], t[2], t[1]});  // the reflection inverts
  return result;
}

void expect_agreement(const Mesh& a, const Mesh& b, int poses, unsigned seed) {
  const PenetrationOracle oracle(a, b);
  std::mt19937_64 random(seed);
  int deep = 0;
  for (int i = 0; i < poses; ++i) {
    Pose X_AB = bodies::random_pose(random, 0.4);
    X_AB.t += a.center() - X_AB.R * b.center();
    const PenetrationDepth found = oracle.evaluate(X_AB, {.tolerance = 1e-4, .budget = 2'000'000});
    if (found.hi == 0.0) continue;
    ++deep;
    const double truth = reference::distance_to_minkowski_sum(reference::to_cgal(a), reflected(b, X_AB));
    ASSERT_GE(truth, 0.0);
    EXPECT_NEAR(found.hi, truth, k_rounding) << i;
    EXPECT_LE(found.lo, truth + k_rounding) << i;
    EXPECT_TRUE(found.closed) << i;
  }
  EXPECT_GE(deep, poses / 2);
}

TEST(PenetrationAgainstMinkowskiSums, OfTwoLs) {
  expect_agreement(penetrating::l_shape(), penetrating::l_shape(), 4, 61);
}

TEST(PenetrationAgainstMinkowskiSums, OfALAndAPlateWithAHole) {
  expect_agreement(penetrating::plate_with_hole(), penetrating::l_shape(), 2, 62);
}

}  // namespace
}  // namespace sixdof
