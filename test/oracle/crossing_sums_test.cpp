#include <sixdof/oracle/crossing_sums.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/crossing.h>

#include "../geometry/shapes.h"
#include "bodies.h"
#include "instruction_sets.h"

namespace sixdof {
namespace {

using bodies::Body;
using detail::CrossingSums;
using Eigen::Vector3d;

std::vector<TrianglePair> all_pairs(const Body& a, const Body& b) {
  std::vector<TrianglePair> pairs;
  for (std::uint32_t i = 0; i < a.tree.corners().size(); ++i) {
    for (std::uint32_t j = 0; j < b.tree.corners().size(); ++j) pairs.push_back({i, j});
  }
  return pairs;
}

/// The segment of one pair, by cross().
std::optional<Segment> segment_of(const Body& a, const Body& b, const Pose& X_AB, TrianglePair pair) {
  TriangleCorners of_b = b.tree.corners()[pair.b];
  for (Vector3d& p : of_b) p = transform_point(X_AB, p);
  return cross(a.tree.corners()[pair.a], of_b);
}

CrossingSums sums_of(const Body& a, const Body& b, const Pose& X_AB, std::span<const TrianglePair> pairs) {
  return detail::sum_crossings(a.solid, b.solid, X_AB, a.mesh.center(), pairs);
}

/// Which pairs cross, and where, is what cross() says of each. Returns the number of segments.
std::size_t expect_segments_of_cross(const Body& a, const Body& b, const Pose& X_AB) {
  const std::vector<TrianglePair> pairs = all_pairs(a, b);
  std::size_t count = 0;
  Vector3d anchor = Vector3d::Zero(), area = Vector3d::Zero(), moment = Vector3d::Zero();
  double size = 0.0;
  for (const TrianglePair& pair : pairs) {
    const std::optional<Segment> segment = segment_of(a, b, X_AB, pair);
    if (!segment) continue;
    if (count++ == 0) anchor = segment->start;
    EXPECT_EQ(sums_of(a, b, X_AB, {&pair, 1}).anchor, segment->start);
    const Vector3d u = segment->start - anchor, v = segment->end - anchor;
    area += u.cross(v);
    moment += (u.squaredNorm() + u.dot(v) + v.squaredNorm()) * (v - u);
    size = std::max({size, u.norm(), v.norm()});
  }
  const CrossingSums sums = sums_of(a, b, X_AB, pairs);
  EXPECT_EQ(sums.crossings, count);
  EXPECT_EQ(sums.anchor, anchor);
  // A few units in the last place of each term, a product of two lengths, or a sum of three products of three.
  const double rounding = 1e-15 * static_cast<double>(count + 1);
  EXPECT_LE((sums.area - area).norm(), rounding * size * size);
  EXPECT_LE((sums.moment - moment).norm(), 10.0 * rounding * size * size * size);
  return count;
}

Mesh tetrahedron(const std::vector<Vector3d>& p) {
  std::vector<Triangle> t{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  if ((p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]) > 0.0) {
    for (Triangle& x : t) std::swap(x[1], x[2]);
  }
  return Mesh::build(p, t, "tetrahedron");
}

/// Corners on a small lattice: faces, edges and corners coincide.
std::optional<Mesh> lattice_tetrahedron(std::mt19937_64& random) {
  std::uniform_int_distribution<int> digit(0, 3);
  std::vector<Vector3d> p;
  for (int i = 0; i < 4; ++i) p.emplace_back(digit(random), digit(random), digit(random));
  if ((p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]) == 0.0) return std::nullopt;
  return tetrahedron(p);
}

void expect_ties_of_cross() {
  std::mt19937_64 random(31);
  std::size_t segments = 0;
  const Pose identity{Eigen::Matrix3d::Identity(), Vector3d::Zero()};
  for (int i = 0; i < 400; ++i) {
    const std::optional<Mesh> a = lattice_tetrahedron(random), b = lattice_tetrahedron(random);
    if (a && b) segments += expect_segments_of_cross(Body(*a), Body(*b), identity);
  }
  EXPECT_GT(segments, 500u);
}

TEST(CrossingSums, TiesAreDecidedAsPairByPairOnEveryInstructionSet) { for_each_instruction_set(expect_ties_of_cross); }

/// Edges that the plane z = 0 bisects, where both of their ends are as near; and a face whose corners are rounded to
/// x = 0, as they lie below the range of the exact predicates.
void expect_special_points_of_cross() {
  std::mt19937_64 random(34);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const Body plane(tetrahedron({{-9.0, -9.0, 0.0}, {9.0, -9.0, 0.0}, {0.0, 9.0, 0.0}, {0.0, 0.0, 9.0}}));
  std::size_t segments = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<Vector3d> p;
    for (int k = 0; k < 4; ++k) p.emplace_back(u(random), u(random), k % 2 == 0 ? 0.7 : -0.7);
    const Body bisected(tetrahedron(p));
    segments += expect_segments_of_cross(bisected, plane, {Eigen::Matrix3d::Identity(), Vector3d::Zero()});
    segments += expect_segments_of_cross(plane, bisected, {Eigen::Matrix3d::Identity(), Vector3d::Zero()});
  }
  const double tiny = k_smallest_exact_coordinate;
  const Body face(
      tetrahedron({{1.5 * tiny, -0.5, -0.5}, {1.5 * tiny, 0.5, -0.5}, {1.5 * tiny, 0.0, 0.5}, {0.5, 0.0, 0.0}}));
  const Body across(tetrahedron({{-0.3, 0.0, -0.2}, {-0.2, 0.9, -0.3}, {-0.4, 0.5, 0.5}, {0.6, 0.5, 0.05}}));
  const Pose X_AB{Eigen::Matrix3d::Identity(), Vector3d(-tiny, 0.0, 0.0)};
  segments += expect_segments_of_cross(across, face, X_AB);
  bool is_rounded = false;
  for (const TrianglePair& pair : all_pairs(across, face)) {
    const std::optional<Segment> segment = segment_of(across, face, X_AB, pair);
    is_rounded = is_rounded || (segment && segment->start.x() == 0.0);
  }
  EXPECT_TRUE(is_rounded);
  EXPECT_GT(segments, 500u);
}

