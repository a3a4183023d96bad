#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/models/recipe.h>
#include <sixdof/oracle/distance.h>

#include "../geometry/shapes.h"
#include "distance_truth.h"
#include "instruction_sets.h"

// Coplanar patches that face each other: thousands of pairs of triangles tie.

namespace sixdof {
namespace {

using distance_truth::brute_force;
using Eigen::Vector3d;
using shapes::Generator;
using shapes::uniform;

Mesh shuffled(const Mesh& mesh, Generator& generator) {
  std::vector<Triangle> t = mesh.triangles();
  for (std::size_t i = t.size(); i > 1; --i) std::swap(t[i - 1], t[generator() % i]);
  return Mesh::build(mesh.vertices(), t);
}

/// The answers have the same bits.
void expect_same(const Separation& answer, const Separation& truth) {
  ASSERT_TRUE(answer.has_witnesses);
  EXPECT_EQ(answer.distance, truth.distance);
  EXPECT_EQ(answer.triangle_a, truth.triangle_a);
  EXPECT_EQ(answer.triangle_b, truth.triangle_b);
  EXPECT_EQ(answer.witness_a, truth.witness_a);
  EXPECT_EQ(answer.witness_b, truth.witness_b);
}

/// A pose at which face `b_down` of B (its unit normal in B's frame) is parallel to face `a_up` of A at distance `gap`,
/// rotated at random about the normal; `over` is the middle of A's face, `under` that of B's.
Pose face_to_face(Generator& generator, const Vector3d& a_up, const Vector3d& over, const Vector3d& b_down,
                  const Vector3d& under, double gap) {
  Pose pose;
  pose.R = (Eigen::AngleAxisd(uniform(generator, 0.0, 6.0), a_up) * Eigen::Quaterniond::FromTwoVectors(b_down, -a_up))
               .toRotationMatrix();
  pose.t = over + gap * a_up - pose.R * under;
  return pose;
}

/// A block at a random pose in its frame, with the normal and the middle of one face.
struct Block {
  Mesh mesh;
  Vector3d normal;
  Vector3d middle;

