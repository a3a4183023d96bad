#pragma once

#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/candidates.h>

namespace sixdof {

/// Pairs of triangles that may meet while B moves along a straight way, in the order of find_candidates().
struct SweptCandidates {
  std::vector<CandidatePair> pairs;
  /// Of each pair: between which shares of the way it may meet. Reaches beyond 0 and 1 where the pair does.
  std::vector<float> first, last;

  std::size_t bytes() const;
};

/// Finds all pairs of triangles of A and B that may meet at some share x of the way, with B placed at X_AB and then
/// moved by x * way (A's frame), 0 <= x <= 1. As careful as find_candidates(): no pair that meets at x is missing
/// or has first > x or last < x.
void find_swept_candidates(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& way,
                           SweptCandidates& found);

/// Those that may meet at share x.
void select_candidates(const SweptCandidates& swept, double x, std::vector<CandidatePair>& pairs);

}  // namespace sixdof
