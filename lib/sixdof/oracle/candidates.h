#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/predicates.h>
#include <sixdof/geometry/tree.h>

namespace sixdof {

/// Point of B's mesh in A's frame, rounded. These rounded points ARE the placed body: everything after is exact or
/// consistent with them. The sum has a fixed order so that every path gives the same bits, and what is too small for
/// the exact predicates becomes zero.
inline Eigen::Vector3d place(const Pose& X_AB, const Eigen::Vector3d& p) {
  Eigen::Vector3d q;
  for (int k = 0; k < 3; ++k) {
    const double x = ((X_AB.R(k, 0) * p.x() + X_AB.R(k, 1) * p.y()) + X_AB.R(k, 2) * p.z()) + X_AB.t[k];
    q[k] = std::abs(x) < k_smallest_exact_coordinate ? 0.0 : x;
  }
  return q;
}

/// Two triangles that may meet, in tree order.
struct CandidatePair {
  std::uint32_t a, b;
};

/// Finds all pairs of triangles of A and placed B that may meet: never misses a pair that meets in the sense of
/// crossing.h, reports few that do not. The same pairs in the same order on every instruction set.
void find_candidates(const Tree& a, const Tree& b, const Pose& X_AB, std::vector<CandidatePair>& pairs);

/// Finds all triangles of the tree whose boxes meet `box` (in the mesh's frame), up to rounding outwards.
void find_in_box(const Tree& tree, const Eigen::AlignedBox3d& box, std::vector<std::uint32_t>& triangles);

}  // namespace sixdof
