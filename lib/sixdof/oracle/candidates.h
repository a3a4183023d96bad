#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/predicates.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/proximity/cross_axes.h>

namespace sixdof {

/// A point of B's mesh in A's frame, rounded. Overlap queries are exact for these rounded points. The order of the
/// additions is fixed, so the bits do not depend on how Eigen vectorizes. Coordinates below the range of the exact
/// predicates become zero.
inline Eigen::Vector3d transform_point(const Pose& X_AB, const Eigen::Vector3d& p) {
  Eigen::Vector3d q;
  for (int k = 0; k < 3; ++k) {
    const double x = ((X_AB.R(k, 0) * p.x() + X_AB.R(k, 1) * p.y()) + X_AB.R(k, 2) * p.z()) + X_AB.t[k];
    q[k] = std::abs(x) < k_smallest_exact_coordinate ? 0.0 : x;
  }
  return q;
}

/// Whether the cross products of two volumes' axes, and of two triangles' edges, pay in a search. They have to separate
/// more than these shares of the pairs; each separated pair of triangles saves a cross().
struct CandidateAxes {
  detail::CrossAxesUse volumes{0.3}, triangles{0.9};
};

/// Memory of a search, for the next one.
struct CandidateScratch {
  /// Two volumes, by their numbers (Tree::Node::number), and the squares of their boxes' diagonals.
  struct VolumePair {
    std::uint32_t a, b;
    float size_a, size_b;
  };
  /// Two leaves, and whether floats are too coarse to separate them.
  struct LeafPair {
    std::uint32_t a, b;
    bool blurred;
  };
  std::vector<VolumePair> volumes;
  std::vector<LeafPair> leaves;
  CandidateAxes axes;

  /// With the roots of both trees.
  void start(const Tree& a, const Tree& b);
  std::size_t bytes() const { return volumes.capacity() * sizeof(VolumePair) + leaves.capacity() * sizeof(LeafPair); }
};

/// Finds the pairs of triangles of A and of B at X_AB that may intersect: all that intersect in the sense of
/// crossing.h, and few others. The same pairs in the same order on every instruction set.
void find_candidates(const Tree& a, const Tree& b, const Pose& X_AB, CandidateScratch& scratch,
                     std::vector<TrianglePair>& pairs);

/// The same in parts, and for all poses near X_AB: a pose is near if it moves every point of B to within `margin` of
/// where X_AB moves it. All pairs that intersect at a near pose are found. Those of one pose come in the order of
/// find_candidates().
struct CandidateSearch {
  static constexpr std::size_t k_whole = std::numeric_limits<std::size_t>::max();

  Pose X_AB;
  double margin = 0.0;              ///< A length.
  CandidateScratch scratch;         ///< What is left to do.
  std::vector<TrianglePair> pairs;  ///< Found so far.
  std::size_t expansions = 0;       ///< Of pairs of volumes, so far.

  void start(const Tree& a, const Tree& b, const Pose& pose, double length);
  /// Of one pair of volumes and all below it, without a margin.
  void start(const Pose& pose, const CandidateScratch::VolumePair& pair, const CandidateAxes& axes);
  /// Expands up to `most` pairs of volumes, k_whole for all.
  /// @param a, b those of start()
  void advance(const Tree& a, const Tree& b, std::size_t most);
  bool is_complete() const { return scratch.volumes.empty(); }
};

/// Replaces the pair of both roots by the pairs of volumes below, level by level, until there are `enough` or no more
/// without coming to leaves. Searching them one after the other, the last one first, finds the candidates of
/// find_candidates() in their order.
/// @param scratch, wider memory, for the next call
void divide_search(const Tree& a, const Tree& b, const Pose& X_AB, std::size_t enough, CandidateScratch& scratch,
                   std::vector<CandidateScratch::VolumePair>& pairs, std::vector<CandidateScratch::VolumePair>& wider);

/// Two leaves or two triangles that may intersect during a translation of B: indices into Tree::leaves(), or in tree
/// order.
struct SweptPair {
  std::uint32_t a, b;
  /// The interval of the displacement's fraction in which they may. Extends below 0 and above 1 where the pair does.
  float first, last;
};

/// Finds the pairs of leaves of A and B that may intersect while B is translated from X_AB by x * displacement (A's
/// frame), 0 <= x <= 1. Conservative as find_candidates(): the leaves of every two triangles that intersect at x are
/// found, and first <= x <= last.
void find_swept_leaves(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement,
                       CandidateScratch& scratch, std::vector<SweptPair>& pairs);

/// The pairs of triangles of these leaves that may intersect during the same translation, likewise, in the order of
/// find_candidates().
void find_swept_triangles(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement,
                          std::span<const SweptPair> leaf_pairs, std::vector<SweptPair>& pairs);

/// An interval of fractions of a displacement.
struct FractionRange {
  double first, last;
  bool meets(const SweptPair& pair) const {
    return static_cast<double>(pair.first) <= last && first <= static_cast<double>(pair.last);
  }
};

/// The pairs that may intersect at one of these fractions of the displacement, which lie in 0 .. 1.
void select_pairs(std::span<const SweptPair> swept, FractionRange range, std::vector<TrianglePair>& pairs);

/// The pairs of triangles of these leaves, for those leaves that may intersect at one of the fractions. No pair is
/// missed that intersects at X_AB, or after a translation of B from there by at most `margin` (length), provided that
/// the fractions contain those poses. The order is that of find_candidates().
void select_triangles(const Tree& a, const Tree& b, const Pose& X_AB, double margin,
                      std::span<const SweptPair> leaf_pairs, FractionRange range, std::vector<TrianglePair>& pairs);

}  // namespace sixdof
