#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <sixdof/algorithm/ist/hierarchy.h>
#include <sixdof/geometry/pose.h>

namespace sixdof::ist {

/// Where B's nodes stand in A's: maps the coordinates of B's nodes to those of A's nodes, which are in units of the
/// radius of A's bound, all in single precision.
struct NodePlacement {
  Eigen::Matrix3f turn;  ///< Rotation times `ratio`.
  Eigen::Vector3f shift;
  float ratio = 1.0f;  ///< Radius of B's bound over that of A's.
  /// What rounding may add to a distance of two centres or take from a sum of two radii, see of().
  float slack = 0.0f;
  bool apart = false;  ///< Not even the bounds meet; nothing else is set.

  static NodePlacement of(const SphereTree& a, const SphereTree& b, const Pose& X_AB);
};

/// Pairs of indices into two trees, in two columns: memory that grows and never shrinks.
struct PairList {
  std::vector<std::int32_t> a, b;

  void make_room(std::size_t pairs) {
    if (pairs <= a.size()) return;
    const std::size_t more = std::max(pairs, 2 * a.size());
    a.resize(more);
    b.resize(more);
  }
};

}  // namespace sixdof::ist
