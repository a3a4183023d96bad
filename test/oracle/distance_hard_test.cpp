#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/models/recipe.h>
#include <sixdof/oracle/distance.h>
#include <sixdof/oracle/far_pair.h>

#include "../geometry/shapes.h"
#include "distance_truth.h"

// Coordinates far from the origin, distances that differ by less than float rounding, and the work of a search.

namespace sixdof {
namespace {

constexpr double k_below_width = 1e-9;          // below the width of a needle by orders of magnitude
constexpr double k_tessellation_of_gap = 1e-5;  // of the gap of round bodies, from their tessellation

using distance_truth::brute_force;
using Eigen::Vector3d;
using shapes::Generator;

TEST(DistanceOracle, FarFromTheOriginEveryBitIsThatOfBruteForce) {
  // At 1e10 .. 1e11 times the meshes' size the rounding of transformed corners exceeds that of the floats.
  Generator generator(21);
  int apart = 0;
  for (int i = 0; i < 30; ++i) {
    const Vector3d at_a = (i % 3 == 0 ? 1e10 : 1e11) * shapes::unit_vector(generator);
    const Vector3d at_b = i % 3 == 2 ? Vector3d(0.3, 0.1, -0.2) : Vector3d(1e11 * shapes::unit_vector(generator));
    const Mesh a = shapes::bumpy_sphere(2, 0.2, 1.0, at_a);
    const Mesh b = shapes::bumpy_sphere(2, 0.3, 0.7, at_b);
    const DistanceOracle oracle(a, b);
    DistanceQuery query(oracle);
    Pose pose = shapes::random_pose(generator, 0.0);
    pose.t = at_a - pose.R * at_b + 1.9 * shapes::unit_vector(generator);
    const Separation truth = brute_force(a, b, pose);
    const Separation d = query.distance(pose);
    EXPECT_EQ(d.distance, truth.distance);
    EXPECT_EQ(query.collide(pose, false), truth.distance == 0.0);
    if (truth.distance > 0.0) {
      ++apart;
      EXPECT_EQ(d.triangle_a, truth.triangle_a);
      EXPECT_EQ(d.triangle_b, truth.triangle_b);
    }
  }
  EXPECT_GT(apart, 10);
}

/// Triangles above the plane z = 0, each with its corner of least z at `gap` .. `gap` + `spread`.
Mesh spikes(Generator& generator, std::size_t count, double gap, double spread) {
  std::vector<Vector3d> v;
  std::vector<Triangle> t;
  for (std::uint32_t i = 0; i < count; ++i) {
    Vector3d tip = shapes::uniform_vector(generator, 0.4);
    tip.z() = gap + shapes::uniform(generator, 0.0, spread);
    v.push_back(tip);
    for (int k = 0; k < 2; ++k) {
      Vector3d p = tip + shapes::uniform_vector(generator, 0.02);
      p.z() = tip.z() + shapes::uniform(generator, 0.01, 0.05);
      v.push_back(p);
    }
    t.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return Mesh::build(v, t);
}

TEST(DistanceOracle, DistancesThatDifferByLessThanFloatRoundingAreDistinguished) {
  // Hundreds of tips over a plate, at distances that only doubles distinguish: bounds in floats prune none of them. At
  // the origin, and far from it where the rounding of transformed corners exceeds that of the floats.
  Generator generator(27);
  for (int i = 0; i < 60; ++i) {
    const double gap = std::pow(10.0, shapes::uniform(generator, -3.0, 0.0));
    const double far = i % 3 == 0 ? std::pow(10.0, shapes::uniform(generator, 9.0, 11.5)) : 0.3;
    const double spread = std::max(std::pow(10.0, shapes::uniform(generator, -9.0, -5.0)), 4e-16 * far);
    Pose at_a = shapes::random_pose(generator, 0.0);
    Pose at_b = shapes::random_pose(generator, 0.0);
    at_a.t = far * shapes::unit_vector(generator);
    at_b.t = far * shapes::unit_vector(generator);
    const Mesh plate = shapes::moved(
        Mesh::build({{-1.0, -1.0, 0.0}, {1.0, -1.0, 0.0}, {1.0, 1.0, 0.0}, {-1.0, 1.0, 0.0}}, {{0, 1, 2}, {0, 2, 3}}),
        at_a);
    const Mesh tips = shapes::moved(spikes(generator, 300, gap, spread), at_b);
    const DistanceOracle oracle(plate, tips);
    const DistanceOracle swapped(tips, plate);
    const Pose pose = at_a * at_b.inverse();
    ASSERT_EQ(oracle.tie_width(pose), 0.0);
    const auto expect_same = [](const Separation& answer, const Separation& truth) {
      EXPECT_EQ(answer.distance, truth.distance);
      if (truth.distance == 0.0) return;
      EXPECT_EQ(answer.triangle_a, truth.triangle_a);
      EXPECT_EQ(answer.triangle_b, truth.triangle_b);
    };
    expect_same(DistanceQuery(oracle).distance(pose), brute_force(plate, tips, pose));
    expect_same(DistanceQuery(swapped).distance(pose.inverse()), brute_force(tips, plate, pose.inverse()));
  }
}

TEST(DistanceOracle, FarApartEveryBitIsThatOfBruteForce) {
  // Up to where far_pair.h takes over, which promises less (far_pair_test.cpp).
  Generator generator(28);
  const Mesh a = shapes::bumpy_sphere(1, 0.2);
  const Mesh b = shapes::bumpy_sphere(1, 0.3, 0.7);
  const DistanceOracle oracle(a, b);
  const double farthest = detail::k_far * (oracle.tree_a().radius() + oracle.tree_b().radius());
  for (int i = 0; i < 40; ++i) {
    Pose pose = shapes::random_pose(generator, 0.0);
    pose.t = std::pow(10.0, shapes::uniform(generator, 1.0, std::log10(farthest))) * shapes::unit_vector(generator);
    const Separation truth = brute_force(a, b, pose);
    const Separation d = DistanceQuery(oracle).distance(pose);
    EXPECT_EQ(d.distance, truth.distance);
    EXPECT_EQ(d.triangle_a, truth.triangle_a);
    EXPECT_EQ(d.triangle_b, truth.triangle_b);
  }
}

/// Needles along x side by side in y: tetrahedra of length 1 with a ridge of height `width` over their middle.
Mesh comb(std::uint32_t count, double width) {
  std::vector<Vector3d> v;
  std::vector<Triangle> t;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double y = static_cast<double>(i) / count;
    for (const Vector3d& p :
         {Vector3d(0.0, y, 0.0), Vector3d(1.0, y, 0.0), Vector3d(0.5, y + width, 0.0), Vector3d(0.5, y, width)}) {
      v.push_back(p);
    }
    t.insert(t.end(), {{4 * i, 4 * i + 2, 4 * i + 1},
                       {4 * i, 4 * i + 1, 4 * i + 3},
                       {4 * i + 1, 4 * i + 2, 4 * i + 3},
                       {4 * i, 4 * i + 3, 4 * i + 2}});
  }
  return Mesh::build(v, t);
}

TEST(DistanceOracle, OfNeedlesThatCrossFewAreMeasured) {
  // Each needle of B runs over all of A, at the height of A's ridges at its place: the middle ones are the closest. All
  // boxes, slabs and gaps along the closest direction are the same.
  constexpr std::uint32_t k_needles = 200;
  constexpr double k_gap = 1e-3, k_width = 1e-4;
  const Mesh a = comb(k_needles, k_width);
  const DistanceOracle oracle(a, a);
  DistanceQuery query(oracle);
  Pose pose;  // B's needles along y, upside up: their lower sides are flat
  pose.R << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  pose.t = Vector3d(1.0 + 0.5 * k_width, 0.0, k_gap);
  // One needle's base, `width` wide, runs over the ridges' middle.
  EXPECT_NEAR(query.distance(pose).distance, k_gap - k_width, k_below_width);
  EXPECT_LE(query.counts().triangles, std::uint64_t{k_needles} * k_needles);
  const Pose back = pose.inverse();
  EXPECT_NEAR(query.distance(back).distance, k_gap - k_width, k_below_width);
}

TEST(DistanceOracle, OfRodsThatCrossFewNodesAreExpanded) {
  // Strips that are as long as the bodies: nearly all boxes are apart only along an axis across both rods, which is not
  // the one between the centres.
  constexpr double k_radius = 0.1;
  const Mesh a = shapes::rod(2000, k_radius);
  const DistanceOracle oracle(a, a);
  DistanceQuery query(oracle);
  Generator generator(27);
  detail::TraversalCounts far, touching;
  for (int i = 0; i < 20; ++i) {
    Pose pose = shapes::random_pose(generator, 0.0);
    pose.t.setZero();
    const Vector3d across = Vector3d::UnitZ().cross(pose.R.col(2)).normalized();
    const Vector3d along = shapes::uniform(generator, -0.7, 0.7) * Vector3d::UnitZ() +
                           shapes::uniform(generator, -0.7, 0.7) * pose.R.col(2);
    pose.t = along + (2.0 * k_radius + 0.02) * across;
    EXPECT_NEAR(query.distance(pose, false).distance, 0.02, k_tessellation_of_gap);
    far.nodes += query.counts().nodes;
    far.triangles += query.counts().triangles;
    pose.t = along + (2.0 * k_radius + 1e-5) * across;
    EXPECT_FALSE(query.collide(pose, false));
    touching.nodes += query.counts().nodes;
    touching.triangles += query.counts().triangles;
    EXPECT_TRUE(query.collide({pose.R, along + (2.0 * k_radius - 1e-5) * across}, false));
  }
  EXPECT_LT(far.nodes, 8000u);
  EXPECT_LT(far.triangles, 15000u);
  EXPECT_LT(touching.nodes, 60000u) << "690,078 without the axes across";
  EXPECT_LT(touching.triangles, 10000u);
}

TEST(DistanceOracle, OfSolidsWhoseFacesNearlyCoincideFewAreTestedForAnIntersection) {
  // A plate on a plate, tilted about a line of both meshes: along that line faces touch but for rounding, on one side
  // of it B's corners are inside A. An open plate has no inside.
  const Mesh plate = make_box({Vector3d(2.0, 2.0, 0.1)}, 100000);
  std::vector<Triangle> all_but_one(plate.triangles().begin(), plate.triangles().end() - 1);
  const Mesh open = Mesh::build(plate.vertices(), all_but_one);
  const DistanceOracle oracle(plate, plate), of_open(open, open);
  DistanceQuery query(oracle), query_of_open(of_open);
  for (const Vector3d& axis : {Vector3d(1.0, 0.0, 0.0), Vector3d(0.0, -1.0, 0.0), Vector3d(0.6, 0.8, 0.0)}) {
    for (const double angle : {1e-9, -1e-9, 1e-7}) {
      const Pose pose{Eigen::AngleAxisd(angle, axis).toRotationMatrix(), Vector3d(0.0, 0.0, 0.1)};
      EXPECT_TRUE(query.collide(pose, false));
      EXPECT_LT(query.counts().leaf_pairs + query.counts().triangles, 400u) << angle;
      EXPECT_EQ(query_of_open.collide(pose, false), query_of_open.distance(pose, false).distance == 0.0);
      EXPECT_TRUE(query.collide(pose.inverse(), false));
      // Clear of each other by less than the tilt moves the border.
      Pose above = pose;
      above.t.z() += 1.5 * std::abs(angle);
      EXPECT_EQ(query.collide(above, false), query.distance(above, false).distance == 0.0);
    }
  }
}

TEST(DistanceOracle, ColdSearchesExpandFewNodes) {
  // By the seed, the order of expansion and the axis between the closest points. Sums over the poses, with a margin for
  // other trees.
  const Mesh a = shapes::bumpy_sphere(6, 0.2);
  const DistanceOracle oracle(a, a);
  DistanceQuery query(oracle);
  Generator generator(22);
  detail::TraversalCounts sum;
  constexpr int k_poses = 60;
  for (int i = 0; i < k_poses; ++i) {
    Pose pose = shapes::random_pose(generator, 0.0);
    pose.t = shapes::uniform(generator, 2.3, 3.0) * shapes::unit_vector(generator);
    ASSERT_GT(query.distance(pose, false).distance, 0.0);
    sum.nodes += query.counts().nodes;
    sum.leaf_pairs += query.counts().leaf_pairs;
    sum.triangles += query.counts().triangles;
  }
  EXPECT_LT(sum.nodes, 80000u);
  EXPECT_LT(sum.leaf_pairs, 54000u);
  EXPECT_LT(sum.triangles, 6000u);
}

}  // namespace
}  // namespace sixdof