  static Block make(Generator& generator, const Vector3d& size, std::size_t triangles, double offset) {
    const Pose pose = shapes::random_pose(generator, offset);
    const Mesh straight = make_box({size}, triangles);
    return {shuffled(shapes::moved(straight, pose), generator), pose.R.col(2),
            pose * (straight.center() + Vector3d(0.0, 0.0, 0.5 * size.z()))};
  }
};

TEST(DistanceTies, CubesOnAGridTieInEveryBit) {
  // Cubes of 2 x 2 x 2 with corners on a grid of powers of two, face to face: every pair of the two faces' triangles
  // that overlap is equally far in every bit.
  Generator generator(20);
  const Mesh cube = make_box({Vector3d(2.0, 2.0, 2.0)}, 192);  // faces of 4 x 4 squares
  for (int i = 0; i < 12; ++i) {
    const Mesh a = shuffled(cube, generator);
    const Mesh b = shuffled(cube, generator);
    const DistanceOracle oracle(a, b);
    DistanceQuery query(oracle);
    Pose pose;
    pose.t = Vector3d(0.625, -0.375, 2.25);
    if (i % 2 == 1) pose.R << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
    const Separation truth = brute_force(a, b, pose);
    ASSERT_EQ(truth.distance, 0.25);
    for (const bool warm : {false, true}) expect_same(query.distance(pose, warm), truth);
  }
}

TEST(DistanceTies, BlocksFaceToFaceAnywhere) {
  Generator generator(23);
  int tied = 0;
  for (int i = 0; i < 24; ++i) {
    // The frame's origin is at the block, or a few sizes away.
    const double offset = i % 3 == 0 ? 5.0 : 0.3;
    const Block a = Block::make(generator, {1.7, 1.3, 0.9}, 400, offset);
    const Block b = Block::make(generator, {0.8, 1.1, 0.6}, 300, offset);
    const DistanceOracle oracle(a.mesh, b.mesh);
    DistanceQuery query(oracle);
    const double gap = std::pow(10.0, uniform(generator, -11.0, 0.3));
    Pose pose = face_to_face(generator, a.normal, a.middle, b.normal, b.middle, gap);
    const Vector3d aside = a.normal.cross(shapes::unit_vector(generator));
    pose.t += 0.4 * aside;
    const double width = oracle.tie_width(pose);
    ASSERT_GT(width, 0.0);
    const double sizes = a.mesh.diagonal() + b.mesh.diagonal() + gap + a.mesh.center().norm() + pose.t.norm();
    EXPECT_LT(width, 3e-14 * (sizes + b.mesh.center().norm()));  // far below the 1e-13 asked of distances
    const Separation truth = brute_force(a.mesh, b.mesh, pose, width);
    EXPECT_NEAR(truth.distance, gap, width);
    tied += brute_force(a.mesh, b.mesh, pose).distance < truth.distance;
    expect_same(query.distance(pose, false), truth);
    expect_same(query.distance(pose), truth);
    Pose before = pose;  // another part of the plane, another pair to begin with
    before.t += 0.2 * aside;
    query.distance(before);
    expect_same(query.distance(pose), truth);
    EXPECT_FALSE(query.collide(pose));

    const DistanceOracle swapped(b.mesh, a.mesh);
    expect_same(DistanceQuery(swapped).distance(pose.inverse()),
                brute_force(b.mesh, a.mesh, pose.inverse(), swapped.tie_width(pose.inverse())));
  }
  EXPECT_GT(tied, 3);  // the rule was needed: the first of the ties is not the smallest in every bit
}

TEST(DistanceTies, AreTheSameBitsOnEveryInstructionSet) {
  Generator generator(24);
  for (int i = 0; i < 4; ++i) {
    const Block a = Block::make(generator, {1.7, 1.3, 0.9}, 1200, 0.5);
    const Block b = Block::make(generator, {0.8, 1.1, 0.6}, 1500, 0.5);
    const DistanceOracle oracle(a.mesh, b.mesh);
    const Pose pose = face_to_face(generator, a.normal, a.middle, b.normal, b.middle, i == 0 ? 1e-9 : 0.1);
    const Separation standard = DistanceQuery(oracle).distance(pose);
    for_each_instruction_set([&] { expect_same(DistanceQuery(oracle).distance(pose), standard); });
  }
}

/// Adds a square of side `side`, cut in n x n squares of two triangles each.
void add_square(std::vector<Vector3d>& v, std::vector<Triangle>& t, const Vector3d& corner, double side,
                std::uint32_t n) {
  const auto first = static_cast<std::uint32_t>(v.size());
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) v.push_back(corner + side / n * Vector3d(i, j, 0.0));
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t k = first + i * (n + 1) + j;
      t.push_back({k, k + n + 1, k + 1});
      t.push_back({k + 1, k + n + 1, k + n + 2});
    }
  }
}

