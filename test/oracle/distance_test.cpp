#include <sixdof/oracle/distance.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "../geometry/shapes.h"
#include "bodies.h"
#include "distance_truth.h"
#include "instruction_sets.h"

namespace sixdof {
namespace {

constexpr double k_reach_of_both = 3.0;  // the radii of both bodies, with room

using distance_truth::brute_force;
using distance_truth::corners_of;
using Eigen::Vector3d;
using shapes::Generator;
using shapes::uniform;

/// Rounding of the transformed corners of B and of the closed forms below, relative.
constexpr double k_pose_rounding = 1e-14;

/// Moves B along -u from far until its distance is `target`: steps by the difference never pass it.
Pose approach(const Mesh& a, const Mesh& b, Pose pose, const Vector3d& u, double target) {
  const DistanceOracle oracle(a, b);
  DistanceQuery query(oracle);
  const double far = 1.1 * (a.diagonal() + b.diagonal()) + target;
  const Vector3d start = a.center() - pose.R * b.center();
  double translation = far;
  for (int i = 0; i < 300; ++i) {
    pose.t = start + translation * u;
    const double excess = query.distance(pose).distance - target;
    if (excess < 1e-9 * far) break;
    translation -= excess;
  }
  return pose;
}

void check_witnesses(const Mesh& a, const Mesh& b, const Pose& X_AB, const Separation& d) {
  const double offset = a.center().norm() + X_AB.t.norm() + b.center().norm();
  const double tolerance = 8.0 * k_triangle_distance_error * (a.diagonal() + b.diagonal() + d.distance + offset);
  EXPECT_LE(triangle_triangle_distance({d.witness_a, d.witness_a, d.witness_a}, corners_of(a, d.triangle_a)).distance,
            tolerance);
  EXPECT_LE(
      triangle_triangle_distance({d.witness_b, d.witness_b, d.witness_b}, corners_of(b, d.triangle_b, X_AB)).distance,
      tolerance);
  EXPECT_NEAR((d.witness_a - d.witness_b).norm(), d.distance, tolerance);
}

TEST(DistanceOracle, EqualsBruteForce) {
  Generator generator(1);
  std::vector<Mesh> meshes{shapes::bumpy_sphere(1, 0.3, 1.0, {0.2, 0.1, -0.3}), shapes::bumpy_sphere(1, 0.3, 0.6),
                           shapes::box({0.4, 0.9, 0.5}), shapes::soup(generator, 90, 1.0, 0.3)};
  // Inside out: the slabs' normals point inwards.
  meshes.push_back(bodies::inside_out(shapes::bumpy_sphere(2, 0.1, 1.4, {0.1, -0.3, 0.2})));
  int apart = 0;
  int meeting = 0;
  for (const Mesh& a : meshes) {
    for (const Mesh& b : meshes) {
      const DistanceOracle oracle(a, b);
      DistanceQuery query(oracle);
      for (int i = 0; i < 6; ++i) {
        const Pose pose = shapes::random_pose(generator, 0.4 + 0.6 * i);
        const Separation truth = brute_force(a, b, pose);
        const Separation d = query.distance(pose);
        ASSERT_TRUE(d.has_witnesses);
        EXPECT_EQ(d.distance, truth.distance);
        if (truth.distance > 0.0) {
          ++apart;
          EXPECT_EQ(d.triangle_a, truth.triangle_a);
          EXPECT_EQ(d.triangle_b, truth.triangle_b);
          EXPECT_EQ(d.witness_a, truth.witness_a);
          EXPECT_EQ(d.witness_b, truth.witness_b);
        } else {
          ++meeting;
        }
        check_witnesses(a, b, pose, d);
        const bool meet = truth.distance == 0.0;  // of solids that do not, one may lie inside the other
        if (meet || !a.solid() || !b.solid()) {
          EXPECT_EQ(query.collide(pose), meet);
        }
      }
    }
  }
  EXPECT_GT(apart, 20);
  EXPECT_GT(meeting, 20);
}

TEST(DistanceOracle, IsSymmetric) {
  Generator generator(2);
  const Mesh a = shapes::bumpy_sphere(4, 0.2);
  const Mesh b = shapes::bumpy_sphere(3, 0.4, 0.5, {0.4, -0.2, 0.1});
  const DistanceOracle forth(a, b);
  const DistanceOracle back(b, a);
  DistanceQuery query_forth(forth);
  DistanceQuery query_back(back);
  for (int i = 0; i < 30; ++i) {
    const Pose pose = shapes::random_pose(generator, 2.5);
    const Separation x = query_forth.distance(pose);
    const Separation y = query_back.distance(pose.inverse());
    EXPECT_NEAR(x.distance, y.distance, k_pose_rounding * (a.diagonal() + pose.t.norm()));
    EXPECT_EQ(query_forth.collide(pose), query_back.collide(pose.inverse()));
  }
}

TEST(DistanceOracle, DistanceOfSpheresVertexToVertex) {
  // Polyhedra inscribed in spheres, a vertex of each on the line of the centres: the distance is that of the spheres.
  Generator generator(3);
  const double r = 0.8;
  const Mesh a = shapes::bumpy_sphere(4, 0.0, 1.0);
  const Mesh b = shapes::bumpy_sphere(3, 0.0, r);
  const DistanceOracle oracle(a, b);
  DistanceQuery query(oracle);
  for (int i = 0; i < 40; ++i) {
    const Vector3d va = a.vertices()[generator() % a.vertices().size()].normalized();
    const Vector3d vb = b.vertices()[generator() % b.vertices().size()].normalized();
    const Eigen::AngleAxisd spin(uniform(generator, 0.0, 6.0), va);
    Pose pose;
    pose.R = (spin * Eigen::Quaterniond::FromTwoVectors(vb, -va)).toRotationMatrix();
    const double gap = std::pow(10.0, uniform(generator, -12.0, 1.0));
    pose.t = (1.0 + r + gap) * va;
    EXPECT_NEAR(query.distance(pose).distance, gap, k_pose_rounding * (2.0 + gap));
    EXPECT_FALSE(query.collide(pose));
  }
}

TEST(DistanceOracle, BoxesAtAnyRotation) {
  Generator generator(4);
  const Vector3d half_a(1.3, 0.9, 0.7);
  const Vector3d half_b(0.3, 0.5, 0.2);
  const Mesh a = shapes::box(half_a);
  const Mesh b = shapes::box(half_b);
  const DistanceOracle oracle(a, b);
  DistanceQuery query(oracle);
  for (int i = 0; i < 60; ++i) {
    const double gap = std::pow(10.0, uniform(generator, -12.0, 1.0));
    // Vertex over face: B's lower vertex above the middle of A's upper face.
    Pose pose = shapes::random_pose(generator, 0.2);
    pose.t.z() = half_a.z() + gap + (pose.R.row(2).cwiseAbs() * half_b).value();
    EXPECT_NEAR(query.distance(pose).distance, gap, k_pose_rounding * (2.0 + gap));
    EXPECT_FALSE(query.collide(pose));

    // Edge over edge: A's edge along x (y = +, z = +), B's edge along its own x rotated by a small or large angle.
    const double angle = std::pow(10.0, uniform(generator, -15.0, 0.0));
    const Eigen::AngleAxisd tilt(0.785 + uniform(generator, -0.2, 0.2), Vector3d::UnitX());
    const Vector3d up = Vector3d(0.0, 1.0, 1.0).normalized();
    const Eigen::Matrix3d R = (Eigen::AngleAxisd(angle, up) * tilt).toRotationMatrix();
    // The middle of B's edge that is least along `up`; it is moved over a point of A's edge.
    Vector3d low = Vector3d::Zero();
    double least_along = 0.0;
    for (const double y : {-half_b.y(), half_b.y()}) {
      for (const double z : {-half_b.z(), half_b.z()}) {
        const Vector3d middle = R * Vector3d(0.0, y, z);
        if (middle.dot(up) < least_along) {
          least_along = middle.dot(up);
          low = middle;
        }
      }
    }
    Pose over{R, Vector3d(uniform(generator, -0.5, 0.5), half_a.y(), half_a.z()) + gap * up - low};
    EXPECT_NEAR(query.distance(over).distance, gap, k_pose_rounding * (2.0 + gap)) << "angle " << angle;
  }
}

TEST(DistanceOracle, ErrorGrowsWithTheOffsetOnlyAsCoordinatesRound) {
  // The same configuration at scale s, both meshes and the pose shifted by offset * s: a moved corner rounds by a few
  // units in the last place of the offset.
  constexpr double k_offset_rounding = 2e-15;
  Generator generator(5);
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const double offset : {0.0, 1e3, 1e6}) {
      const Vector3d at_a = offset * scale * Vector3d(0.6, -0.5, 0.7);
      const Vector3d at_b = offset * scale * Vector3d(-0.4, 0.8, 0.3);
      const Mesh a = shapes::bumpy_sphere(1, 0.2, scale, at_a);
      const Mesh b = shapes::bumpy_sphere(1, 0.3, 0.7 * scale, at_b);
      const DistanceOracle oracle(a, b);
      DistanceQuery query(oracle);
      for (int i = 0; i < 4; ++i) {
        Pose pose = shapes::random_pose(generator, 0.0);
        pose.t = at_a - pose.R * at_b + scale * (i == 3 ? 40.0 : 1.9) * shapes::unit_vector(generator);
        // Truth without the offset: subtract it from the vertices first, where the mesh's rounding is the same.
        const Mesh a0 = shapes::moved(a, {Eigen::Matrix3d::Identity(), -at_a});
        const Mesh b0 = shapes::moved(b, {Eigen::Matrix3d::Identity(), -at_b});
        const Pose pose0{pose.R, pose.t - at_a + pose.R * at_b};
        const Separation truth = brute_force(a0, b0, pose0);
        const Separation d = query.distance(pose);
        EXPECT_NEAR(d.distance, truth.distance, k_offset_rounding * scale * (10.0 + offset + pose0.t.norm() / scale));
        check_witnesses(a, b, pose, d);
      }
    }
  }
}

