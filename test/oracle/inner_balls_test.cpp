// Balls inside of solids, and the pair that overlaps most.

#include <sixdof/oracle/inner_balls.h>

#include <gtest/gtest.h>

#include <sixdof/oracle/signed_depth.h>

#include "bodies.h"

namespace sixdof::detail {
namespace {

using Eigen::Vector3d;

TEST(InnerBalls, LieInsideAndTouchTheSurface) {
  std::mt19937_64 random(91);
  for (const Mesh& shape : {bodies::bumpy_torus(40, 20), bodies::bumpy_sphere(4, 0.2)}) {
    const Mesh mesh = bodies::moved(shape, bodies::random_pose(random, 0.7));
    const Tree tree(mesh);
    const InnerBalls balls = find_inner_balls(mesh, tree);
    ASSERT_GE(balls.size(), 1u);
    ASSERT_LE(balls.size(), InnerBalls::k_most);
    SignedDepth depth(mesh, tree);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      EXPECT_NEAR(depth.at(balls.center(i), 0).s, -balls.radius[i], 1e-14);
      EXPECT_LE(balls.radius[i], balls.radius[i == 0 ? 0 : i - 1]);
    }
  }
}

TEST(InnerBalls, OfABoxReachItsMiddle) {
  const Mesh mesh = bodies::box({-1.0, -0.7, -0.4}, {1.0, 0.7, 0.4});
  const InnerBalls balls = find_inner_balls(mesh, Tree(mesh));
  ASSERT_GE(balls.size(), 1u);
  EXPECT_NEAR(balls.radius[0], 0.4, 1e-3);
}

TEST(InnerBalls, TheDeepestPairIsThatOfAPlainSearch) {
  std::mt19937_64 random(92);
  const Mesh a = bodies::bumpy_torus(40, 20), b = bodies::bumpy_sphere(3, 0.2);
  const InnerBalls of_a = find_inner_balls(a, Tree(a)), of_b = find_inner_balls(b, Tree(b));
  for (int k = 0; k < 20; ++k) {
    const Pose X = bodies::random_pose(random, 0.4);
    const Vector3d t = bodies::random_pose(random, 0.4).t;
    const BallPair found = deepest_pair(of_a, of_b.moved(X), t);
    double most = -1e9;
    for (std::size_t i = 0; i < of_a.size(); ++i) {
      for (std::size_t j = 0; j < of_b.size(); ++j) {
        const double gap = (X * of_b.center(j) + t - of_a.center(i)).norm();
        most = std::max(most, of_a.radius[i] + of_b.radius[j] - gap);
      }
    }
    EXPECT_NEAR(found.overlap, most, 1e-13);
    if (found.overlap <= 0.0) continue;
    EXPECT_LE((found.p - of_a.center(found.a)).norm(), of_a.radius[found.a]);
    EXPECT_LE((found.p - (X * of_b.center(found.b) + t)).norm(), of_b.radius[found.b]);
  }
}

}  // namespace
}  // namespace sixdof::detail
