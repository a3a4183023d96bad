#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/crossing.h>
#include <sixdof/oracle/overlap.h>
#include <sixdof/oracle/solid.h>

/// What find_swept_leaves() and find_swept_triangles() have to find, shared by tests.
namespace sixdof::swept {

inline Pose moved(const Pose& X_AB, const Eigen::Vector3d& by) { return {X_AB.R, X_AB.t + by}; }

/// Pairs of triangles that cross, as indices in tree order, of those in `pairs`.
inline std::vector<TrianglePair> crossings_among(const Tree& a, const Tree& b, const Pose& X_AB,
                                                 const std::vector<TrianglePair>& pairs) {
  std::vector<TrianglePair> crossing;
  for (const TrianglePair& pair : pairs) {
    TriangleCorners of_b = b.corners()[pair.b];
    for (Eigen::Vector3d& p : of_b) p = transform_point(X_AB, p);
    if (cross(a.corners()[pair.a], of_b)) crossing.push_back(pair);
  }
  return crossing;
}

/// The leaf of each triangle in tree order.
inline std::vector<std::uint32_t> leaves_of(const Tree& tree) {
  std::vector<std::uint32_t> leaves(tree.corners().size());
  for (std::uint32_t i = 0; i < tree.leaves().size(); ++i) {
    const Tree::Child leaf = tree.leaves()[i].child;
    for (std::uint32_t k = 0; k < leaf.count(); ++k) leaves[leaf.first() + k] = i;
  }
  return leaves;
}

/// Intervals of fractions of pairs, each of which comes once.
class Intervals {
 public:
  explicit Intervals(const std::vector<SweptPair>& pairs) {
    for (const SweptPair& pair : pairs) {
      const bool is_new = intervals_.emplace(std::pair(pair.a, pair.b), std::pair(pair.first, pair.last)).second;
      EXPECT_TRUE(is_new) << pair.a << ", " << pair.b;
    }
  }
  void expect(std::uint32_t a, std::uint32_t b, double x) const {
    const auto found = intervals_.find({a, b});
    if (found == intervals_.end()) {
      ADD_FAILURE() << a << ", " << b << " at " << x;
      return;
    }
    EXPECT_LE(static_cast<double>(found->second.first), x);
    EXPECT_GE(static_cast<double>(found->second.second), x);
  }

 private:
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<float, float>> intervals_;
};

/// Expects the overlap of these pairs of triangles to have the bits of that of a search.
inline void expect_same_bits(OverlapQuery& query, const Pose& pose, const std::vector<TrianglePair>& pairs) {
  const Eigen::Vector3d reference(0.1, -0.4, 0.2);
  const Overlap expected = query.evaluate(pose, reference);
  const Overlap selected = query.evaluate(pose, reference, pairs);
  EXPECT_EQ(selected.crossings, expected.crossings);
  EXPECT_EQ(selected.volume, expected.volume);
  EXPECT_EQ(selected.area, expected.area);
  EXPECT_EQ(selected.moment, expected.moment);
}

/// Expects select_pairs() and select_triangles() to find what intersects within a margin of the fraction x.
/// @param margin a fraction of the displacement
inline void expect_selected(OverlapQuery& query, const Tree& a, const Tree& b, const Pose& X_AB,
                            const Eigen::Vector3d& displacement, const std::vector<SweptPair>& leaves,
                            const std::vector<SweptPair>& triangles, double x, double margin) {
  const FractionRange range{std::max(0.0, x - margin), std::min(1.0, x + margin)};
  std::vector<TrianglePair> of_triangles, of_leaves;
  select_pairs(triangles, range, of_triangles);
  select_triangles(a, b, moved(X_AB, x * displacement), margin * displacement.norm(), leaves, range, of_leaves);
  for (const double at : {range.first, range.last}) {
    SCOPED_TRACE(::testing::Message() << at << ", within " << margin << " of " << x);
    expect_same_bits(query, moved(X_AB, at * displacement), of_triangles);
    expect_same_bits(query, moved(X_AB, at * displacement), of_leaves);
    if (margin == 0.0) break;
  }
}

/// At many fractions of the displacement: every two triangles that cross are a pair, and so are their leaves, whose
/// interval contains the fraction. Returns the number of crossings.
inline std::size_t expect_swept(const Solid& solid_a, const Solid& solid_b, const Pose& X_AB,
                                const Eigen::Vector3d& displacement) {
  const Tree &a = solid_a.tree(), &b = solid_b.tree();
  OverlapQuery query(solid_a, solid_b);
  std::vector<SweptPair> leaves, triangles;
  CandidateScratch scratch;
  find_swept_leaves(a, b, X_AB, displacement, scratch, leaves);
  find_swept_triangles(a, b, X_AB, displacement, leaves, triangles);
  const Intervals of_leaves(leaves), of_triangles(triangles);
  const std::vector<std::uint32_t> leaves_a = leaves_of(a), leaves_b = leaves_of(b);
  std::size_t crossings = 0;
  constexpr int k_fractions = 23;
  for (int i = 0; i <= k_fractions; ++i) {
    const double x = static_cast<double>(i) / k_fractions;
    const Pose pose = moved(X_AB, x * displacement);
    constexpr double k_margins[] = {0.0, 0.0, 0.0, 1e-7, 0.0, 0.02};
    expect_selected(query, a, b, X_AB, displacement, leaves, triangles, x, k_margins[i % 6]);
    std::vector<TrianglePair> pairs;
    find_candidates(a, b, pose, scratch, pairs);
    for (const TrianglePair& pair : crossings_among(a, b, pose, pairs)) {
      ++crossings;
      of_leaves.expect(leaves_a[pair.a], leaves_b[pair.b], x);
      of_triangles.expect(pair.a, pair.b, x);
    }
  }
  return crossings;
}

}  // namespace sixdof::swept