TEST(DistanceOracle, PrunesBodiesFarApart) {
  const Mesh a = shapes::bumpy_sphere(4, 0.2);
  const DistanceOracle oracle(a, a);
  DistanceQuery query(oracle);
  Generator generator(6);
  for (const double far : {1e2, 1e4, 1e6}) {
    Pose pose = shapes::random_pose(generator, 0.0);
    pose.t = far * shapes::unit_vector(generator);
    const Separation d = query.distance(pose);
    EXPECT_NEAR(d.distance, far, k_reach_of_both);
    // Of 26 million pairs. Leaves are compared in floats, which prune less as the distance grows.
    EXPECT_LT(query.counts().triangles, 30000u) << "far " << far;
    EXPECT_LT(query.counts().nodes, 30000u) << "far " << far;
  }
}

TEST(DistanceOracle, WarmAndColdAndThreadsAgreeInEveryBit) {
  const Mesh a = shapes::bumpy_sphere(4, 0.25);
  const Mesh b = shapes::bumpy_sphere(3, 0.25, 0.4);
  const DistanceOracle oracle(a, b);
  Generator generator(7);
  std::vector<Pose> path;
  Pose pose = shapes::random_pose(generator, 0.0);
  for (int i = 0; i < 120; ++i) {
    pose.R = Eigen::AngleAxisd(0.05, shapes::unit_vector(generator)).toRotationMatrix() * pose.R;
    pose.t = (1.9 + 0.5 * std::sin(0.1 * i)) * Vector3d(std::cos(0.05 * i), std::sin(0.05 * i), 0.3).normalized();
    path.push_back(pose);
  }
  const auto run = [&](bool warm) {
    DistanceQuery query(oracle);
    std::vector<Separation> all;
    for (const Pose& p : path) all.push_back(query.distance(p, warm));
    return all;
  };
  const std::vector<Separation> cold = run(false);
  std::vector<Separation> warm;
  std::vector<Separation> other;
  std::thread first([&] { warm = run(true); });
  std::thread second([&] { other = run(true); });
  first.join();
  second.join();
  for (const std::vector<Separation>* answers : {&warm, &other}) {
    for (std::size_t i = 0; i < path.size(); ++i) {
      const Separation& x = (*answers)[i];
      EXPECT_EQ(x.distance, cold[i].distance);
      if (x.distance == 0.0) continue;
      EXPECT_EQ(x.witness_a, cold[i].witness_a);
      EXPECT_EQ(x.witness_b, cold[i].witness_b);
      EXPECT_EQ(x.triangle_a, cold[i].triangle_a);
      EXPECT_EQ(x.triangle_b, cold[i].triangle_b);
    }
  }
}