TEST(DistanceTies, DistancesAtTheLimitOfATieAreDistinguished) {
  // Small plates over a large one, at distances in steps of a tenth of the tie width: bounds cannot decide which of
  // them tie.
  Generator generator(25);
  constexpr std::uint32_t k_plates = 8;  // in a row; squared
  for (int i = 0; i < 40; ++i) {
    std::vector<Vector3d> v;
    std::vector<Triangle> t;
    add_square(v, t, {-1.0, -1.0, 0.0}, 2.0, 6);
    const Pose rotation = shapes::random_pose(generator, 0.0);
    const Mesh ground = shuffled(shapes::moved(Mesh::build(v, t), rotation), generator);
    v.clear();
    t.clear();
    const double gap = i % 2 == 0 ? 0.37 : 3e-7;
    const double step = 1e-14;  // about a third of the width
    for (std::uint32_t x = 0; x < k_plates; ++x) {
      for (std::uint32_t y = 0; y < k_plates; ++y) {
        const double z = gap + 0.3 * step * static_cast<double>(generator() % 40);
        add_square(v, t, {0.2 * x - 0.8, 0.2 * y - 0.8, z}, 0.15, 1);
      }
    }
    add_square(v, t, {-0.8, -0.8, 1.4}, 1.6, 5);  // a large patch: without one ties do not count
    const Mesh plates = shuffled(shapes::moved(Mesh::build(v, t), rotation), generator);

    const DistanceOracle oracle(ground, plates);
    DistanceQuery query(oracle);
    Pose pose;  // a little beside where the plates were made
    pose.t = 0.01 * rotation.R.col(0);
    const double width = oracle.tie_width(pose);
    const Separation truth = brute_force(ground, plates, pose, width);
    ASSERT_NEAR(truth.distance, gap, 13.0 * step);
    expect_same(query.distance(pose, false), truth);
    for (int k = 0; k < 5; ++k) {
      Pose before = pose;
      before.t += 0.1 * rotation.R * Vector3d(uniform(generator, -1.0, 1.0), uniform(generator, -1.0, 1.0), 0.1);
      query.distance(before);
      expect_same(query.distance(pose), truth);
    }
    const DistanceOracle swapped(plates, ground);
    const Pose back = pose.inverse();
    expect_same(DistanceQuery(swapped).distance(back), brute_force(plates, ground, back, swapped.tie_width(back)));
  }
}

TEST(DistanceTies, SmallestRankInPrunedPatches) {
  // A fine plate over a fine one, and over eight large triangles that come last in their mesh: whole volumes are pruned
  // as ties, and the pair of smallest rank in them is resolved at the end. Over a large triangle the index in the fine
  // plate decides.
  Generator generator(30);
  constexpr std::uint32_t k_fine = 16;  // squares along a side
  const auto fine = [&](const Pose& frame) {
    std::vector<Vector3d> v;
    std::vector<Triangle> t;
    add_square(v, t, {-1.0, -1.0, 0.0}, 2.0, k_fine);
    return shuffled(shapes::moved(Mesh::build(v, t), frame), generator);
  };
  const auto large = [&](const Pose& frame) {
    std::vector<Vector3d> v;
    std::vector<Triangle> t;
    add_square(v, t, {-1.0, -1.0, -3.0}, 2.0, k_fine);  // below, out of reach
    add_square(v, t, {-1.0, -1.0, 0.0}, 2.0, 2);
    return shapes::moved(Mesh::build(v, t), frame);
  };
  const auto check = [](const Mesh& a, const Mesh& b, const Pose& pose, const Pose& before) {
    const DistanceOracle oracle(a, b);
    const Separation truth = brute_force(a, b, pose, oracle.tie_width(pose));
    ASSERT_GT(truth.distance, 0.0);
    DistanceQuery query(oracle);
    expect_same(query.distance(pose, false), truth);
    for (int i = 0; i < 4; ++i) {  // warm, from other pairs of the plates
      Pose aside = before;
      aside.t += 0.1 * i * (before.t - pose.t);
      query.distance(aside);
      expect_same(query.distance(pose), truth);
    }
  };
  for (int i = 0; i < 6; ++i) {
    const Pose frame_a = shapes::random_pose(generator, 0.5);
    const Pose frame_b = shapes::random_pose(generator, 0.5);
    const Mesh a = i % 2 == 0 ? fine(frame_a) : large(frame_a);
    const Mesh b = fine(frame_b);
    Pose pose = face_to_face(generator, frame_a.R.col(2), frame_a.t, -frame_b.R.col(2), frame_b.t, 0.013);
    pose.t += 0.31 * frame_a.R.col(0) - 0.23 * frame_a.R.col(1);
    Pose before = pose;
    before.t += 0.4 * frame_a.R * Vector3d(-1.0, 0.8, 0.1);
    check(a, b, pose, before);
    check(b, a, pose.inverse(), before.inverse());
  }
}

