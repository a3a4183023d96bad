// The depth of convex bodies against closed forms, and against all normals that a face of the Minkowski difference can
// have.

#include <sixdof/oracle/convex_depth.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include <sixdof/oracle/convex_hull.h>

#include "bodies.h"
#include "penetrating.h"

namespace sixdof {
namespace {

using bodies::box;
using bodies::moved;
using Eigen::Vector3d;
using penetrating::hull_of_points;

/// Rounding of supports of bodies of size 1.
constexpr double k_rounding = 1e-13;

TEST(ConvexDepth, BoxesAlongTheirAxes) {
  std::mt19937_64 random(11);
  const Pose X_WA = bodies::random_pose(random, 0.7);
  const Mesh a = moved(box({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}), X_WA), b = box({-0.2, -0.3, -0.4}, {0.2, 0.3, 0.4});
  const Pose X_AB = X_WA * Pose{Eigen::Matrix3d::Identity(), {0.55, 0.21, -0.11}};
  const ConvexDepth found = convex_depth(a, b, X_AB);
  EXPECT_NEAR(found.depth, 0.5 + 0.2 - 0.55, k_rounding);
  EXPECT_NEAR(found.direction.dot(X_WA.R.col(0)), 1.0, k_rounding);
}

TEST(ConvexDepth, EdgeAgainstEdge) {
  // Cubes turned by 45 degrees about x and about y: their nearest edges are along x and along y, and cross.
  const double s = std::sqrt(0.5);
  const Mesh cube = box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  const Mesh a = moved(cube, Pose::from_quaternion(std::cos(std::numbers::pi / 8), std::sin(std::numbers::pi / 8), 0, 0,
                                                   Vector3d::Zero()));
  const Pose X_AB = Pose::from_quaternion(std::cos(std::numbers::pi / 8), 0, std::sin(std::numbers::pi / 8), 0,
                                          {0.03, -0.02, 2.0 * s - 0.1});
  const ConvexDepth found = convex_depth(a, cube, X_AB);
  EXPECT_NEAR(found.depth, 0.1, k_rounding);
  EXPECT_NEAR(found.direction.z(), 1.0, k_rounding);
}

TEST(ConvexDepth, IsZeroForDisjointBodies) {
  const Mesh a = box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  EXPECT_EQ(convex_depth(a, a, {Eigen::Matrix3d::Identity(), {0.2, 1.1, -0.3}}).depth, 0.0);
}

/// All normals of faces and all cross products of edges, each with its width over all vertices.
double depth_by_all_normals(const Mesh& a, const Mesh& b, const Pose& X) {
  const auto at = [](const Mesh& mesh, const Pose& pose) {
    std::vector<Vector3d> p;
    for (const Vector3d& v : mesh.vertices()) p.push_back(pose * v);
    return p;
  };
  const auto p = at(a, Pose{}), q = at(b, X);
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Vector3d& axis) {
    if (axis.norm() < 1e-9) return;
    for (const Vector3d& n : {Vector3d(axis.normalized()), Vector3d(-axis.normalized())}) {
      double high = -1e9, low = 1e9;
      for (const Vector3d& x : p) high = std::max(high, n.dot(x));
      for (const Vector3d& x : q) low = std::min(low, n.dot(x));
      least = std::min(least, high - low);
    }
  };
  for (const Triangle& t : a.triangles()) {
    consider((p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]));
    for (const Triangle& s : b.triangles()) {
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          consider((p[t[(i + 1) % 3]] - p[t[i]]).cross(q[s[(j + 1) % 3]] - q[s[j]]));
        }
      }
    }
  }
  for (const Triangle& s : b.triangles()) consider((q[s[1]] - q[s[0]]).cross(q[s[2]] - q[s[0]]));
  return std::max(0.0, least);
}

TEST(ConvexDepth, EqualsTheLeastWidthOverAllNormals) {
  std::mt19937_64 random(12);
  int deep = 0;
  for (int i = 0; i < 60; ++i) {
    const Mesh a = hull_of_points(random, 12), b = hull_of_points(random, 9);
    const Pose X_AB = bodies::random_pose(random, 0.5);
    const double truth = depth_by_all_normals(a, b, X_AB);
    deep += truth > 0.0;
    const ConvexDepth found = convex_depth(a, b, X_AB), exchanged = convex_depth(b, a, X_AB.inverse());
    EXPECT_NEAR(found.depth, truth, k_rounding);
    EXPECT_NEAR(exchanged.depth, truth, k_rounding);
    if (truth <= 1e-6) continue;
    EXPECT_NEAR((X_AB.R * exchanged.direction).dot(found.direction), -1.0, 1e-9);
  }
  EXPECT_GE(deep, 20);
}

}  // namespace
}  // namespace sixdof