TEST(CrossingSums, PointsAreThoseOfOnePairOnEveryInstructionSet) {
  for_each_instruction_set(expect_special_points_of_cross);
}

void expect_generic_pairs_of_cross() {
  std::mt19937_64 random(32);
  const Body torus(bodies::bumpy_torus(13, 7)), rods(shapes::rod(9, 0.01));
  const Body large(bodies::bumpy_torus(9, 6, 0.1, 1e8)), small(bodies::bumpy_torus(9, 6, 0.1, 1e-8));
  std::size_t segments = 0;
  for (int i = 0; i < 10; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.4);
    segments += expect_segments_of_cross(torus, torus, X_AB);
    segments += expect_segments_of_cross(torus, rods, X_AB);
    // Nearly parallel: every plane is doubtful in floating point somewhere.
    const Pose turned{Eigen::AngleAxisd(1e-9 * i, X_AB.R.col(0)).toRotationMatrix(), 1e-12 * X_AB.t};
    segments += expect_segments_of_cross(rods, rods, turned);
    segments += expect_segments_of_cross(torus, torus, turned);
    // Of other sizes: a surface through a small body, and a translation that rounds.
    segments += expect_segments_of_cross(large, large, {X_AB.R, 1e8 * X_AB.t});
    segments += expect_segments_of_cross(small, small, {X_AB.R, 1e-8 * X_AB.t});
    segments += expect_segments_of_cross(large, small, {X_AB.R, large.mesh.vertices()[static_cast<std::size_t>(i)]});
  }
  EXPECT_GT(segments, 5000u);
}