TEST(DistanceTies, FacesThatTouchUpToRounding) {
  // Gaps near rounding: the distance is 0 if and only if two triangles intersect, whatever the ties.
  Generator generator(26);
  int apart = 0;
  int meeting = 0;
  for (int i = 0; i < 50; ++i) {
    const Block a = Block::make(generator, {1.7, 1.3, 0.9}, 150, 0.4);
    const Block b = Block::make(generator, {0.8, 1.1, 0.6}, 150, 0.4);
    const DistanceOracle oracle(a.mesh, b.mesh);
    DistanceQuery query(oracle);
    const double gap = std::pow(10.0, uniform(generator, -17.0, -13.0));
    const Pose pose = face_to_face(generator, a.normal, a.middle, b.normal, b.middle, gap);
    const Separation smallest = brute_force(a.mesh, b.mesh, pose);
    EXPECT_EQ(query.collide(pose, false), smallest.distance == 0.0);
    if (smallest.distance == 0.0) {
      ++meeting;
      EXPECT_EQ(query.distance(pose, false).distance, 0.0);
    } else {
      ++apart;
      expect_same(query.distance(pose, false), brute_force(a.mesh, b.mesh, pose, oracle.tie_width(pose)));
    }
  }
  EXPECT_GT(apart, 5);
  EXPECT_GT(meeting, 5);
}

TEST(DistanceTies, CostLittle) {
  // Faces with thousands of ties are pruned whole, then expanded along one path to the triangles of smallest rank.
  constexpr double k_pairs_per_triangle = 0.1;
  constexpr double k_volumes_per_triangle = 0.5;
  const auto check = [](const Mesh& mesh) {
    const DistanceOracle oracle(mesh, mesh);
    DistanceQuery query(oracle);
    const auto triangles = static_cast<double>(mesh.triangles().size());
    const double size_z = mesh.box().sizes().z();
    const auto check_counts = [&] {
      EXPECT_LT(static_cast<double>(query.counts().triangles), k_pairs_per_triangle * triangles);
      EXPECT_LT(static_cast<double>(query.counts().nodes), k_volumes_per_triangle * triangles);
      EXPECT_LT(static_cast<double>(query.counts().leaf_pairs), k_volumes_per_triangle * triangles);
    };
    for (const double gap : {1e-6, 0.3}) {
      for (int quarter = 0; quarter < 4; ++quarter) {
        SCOPED_TRACE(testing::Message() << mesh.name() << " gap " << gap << " quarter " << quarter);
        const Eigen::AngleAxisd rotation(1.5707963267948966 * quarter, Vector3d::UnitZ());
        const Pose pose{rotation.toRotationMatrix(), {0.0137, -0.0211, size_z + gap}};
        EXPECT_NEAR(query.distance(pose, false).distance, gap, oracle.tie_width(pose));
        check_counts();
        EXPECT_FALSE(query.collide(pose, false));
        check_counts();
      }
    }
  };
  check(make_box({}, 2500));
  check(make_box({}, 10000));
  check(make_circular_box({}, 10000));
}

TEST(DistanceTies, AreResolvedInTheOrderOfRanks) {
  // Triangles in random order: of the thousands of pairs that tie, those with the smallest rank are expanded first. In
  // any other order the same answer would take hundreds of pairs.
  constexpr double k_pairs_per_query = 40.0;
  Generator generator(31);
  double pairs = 0.0;
  int queries = 0;
  for (int i = 0; i < 6; ++i) {
    const Block a = Block::make(generator, {1.7, 1.3, 0.9}, 6000, 0.4);
    const Block b = Block::make(generator, {0.8, 1.1, 0.6}, 5000, 0.4);
    const Pose pose = face_to_face(generator, a.normal, a.middle, b.normal, b.middle, i % 2 == 0 ? 1e-6 : 0.3);
    const auto count = [&](const Mesh& first, const Mesh& second, const Pose& at) {
      const DistanceOracle oracle(first, second);
      DistanceQuery query(oracle);
      query.distance(at, false);
      pairs += static_cast<double>(query.counts().triangles);
      ++queries;
    };
    count(a.mesh, b.mesh, pose);
    count(b.mesh, a.mesh, pose.inverse());
  }
  EXPECT_LT(pairs / queries, k_pairs_per_query);
}

}  // namespace
}  // namespace sixdof
