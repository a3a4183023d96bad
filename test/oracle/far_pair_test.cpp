#include <sixdof/oracle/far_pair.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/models/recipe.h>
#include <sixdof/oracle/distance.h>
#include <sixdof/oracle/near_query.h>
#include <sixdof/oracle/overlap.h>

#include "../geometry/shapes.h"
#include "distance_truth.h"
#include "instruction_sets.h"

// Bodies so far apart that a rounding of their distance is a visible part of their size, up to the largest doubles.

namespace sixdof {
namespace {

using distance_truth::brute_force;
using Eigen::Vector3d;
using shapes::Generator;
using Vector3l = Eigen::Matrix<long double, 3, 1>;

/// The least distance of two vertices in numbers with eleven more bits than doubles, and with exponents that no square
/// of a double exceeds. Where only corners matter, that is their distance: far_pair.h.
double least_distance_of_vertices(const Mesh& a, const Mesh& b, const Pose& X_AB) {
  std::vector<Vector3l> of_b;
  for (const Vector3d& q : b.vertices()) {
    of_b.push_back(X_AB.R.cast<long double>() * q.cast<long double>() + X_AB.t.cast<long double>());
  }
  long double least = std::numeric_limits<long double>::infinity();
  for (const Vector3d& p : a.vertices()) {
    for (const Vector3l& q : of_b) least = std::min(least, (q - p.cast<long double>()).norm());
  }
  return static_cast<double>(least);
}

/// Two units in the last place that are not looked for, half a rounding that is neglected, and the rounding of a corner
/// of B, of its difference to one of A, and of that one's length.
constexpr double k_relative_error = 10.0 * 0x1p-53;

/// Directions: one at random, along an axis, and two that are across faces and edges of boxes but for little.
std::vector<Vector3d> directions(Generator& generator) {
  return {shapes::unit_vector(generator), Vector3d::UnitX(), -Vector3d::UnitZ(), Vector3d(1.0, 1e-13, -3e-9),
          Vector3d(0.6, -0.8, 1e-12)};
}

TEST(FarPair, IsTheClosestOfAllPairsAtAnySeparation) {
  Generator generator(61);
  const std::vector<Mesh> meshes{shapes::bumpy_sphere(2, 0.2), shapes::box({0.5, 0.4, 0.3}, {7.0, -3.0, 2.0}),
                                 make_box({Vector3d(2.0, 2.0, 0.01)}, 200), shapes::bumpy_sphere(1, 0.3, 1e-3)};
  for (const Mesh& a : meshes) {
    for (const Mesh& b : meshes) {
      const DistanceOracle oracle(a, b);
      DistanceQuery query(oracle);
      const detail::DistanceBody body_a(a), body_b(b);
      const double sizes = body_a.tree.radius() + body_b.tree.radius();
      for (const double diameters : {1.1 * detail::k_corners, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e16, 1e20, 1e100,
                                     1e150, 1e155, 1e300, 2e307}) {
        for (const Vector3d& direction : directions(generator)) {
          Pose pose = shapes::random_pose(generator, 0.0);
          if (generator() % 3 == 0) pose.R.setIdentity();
          pose.t = diameters * sizes / direction.cwiseAbs().maxCoeff() * direction;
          ASSERT_TRUE(detail::are_far(body_a, body_b, pose));
          const double truth = least_distance_of_vertices(a, b, pose);
          const Separation found = query.distance(pose);
          ASSERT_TRUE(found.has_witnesses);
          ASSERT_NEAR(found.distance, truth, k_relative_error * truth) << diameters;
          ASSERT_LE(query.counts().triangles, 1u);
          EXPECT_FALSE(query.collide(pose));
          const Triangle& t = a.triangles()[found.triangle_a];
          EXPECT_TRUE(std::any_of(t.begin(), t.end(), [&](auto i) { return a.vertices()[i] == found.witness_a; }));
          const Triangle& u = b.triangles()[found.triangle_b];
          EXPECT_TRUE(
              std::any_of(u.begin(), u.end(), [&](auto i) { return pose * b.vertices()[i] == found.witness_b; }));
        }
      }
    }
  }
}

TEST(FarPair, ReachesFarthestWhereTheDistanceHardlyTellsCornersApart) {
  // Up to a unit in the last place of the distance no corner reaches farther along the line of the centres.
  Generator generator(62);
  const Mesh a = shapes::bumpy_sphere(4, 0.2), b = shapes::bumpy_sphere(3, 0.3, 0.7);
  const DistanceOracle oracle(a, b);
  DistanceQuery query(oracle);
  for (int i = 0; i < 40; ++i) {
    Pose pose = shapes::random_pose(generator, 0.0);
    pose.t = std::pow(10.0, shapes::uniform(generator, 8.5, 12.0)) * shapes::unit_vector(generator);
    const Separation found = query.distance(pose);
    const Vector3d w = (pose * b.center() - a.center()).normalized();
    const double enough = 0x1p-52 * pose.t.norm();
    double farthest = 0.0;
    for (const Vector3d& p : a.vertices()) farthest = std::max(farthest, w.dot(p - a.center()));
    EXPECT_GE(w.dot(found.witness_a - a.center()), farthest - enough);
    EXPECT_LE(w.dot(found.witness_a - a.center()), farthest + 1e-14);
  }
}

TEST(FarPair, IsTheClosestOfAllPairsOfTriangles) {
  // Where a point of a face or of an edge may be closer than all corners. Both orders.
  Generator generator(63);
  int count = 0;
  const std::vector<Mesh> meshes{shapes::bumpy_sphere(1, 0.2), shapes::box({0.5, 0.4, 0.3}, {7.0, -3.0, 2.0}),
                                 make_box({Vector3d(2.0, 2.0, 0.01)}, 200), shapes::bumpy_sphere(1, 0.3, 1e-3)};
  for (const Mesh& a : meshes) {
    for (const Mesh& b : meshes) {
      const DistanceOracle oracle(a, b), swapped(b, a);
      DistanceQuery query(oracle), back(swapped);
      const detail::DistanceBody body_a(a), body_b(b);
      const double sizes = body_a.tree.radius() + body_b.tree.radius();
      for (const double ratio : {1.1 * detail::k_far, 300.0, 1e4, 1e5, 1e6, 1e7, 0.9 * detail::k_corners}) {
        for (const Vector3d& direction : directions(generator)) {
          Pose pose = shapes::random_pose(generator, 0.0);
          if (generator() % 3 == 0) pose.R.setIdentity();
          pose.t = ratio * sizes / direction.cwiseAbs().maxCoeff() * direction;
          const auto expect_closest = [&](DistanceQuery& asked, const Mesh& x, const Mesh& y, const Pose& X_XY) {
            if (!detail::are_far(detail::DistanceBody(x), detail::DistanceBody(y), X_XY)) return;  // for few directions
            ++count;
            const double truth = brute_force(x, y, X_XY).distance;
            const Separation found = asked.distance(X_XY);
            EXPECT_GE(found.distance, truth) << ratio;
            EXPECT_LE(found.distance, (1.0 + detail::k_far_pair_error) * truth) << ratio;
            EXPECT_NEAR(found.distance, (found.witness_b - found.witness_a).norm(), k_relative_error * truth) << ratio;
          };
          expect_closest(query, a, b, pose);
          expect_closest(back, b, a, pose.inverse());
        }
      }
    }
  }
  EXPECT_GT(count, 500);
}

TEST(FarPair, MeetsTheSearchAtTheLimits) {
  // On both sides of each the same distance up to rounding.
  Generator generator(67);
  const Mesh a = shapes::bumpy_sphere(2, 0.2), b = make_box({}, 60);
  const DistanceOracle oracle(a, b);
  DistanceQuery query(oracle);
  const detail::DistanceBody body_a(a), body_b(b);
  const double sizes = oracle.tree_a().radius() + oracle.tree_b().radius();
  for (int i = 0; i < 20; ++i) {
    Pose pose = shapes::random_pose(generator, 0.0);
    Vector3d direction = shapes::unit_vector(generator);
    direction /= direction.cwiseAbs().maxCoeff();
    for (const double limit : {detail::k_far, detail::k_corners}) {
      for (const double factor : {0.999, 1.001}) {
        pose.t = factor * limit * sizes * direction;
        ASSERT_EQ(detail::are_far(body_a, body_b, pose), factor > 1.0 || limit > detail::k_far);
        const double truth = brute_force(a, b, pose).distance;
        EXPECT_NEAR(query.distance(pose).distance, truth, k_relative_error * truth);
      }
    }
  }
}

TEST(FarPair, CostsAboutAsMuchAtAnySeparation) {
  // A smooth body, of which many corners reach equally far but for little, and a face across the line of the centres.
  // Two such bodies at 1e13 diameters took thousands of exact distances.
  const Mesh sphere = make_sphere({}, 30000), plate = make_box({Vector3d(2.0, 2.0, 0.1)}, 30000);
  Generator generator(64);
  const Pose tilted = shapes::random_pose(generator, 0.0);
  const Mesh turned = shapes::moved(plate, tilted);
  for (const auto& [a, b] : {std::pair(&sphere, &sphere), std::pair(&plate, &plate), std::pair(&turned, &sphere),
                             std::pair(&sphere, &plate), std::pair(&turned, &turned)}) {
    const DistanceOracle oracle(*a, *b);
    DistanceQuery query(oracle);
    for (const double far : {100.0, 1e3, 1e6, 1e7, 1e8, 1e10, 1e11, 1e12, 1e13, 1e14, 1e16, 1e100, 1e300}) {
      // Nearer than k_corners, all corners of a face across the line of the centres are looked at, and its pairs that
      // floats blur: 34,005 nodes and 449 pairs of triangles at most from 1e6 on, of 225 million pairs; at 100
      // 795,017 and 51,695.
      const bool only_corners = far > 1e9, close = far < 1e6;
      for (const Vector3d& along :
           {Vector3d(Vector3d::UnitZ()), Vector3d(tilted.R.col(2)), shapes::unit_vector(generator)}) {
        for (const bool rotated : {false, true}) {
          Pose pose;
          if (rotated) pose.R = shapes::random_pose(generator, 0.0).R;
          pose.t = far * along;
          query.distance(pose, false);
          EXPECT_LT(query.counts().nodes, only_corners ? 2000u : close ? 1500000u : 50000u) << far;
          EXPECT_LE(query.counts().triangles, only_corners ? 1u : close ? 100000u : 600u) << far;
        }
      }
    }
  }
}

TEST(FarPair, IsTheSameBitsWarmAndOnEveryInstructionSetAndOfManyMeshes) {
  Generator generator(65);
  const Mesh a = make_box({}, 3000), b = shapes::bumpy_sphere(3, 0.2);
  const DistanceOracle oracle(a, b);
  DistanceQuery warm(oracle);
  const PreparedMesh prepared_a(a), prepared_b(b);
  NearQuery near;
  NearHint hint;
  for (int i = 0; i < 12; ++i) {
    Pose pose = shapes::random_pose(generator, 0.0);
    if (i % 3 == 0) warm.distance(pose);  // a start from a pair that is not far
    pose.t = std::pow(10.0, 8.6 + 8.0 * i) * shapes::unit_vector(generator);
    const Separation cold = DistanceQuery(oracle).distance(pose, false);
    const auto expect_same = [&](const Separation& x) {
      EXPECT_EQ(x.distance, cold.distance);
      EXPECT_EQ(x.witness_a, cold.witness_a);
      EXPECT_EQ(x.witness_b, cold.witness_b);
      EXPECT_EQ(x.triangle_a, cold.triangle_a);
      EXPECT_EQ(x.triangle_b, cold.triangle_b);
    };
    expect_same(warm.distance(pose));
    for_each_instruction_set([&] { expect_same(DistanceQuery(oracle).distance(pose, false)); });
    EXPECT_EQ(near.distance(prepared_a, prepared_b, pose, NearQuery::k_no_limit, hint), cold.distance);
    EXPECT_EQ(near.distance(prepared_a, prepared_b, pose, cold.distance, hint), cold.distance);
    EXPECT_FALSE(near.distance(prepared_a, prepared_b, pose, std::nextafter(cold.distance, 0.0), hint));
    EXPECT_FALSE(near.surfaces_meet(prepared_a, prepared_b, pose, hint));
  }
}

TEST(FarPair, BeyondTheLargestDoubleTheDistanceIsInfiniteAndNothingMeets) {
  const Mesh mesh = shapes::bumpy_sphere(2, 0.2);
  const DistanceOracle oracle(mesh, mesh);
  DistanceQuery query(oracle);
  const Solid solid(mesh, oracle.tree_a());
  OverlapQuery overlap(solid, solid);
  constexpr double k_largest = std::numeric_limits<double>::max();
  Pose pose;
  pose.t = Vector3d(k_largest, 0.0, 0.0);
  EXPECT_EQ(query.distance(pose).distance, k_largest);
  for (const Vector3d& t : {Vector3d(k_largest, 0.0, 0.0), Vector3d(1.5e308, -1.5e308, 1.5e308)}) {
    Generator generator(66);
    for (int i = 0; i < 5; ++i) {
      pose = {shapes::random_pose(generator, 0.0).R, t};
      if (i == 0) pose.R.setIdentity();
      EXPECT_FALSE(query.collide(pose));
      EXPECT_EQ(overlap.evaluate(pose).volume, 0.0);
      EXPECT_EQ(overlap.evaluate(pose).area, Vector3d::Zero());
      if (t.y() == 0.0) continue;
      EXPECT_EQ(query.distance(pose).distance, std::numeric_limits<double>::infinity());
    }
  }
}

}  // namespace
}  // namespace sixdof