TEST(DistanceOracle, IsTheSameBitsOnEveryInstructionSet) {
  const Mesh a = shapes::bumpy_sphere(4, 0.25);
  const Mesh b = shapes::bumpy_sphere(3, 0.3, 0.5);
  const DistanceOracle oracle(a, b);
  const auto run = [&] {
    Generator generator(8);
    DistanceQuery query(oracle);
    std::vector<Separation> all;
    for (int i = 0; i < 40; ++i) {
      all.push_back(query.distance(shapes::random_pose(generator, 2.0), false));
    }
    return all;
  };
  const std::vector<Separation> standard = run();
  const int sets = for_each_instruction_set([&] {
    const std::vector<Separation> here = run();
    for (std::size_t i = 0; i < here.size(); ++i) {
      EXPECT_EQ(here[i].distance, standard[i].distance);
      if (here[i].distance == 0.0) continue;
      EXPECT_EQ(here[i].witness_a, standard[i].witness_a);
      EXPECT_EQ(here[i].triangle_b, standard[i].triangle_b);
    }
  });
  EXPECT_GE(sets, 2);  // at least a SIMD and a scalar path
}

TEST(DistanceOracle, WarmStartsAreMeasuredBeforeTheyCount) {
  // One triangle each: the pair of the last answer is the only one; its distance has changed.
  Generator generator(27);
  for (int i = 0; i < 20; ++i) {
    const Mesh a = shapes::soup(generator, 1, 0.5, 0.4);
    const Mesh b = shapes::soup(generator, 1, 0.5, 0.4);
    const DistanceOracle oracle(a, b);
    const Eigen::Matrix3d R = shapes::random_pose(generator, 0.0).R;
    const Vector3d line = shapes::unit_vector(generator);
    const Pose near{R, 3.0 * line};
    const Pose far{R, 9.0 * line};
    DistanceQuery query(oracle);
    const double near_distance = query.distance(near).distance;
    ASSERT_EQ(near_distance, brute_force(a, b, near).distance);
    EXPECT_EQ(query.distance(far).distance, brute_force(a, b, far).distance);
    EXPECT_EQ(query.distance(near).distance, near_distance);
  }
}

