#pragma once

#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/geometry/triangle_pair.h>

namespace sixdof {

/// Pairs of triangles that may intersect during a translation of B, in the order of find_candidates().
struct SweptCandidates {
  std::vector<TrianglePair> pairs;
  /// Of each pair: the interval of the displacement's fraction in which it may intersect. Extends below 0 and above 1
  /// where the pair does.
  std::vector<float> first, last;
};

/// Finds the pairs of triangles of A and B that may intersect while B is translated from X_AB by x * displacement
/// (A's frame), 0 <= x <= 1. Conservative as find_candidates(): every pair that intersects at x is found, and
/// first <= x <= last.
void find_swept_candidates(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement,
                           SweptCandidates& found);

/// The pairs that may intersect at the fraction x of the displacement.
void select_candidates(const SweptCandidates& swept, double x, std::vector<TrianglePair>& pairs);

}  // namespace sixdof