TEST(CrossingSums, GenericPairsAreDecidedAsPairByPairOnEveryInstructionSet) {
  for_each_instruction_set(expect_generic_pairs_of_cross);
}

/// Determinants of all sizes from what floats decide to what doubles leave in doubt, and bodies so large or so small
/// that floats decide nothing.
void expect_pairs_of_all_sizes_of_cross() {
  std::mt19937_64 random(35);
  std::size_t segments = 0;
  for (const double size : {1.0, 3e-10, 1e-14, 1e14}) {
    const Body torus(bodies::bumpy_torus(11, 6, 0.1, size));
    for (int exponent = 1; exponent <= 12; ++exponent) {
      const double small = std::pow(10.0, -exponent);
      const Pose X_AB = bodies::random_pose(random, 0.4);
      const Pose near{Eigen::AngleAxisd(small, X_AB.R.col(0)).toRotationMatrix(), size * small * X_AB.t};
      segments += expect_segments_of_cross(torus, torus, near);
    }
  }
  EXPECT_GT(segments, 5000u);
}

TEST(CrossingSums, PairsOfAllSizesAreDecidedAsPairByPairOnEveryInstructionSet) {
  for_each_instruction_set(expect_pairs_of_all_sizes_of_cross);
}

TEST(CrossingSums, PairsThatDoNotCrossChangeNoBit) {
  std::mt19937_64 random(33);
  const Body a(bodies::bumpy_torus(31, 17)), b(bodies::bumpy_torus(23, 15, 0.2, 0.8));
  for (int i = 0; i < 12; ++i) {
    const Pose X_AB = bodies::random_pose(random, 0.4);
    std::vector<TrianglePair> crossing, found;
    CandidateScratch scratch;
    find_candidates(a.tree, b.tree, X_AB, scratch, found);
    for (const TrianglePair& pair : found) {
      if (segment_of(a, b, X_AB, pair)) crossing.push_back(pair);
    }
    std::vector<TrianglePair> more;
    std::uniform_int_distribution<std::uint32_t> of_a(0, 2 * 31 * 17 - 1), of_b(0, 2 * 23 * 15 - 1);
    for (const TrianglePair& pair : crossing) {
      for (std::uint64_t k = random() % 5; k > 0; --k) {
        const TrianglePair other{of_a(random), of_b(random)};
        if (!segment_of(a, b, X_AB, other)) more.push_back(other);
      }
      more.push_back(pair);
    }
    const CrossingSums alone = sums_of(a, b, X_AB, crossing);
    EXPECT_EQ(alone.crossings, crossing.size());
    for (const std::vector<TrianglePair>& pairs : {found, more}) {
      const CrossingSums sums = sums_of(a, b, X_AB, pairs);
      EXPECT_EQ(sums.crossings, alone.crossings);
      EXPECT_EQ(sums.area, alone.area);
      EXPECT_EQ(sums.moment, alone.moment);
      EXPECT_EQ(sums.beside_paths.volume, alone.beside_paths.volume);
      EXPECT_EQ(sums.beside_paths.first, alone.beside_paths.first);
      EXPECT_EQ(sums.path_a.area, alone.path_a.area);
      EXPECT_EQ(sums.path_b.first_order, alone.path_b.first_order);
    }
  }
}

TEST(CrossingSums, OfNoPairsAreZero) {
  const Body a(bodies::bumpy_torus(9, 6));
  const CrossingSums sums = sums_of(a, a, {Eigen::Matrix3d::Identity(), Vector3d(9.0, 0.0, 0.0)}, {});
  EXPECT_EQ(sums.crossings, 0u);
  EXPECT_EQ(sums.area, Vector3d::Zero());
  EXPECT_EQ(sums.beside_paths.volume, 0.0);
}

}  // namespace
}  // namespace sixdof