TEST(DistanceOracle, WarmStartsFromTheClosestTrianglesOrOthersGiveTheSameAnswer) {
  // Steps towards each other and apart keep the closest triangles; jumps do not.
  const Mesh a = shapes::bumpy_sphere(3, 0.25);
  const Mesh b = shapes::bumpy_sphere(2, 0.3, 0.6);
  const DistanceOracle oracle(a, b);
  DistanceQuery cold(oracle);
  Generator generator(28);
  int kept = 0;
  for (int i = 0; i < 30; ++i) {
    const Pose before{shapes::random_pose(generator, 0.0).R, 2.6 * shapes::unit_vector(generator)};
    const Separation last = cold.distance(before, false);
    ASSERT_GT(last.distance, 0.1);
    Pose step = before;
    step.t += (i % 2 == 0 ? 0.01 : -0.01) * (last.witness_b - last.witness_a).normalized();
    const Pose jump{shapes::random_pose(generator, 0.0).R, 3.0 * shapes::unit_vector(generator)};
    for (const Pose& pose : {step, jump}) {
      const Separation truth = cold.distance(pose, false);
      kept += truth.triangle_a == last.triangle_a && truth.triangle_b == last.triangle_b;
      DistanceQuery query(oracle);
      query.distance(before);
      const Separation warm = query.distance(pose);
      ASSERT_TRUE(warm.has_witnesses);
      EXPECT_EQ(warm.distance, truth.distance);
      EXPECT_EQ(warm.triangle_a, truth.triangle_a);
      EXPECT_EQ(warm.triangle_b, truth.triangle_b);
      EXPECT_EQ(warm.witness_a, truth.witness_a);
      EXPECT_EQ(warm.witness_b, truth.witness_b);
    }
  }
  EXPECT_GT(kept, 15);
}

