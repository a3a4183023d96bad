#include <sixdof/oracle/winding.h>

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/distance.h>

#include "../geometry/shapes.h"
#include "bodies.h"

namespace sixdof {
namespace {

using Eigen::Vector3d;
using shapes::Generator;
using shapes::uniform;

int of_a(const Mesh& mesh, const Vector3d& p) {
  std::vector<std::uint32_t> scratch;
  return detail::winding_of_a(Tree(mesh), p, scratch);
}

int of_b(const Mesh& mesh, const Pose& X_AB, const Vector3d& p) {
  std::vector<std::uint32_t> scratch;
  return detail::winding_of_b(Tree(mesh), X_AB, transform_point, p, scratch);
}

TEST(Winding, TellsInsideFromOutside) {
  Generator generator(12);
  const Vector3d center(10.0, 20.0, -5.0);
  const Mesh mesh = shapes::bumpy_sphere(3, 0.2, 1.0, center);
  const Pose pose = shapes::random_pose(generator, 3.0);
  int inside = 0;
  for (int i = 0; i < 500; ++i) {
    // Star-shaped: the surface is at radii between 0.75, for the flatness of the triangles, and 1.2.
    const double r = uniform(generator, 0.0, 1.5);
    const Vector3d p = center + r * shapes::unit_vector(generator);
    const int winding = of_a(mesh, p);
    EXPECT_EQ(of_b(mesh, pose, pose * p), winding);
    EXPECT_TRUE(winding == 0 || winding == 1);
    if (r < 0.75) {
      EXPECT_EQ(winding, 1);
    }
    if (r > 1.21) {
      EXPECT_EQ(winding, 0);
    }
    inside += winding;
  }
  EXPECT_GT(inside, 200);
}

TEST(Winding, SegmentsThroughEdgesAndVerticesCountOnce) {
  // From the lattice points inside, axis-parallel segments run through vertices, along edges and through the diagonals
  // of faces.
  const Mesh octahedron = bodies::bumpy_sphere(0, 0.0, 1.0);
  const Mesh box = bodies::box({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0});
  const Mesh steps = bodies::together(box, bodies::box({1.0, -0.5, -1.0}, {2.0, 0.5, 0.5}));
  for (int i = 0; i < 9 * 9 * 9; ++i) {
    const Vector3d p = 0.25 * Vector3d(i % 9 - 4, i / 9 % 9 - 4, i / 81 - 4);
    const double sum = p.lpNorm<1>();
    if (sum != 1.0) {
      EXPECT_EQ(of_a(octahedron, p), sum < 1.0) << p.transpose();
      EXPECT_EQ(of_b(octahedron, Pose{}, p), sum < 1.0) << p.transpose();
    }
    if (p.lpNorm<Eigen::Infinity>() < 1.0) {
      EXPECT_EQ(of_a(box, p), 1) << p.transpose();
      EXPECT_EQ(of_a(steps, p), 1) << p.transpose();
      EXPECT_EQ(of_b(steps, Pose{}, p), 1) << p.transpose();
    }
  }
}

TEST(Winding, PointsOnTheSurfaceAreDecidedByTheTranslationOfB) {
  // B is translated by (eps, eps^2, eps^3): off the +x, +y, +z faces of A and into the others.
  const Mesh box = bodies::box({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0});
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      Vector3d p(0.25, -0.5, 0.125);
      p[axis] = sign;
      EXPECT_EQ(of_a(box, p), sign < 0.0);
      EXPECT_EQ(of_b(box, Pose{}, p), sign > 0.0);
    }
  }
  // At a vertex and on an edge the first component that leaves or enters decides.
  EXPECT_EQ(of_a(box, {-1.0, -1.0, -1.0}), 1);
  EXPECT_EQ(of_a(box, {-1.0, -1.0, 1.0}), 0);
  EXPECT_EQ(of_b(box, Pose{}, {1.0, 1.0, 0.5}), 1);
}

TEST(Winding, CountsLayers) {
  const Mesh inner = shapes::box({0.5, 0.5, 0.5});
  const Mesh outer = shapes::box({1.0, 1.0, 1.0});
  const Mesh twice = bodies::together(outer, inner);
  const Mesh hollow = bodies::together(outer, bodies::inside_out(inner));
  const Pose pose{Eigen::AngleAxisd(0.7, Vector3d(0.36, 0.48, 0.8)).toRotationMatrix(), {0.31, -0.17, 0.23}};
  const Vector3d core(0.11, -0.23, 0.31), shell(0.11, -0.23, 0.77);
  for (const auto& [mesh, in_core] : {std::pair(&twice, 2), std::pair(&hollow, 0)}) {
    EXPECT_EQ(of_a(*mesh, core), in_core);
    EXPECT_EQ(of_a(*mesh, shell), 1);
    EXPECT_EQ(of_b(*mesh, pose, pose * core), in_core);
    EXPECT_EQ(of_b(*mesh, pose, pose * shell), 1);
  }
}

TEST(Winding, FarFromTheOrigin) {
  Generator generator(29);
  for (int i = 0; i < 40; ++i) {
    const Vector3d at = 1e9 * shapes::unit_vector(generator);
    const Mesh mesh = shapes::box({1.0, 1.0, 1.0}, at);
    Pose pose = shapes::random_pose(generator, 0.0);
    pose.t = 1e9 * shapes::unit_vector(generator);
    const Vector3d inside = at + shapes::uniform_vector(generator, 0.9);
    const Vector3d outside = at + uniform(generator, 1.8, 3.0) * shapes::unit_vector(generator);
    EXPECT_EQ(of_a(mesh, inside), 1);
    EXPECT_EQ(of_a(mesh, outside), 0);
    EXPECT_EQ(of_b(mesh, pose, pose * inside), 1);
    EXPECT_EQ(of_b(mesh, pose, pose * outside), 0);
  }
}

TEST(Winding, DecidesCollisionsOfBlocksInARow) {
  // Two blocks as one mesh, and a small one inside one of them or between them.
  Generator generator(29);
  const Vector3d half(1.1, 0.9, 1.3);
  const Vector3d aside(0.3, -0.2, 0.4);
  const Mesh small = shapes::box({0.03, 0.02, 0.04});
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Vector3d row = Vector3d::Unit(axis);
    const Mesh blocks = bodies::together(shapes::box(half, -2.5 * row), shapes::box(half, 2.5 * row));
    const DistanceOracle forth(small, blocks);
    const DistanceOracle back(blocks, small);
    DistanceQuery query(forth);
    DistanceQuery query_back(back);
    for (int i = 0; i < 8; ++i) {
      const Vector3d along = i % 2 == 0 ? row : Vector3d(-row);
      const Pose pose = shapes::random_pose(generator, 3.0);
      const auto check = [&](const Vector3d& p, int winding) {
        EXPECT_EQ(of_b(blocks, pose, pose * p), winding) << "p " << p.transpose();
        const Pose around{pose.R, pose.t - pose * p};  // p, and with it the small block, at A's origin
        EXPECT_GT(query.distance(around).distance, 0.0);
        EXPECT_EQ(query.collide(around), winding == 1) << "p " << p.transpose();
        EXPECT_EQ(query_back.collide(around.inverse()), winding == 1) << "p " << p.transpose();
      };
      for (const Vector3d& off : {Vector3d(Vector3d::Zero()), aside}) {
        check(2.5 * along + off, 1);
        check(2.5 * along + 0.6 * half.cwiseProduct(along) + off, 1);
        check(0.7 * along + off, 0);
      }
    }
  }
}

}  // namespace
}  // namespace sixdof
