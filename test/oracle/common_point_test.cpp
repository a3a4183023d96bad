// The deepest common point of two bodies, where it is known.

#include <sixdof/oracle/common_point.h>

#include <gtest/gtest.h>

#include "bodies.h"

namespace sixdof::detail {
namespace {

using bodies::box;
using bodies::moved;
using Eigen::Vector3d;

constexpr CommonPointSearch::Effort k_thorough{.gain = 1e-3, .most = 200};

TEST(CommonPoint, ClimbsToTheMiddleOfTheOverlapOfBoxes) {
  std::mt19937_64 random(31);
  const Pose X_WA = bodies::random_pose(random, 0.7);
  const Mesh a = moved(box({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}), X_WA), b = box({-0.2, -0.3, -0.4}, {0.2, 0.3, 0.4});
  const Pose X_AB = X_WA * Pose{Eigen::Matrix3d::Identity(), {0.6, 0.2, -0.1}};  // they share 0.1 along x
  const Tree tree_a(a), tree_b(b);
  CommonPointSearch search(a, tree_a, b, tree_b);
  for (const Vector3d& p : {Vector3d(0.47, 0.3, 0.1), Vector3d(0.7, 0.1, -0.2), Vector3d(0.2, -0.2, 0.4)}) {
    const CommonPoint start = search.at(X_WA * p, X_AB, 0, 0);
    const CommonPoint top = search.ascend(start, X_AB, 0.1, k_thorough);
    EXPECT_LE(top.depth(), 0.05 + 1e-12);
    EXPECT_GE(top.depth(), 0.045) << p.transpose();
    EXPECT_GE(top.depth(), start.depth());
    EXPECT_NEAR((top.p - X_AB * top.b.p).norm(), 0.0, 1e-14);
  }
}

TEST(CommonPoint, ClimbsOutOfThePointOfAThinWedge) {
  // B's lower face leans by `angle` over A's upper one: the overlap is a wedge that opens along x, from its point at 0.
  for (const double angle : {1e-1, 1e-2, 1e-3}) {
    const Mesh a = box({-0.5, -0.4, -0.6}, {0.5, 0.4, 0.0}), b = box({-0.5, -0.3, 0.0}, {0.5, 0.3, 0.6});
    const Pose X_AB{Eigen::AngleAxisd(angle, Vector3d::UnitY()).toRotationMatrix(), Vector3d::Zero()};
    const Tree tree_a(a), tree_b(b);
    CommonPointSearch search(a, tree_a, b, tree_b);
    const double x = 1e-6;
    const CommonPoint start = search.at({x, 0.03, -0.45 * angle * x}, X_AB, 0, 0);
    ASSERT_GT(start.depth(), 0.0);
    const CommonPoint top = search.ascend(start, X_AB, start.depth(), {.gain = 0.2, .most = 40});
    EXPECT_GT(top.depth(), 0.05 * angle) << angle << ": the widest place has half of the angle";
  }
}

TEST(CommonPoint, MeasuresBothSignedDistances) {
  std::mt19937_64 random(32);
  const Mesh a = bodies::bumpy_sphere(3), b = bodies::bumpy_torus(30, 15);
  const Tree tree_a(a), tree_b(b);
  CommonPointSearch search(a, tree_a, b, tree_b);
  for (int i = 0; i < 40; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.4);
    const Vector3d p = bodies::random_pose(random, 0.5).t;
    const CommonPoint point = search.at(p, X_AB, 0, 0);
    SignedDepth in_a(a, tree_a), in_b(b, tree_b);
    EXPECT_EQ(point.a.s, in_a.at(p, 0).s);
    EXPECT_NEAR(point.b.s, in_b.at(X_AB.inverse() * p, 0).s, 1e-14);
    EXPECT_EQ(point.depth(), std::min(-point.a.s, -point.b.s));
  }
}

TEST(CommonPoint, NeverFalls) {
  std::mt19937_64 random(33);
  const Mesh a = bodies::bumpy_torus(30, 15), b = bodies::bumpy_sphere(3);
  const Tree tree_a(a), tree_b(b);
  CommonPointSearch search(a, tree_a, b, tree_b);
  int inside = 0;
  for (int i = 0; i < 40; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.3);
    const CommonPoint start = search.at(bodies::random_pose(random, 0.5).t, X_AB, 0, 0);
    const CommonPoint top = search.ascend(start, X_AB, 0.1, {.gain = 0.05, .most = 40});
    EXPECT_GE(top.depth(), start.depth());
    inside += top.depth() > 0.0;
  }
  EXPECT_GE(inside, 20);
}

}  // namespace
}  // namespace sixdof::detail