TEST(DistanceOracle, CloseApproachesAreSeenOnBothSides) {
  // B at a small distance, then moved along the witnesses' line by a little more and a little less than the gap.
  const Mesh a = shapes::bumpy_sphere(4, 0.2);
  const Mesh b = shapes::bumpy_sphere(3, 0.2, 0.5);
  const DistanceOracle oracle(a, b);
  DistanceQuery query(oracle);
  Generator generator(10);
  for (int i = 0; i < 10; ++i) {
    const Pose pose = approach(a, b, shapes::random_pose(generator, 0.0), shapes::unit_vector(generator), 1e-4);
    const Separation d = query.distance(pose);
    ASSERT_GT(d.distance, 0.0);
    const Vector3d line = (d.witness_a - d.witness_b) / d.distance;
    Pose short_of = pose;
    short_of.t += d.distance * (1.0 - 1e-9) * line;
    EXPECT_NEAR(query.distance(short_of).distance, 1e-9 * d.distance, k_pose_rounding);
    EXPECT_FALSE(query.collide(short_of));
    Pose beyond = pose;
    beyond.t += d.distance * (1.0 + 1e-9) * line;
    EXPECT_EQ(query.distance(beyond).distance, 0.0);
    EXPECT_TRUE(query.collide(beyond));
  }
}

TEST(DistanceOracle, TouchingIsIntersecting) {
  const Mesh a = shapes::box({1.0, 1.0, 1.0});
  const DistanceOracle oracle(a, a);
  DistanceQuery query(oracle);
  // Exact in doubles: face on face, edge on edge, corner on corner, shifted faces; then one unit in the last place off.
  for (const Vector3d& t : {Vector3d(2.0, 0.0, 0.0), Vector3d(2.0, 2.0, 0.25), Vector3d(2.0, 2.0, 2.0),
                            Vector3d(0.375, -0.125, 2.0), Vector3d(0.0, 0.0, 0.0)}) {
    Pose pose;
    pose.t = t;
    EXPECT_TRUE(query.collide(pose));
    EXPECT_TRUE(query.collide(pose, false));
    EXPECT_EQ(query.distance(pose).distance, 0.0);
    if (t.norm() == 0.0) continue;
    Eigen::Index axis = 0;
    t.maxCoeff(&axis);
    pose.t[axis] = std::nextafter(2.0, 3.0);
    EXPECT_FALSE(query.collide(pose, false));
    EXPECT_FALSE(query.collide(pose));
    EXPECT_GT(query.distance(pose).distance, 0.0);
  }
}

TEST(DistanceOracle, ContainmentIsCollision) {
  Generator generator(11);
  const Mesh big = shapes::bumpy_sphere(3, 0.2, 1.0, {0.5, 0.2, -0.1});
  const Mesh small = shapes::bumpy_sphere(2, 0.2, 0.2, {-3.0, 0.4, 1.0});
  const Mesh open = Mesh::build(big.vertices(), {big.triangles().begin() + 1, big.triangles().end()});
  const Mesh hollow = bodies::together(big, bodies::inside_out(shapes::bumpy_sphere(3, 0.2, 0.6, {0.5, 0.2, -0.1})));
  const Mesh two =
      bodies::together(small, shapes::moved(small, {Eigen::Matrix3d::Identity(), Vector3d(5.0, 0.0, 0.0)}));
  ASSERT_TRUE(hollow.solid());
  ASSERT_FALSE(open.solid());
  for (int i = 0; i < 20; ++i) {
    Pose inside = shapes::random_pose(generator, 0.0);
    inside.t = big.center() - inside.R * small.center() + shapes::uniform_vector(generator, 0.1);
    const auto collide = [&](const Mesh& a, const Mesh& b, const Pose& pose) {
      const DistanceOracle oracle(a, b);
      DistanceQuery query(oracle);
      EXPECT_GT(query.distance(pose).distance, 0.0);
      return query.collide(pose);
    };
    EXPECT_TRUE(collide(big, small, inside));
    EXPECT_TRUE(collide(small, big, inside.inverse()));
    EXPECT_FALSE(collide(open, small, inside));
    EXPECT_FALSE(collide(hollow, small, inside));
    EXPECT_FALSE(collide(small, hollow, inside.inverse()));
    EXPECT_TRUE(collide(big, two, inside));  // the first piece inside, the second far away
    EXPECT_TRUE(collide(two, big, inside.inverse()));
    Pose second = inside;  // the other piece
    second.t -= inside.R * Vector3d(5.0, 0.0, 0.0);
    EXPECT_TRUE(collide(big, two, second));
    EXPECT_TRUE(collide(two, big, second.inverse()));
    Pose outside = inside;
    outside.t += 4.0 * shapes::unit_vector(generator);
    EXPECT_FALSE(collide(big, small, outside));
  }
}

}  // namespace
}  // namespace sixdof
