#include <sixdof/algorithm/vps/pointshell.h>

#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>
#include <sixdof/geometry/closest_point.h>

#include "bodies.h"

namespace sixdof::vps {
namespace {

using vps_test::ball;
using vps_test::box;
using vps_test::generic_pose;
using vps_test::inside_out;
using vps_test::moved;

constexpr double k_rounding = 1e-12;  // of coordinates and areas of the order of 1, thousands of terms
constexpr double k_sliver = 1e-11;    // the same for triangles a thousand times as long as high

double total_area(const PointShell& shell) { return std::accumulate(shell.areas.begin(), shell.areas.end(), 0.0); }

void expect_points_on(const Mesh& body, const PointShell& shell) {
  const Tree tree(body);
  ASSERT_FALSE(shell.points.empty());
  for (std::size_t i = 0; i < shell.points.size(); ++i) {
    ASSERT_LT(closest_point(tree, shell.points[i])->distance, k_sliver);
    ASSERT_NEAR(shell.normals[i].norm(), 1.0, k_rounding);
    ASSERT_GT(shell.areas[i], 0.0);
  }
  EXPECT_NEAR(total_area(shell), body.area(), k_rounding * body.area());
}

TEST(PointShell, HasInwardNormalsOfTheFacesOfABox) {
  const Pose X = generic_pose(31, 0.7);
  const Eigen::Vector3d size(1.0, 0.8, 0.6);
  const Mesh body = moved(box(size), X);
  const PointShell shell = PointShell::build(body, 0.05);
  expect_points_on(body, shell);
  for (std::size_t i = 0; i < shell.points.size(); ++i) {
    const Eigen::Vector3d p = X.inverse() * shell.points[i], n = X.R.transpose() * shell.normals[i];
    int axis = 0;
    n.cwiseAbs().maxCoeff(&axis);
    ASSERT_NEAR(std::abs(n[axis]), 1.0, k_rounding);
    ASSERT_NEAR(p[axis], -std::copysign(0.5 * size[axis], n[axis]), k_rounding);  // inwards: away from its own face
  }
}

TEST(PointShell, HasRadialNormalsOnABall) {
  const Mesh body = ball(0.9, 2000);
  const double spacing = 0.06;
  const PointShell shell = PointShell::build(body, spacing);
  expect_points_on(body, shell);
  // A cell's middle is within half a spacing of its point; this mesh's normals differ from the radial direction by up
  // to half an edge (0.10) over the radius.
  const double largest_angle = 0.5 * spacing / 0.9 + 0.055;
  for (std::size_t i = 0; i < shell.points.size(); ++i) {
    const Eigen::Vector3d inwards = -shell.points[i].normalized();
    ASSERT_LT(std::atan2(inwards.cross(shell.normals[i]).norm(), inwards.dot(shell.normals[i])), largest_angle);
  }
}

TEST(PointShell, IsNearUniformWithoutGaps) {
  const Mesh body =
      moved(make_bumpy_sphere({.radius = 0.8, .amplitude = 0.2, .waves = 1.0}, 1200), generic_pose(33, 0.2));
  const double spacing = 0.06;
  const PointShell shell = PointShell::build(body, spacing);
  const double mean = total_area(shell) / static_cast<double>(shell.areas.size());
  EXPECT_GT(mean, 0.8 * spacing * spacing);
  EXPECT_LT(mean, 1.4 * spacing * spacing);
  double crowded = 0.0;
  const auto nearest = [&](const Eigen::Vector3d& p, std::size_t except) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < shell.points.size(); ++j) {
      if (j != except) least = std::min(least, (p - shell.points[j]).squaredNorm());
    }
    return std::sqrt(least);
  };
  for (std::size_t i = 0; i < shell.points.size(); ++i) {
    EXPECT_LT(shell.areas[i], 3.0 * mean);
    const double gap = nearest(shell.points[i], i);
    crowded += gap < 0.5 * spacing ? 1.0 : 0.0;
    ASSERT_LT(gap, 2.0 * spacing);
  }
  // Thinning leaves 3/4 of a spacing; moving to the middle of cells brings a few points closer together.
  EXPECT_LT(crowded, 0.01 * static_cast<double>(shell.points.size()));
  for (const Eigen::Vector3d& v : body.vertices()) ASSERT_LT(nearest(v, shell.points.size()), 1.5 * spacing);
}

TEST(PointShell, HasPointsOnBothSidesOfAThinPlate) {
  const Pose X = generic_pose(34, 0.3);
  const Mesh plate = moved(box({1.0, 0.8, 0.001}), X);
  const PointShell shell = PointShell::build(plate, 0.05);
  expect_points_on(plate, shell);
  double up = 0.0, down = 0.0;
  for (std::size_t i = 0; i < shell.points.size(); ++i) {
    const double z = (X.R.transpose() * shell.normals[i]).z();
    if (z > 0.9) up += shell.areas[i];
    if (z < -0.9) down += shell.areas[i];
  }
  EXPECT_NEAR(up, 0.8, k_rounding);
  EXPECT_NEAR(down, 0.8, k_rounding);
}

TEST(PointShell, IsTheSameForAnyNumberOfThreads) {
  const Mesh body = make_bumpy_sphere({}, 900);
  const auto build = [&](unsigned threads) {
    PointShell shell;
    parallel::with_threads(threads, [&] { shell = PointShell::build(body, 0.06); });
    return shell;
  };
  const PointShell one = build(1), four = build(4);
  EXPECT_EQ(one.points, four.points);
  EXPECT_EQ(one.normals, four.normals);
  EXPECT_EQ(one.areas, four.areas);
}

TEST(PointShell, RefusesMeshesThatAreNotSolid) {
  EXPECT_THROW(PointShell::build(inside_out(box({1.0, 2.0, 3.0})), 0.1), BadMesh);
}

}  // namespace
}  // namespace sixdof::vps
