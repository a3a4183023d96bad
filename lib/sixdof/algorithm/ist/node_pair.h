#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <sixdof/algorithm/ist/hierarchy.h>
#include <sixdof/geometry/pose.h>

namespace sixdof::ist {

/// Maps the coordinates of B's nodes to those of A's nodes: p -> rotation p + translation, in single precision and in
/// units of the radius of A's bound.
struct NodeTransform {
  Eigen::Matrix3f rotation;  ///< Times `ratio`.
  Eigen::Vector3f translation;
  float ratio = 1.0f;  ///< Radius of B's bound over that of A's.
  float slack = 0.0f;  ///< Bound on the rounding errors of a distance of two centres less a sum of two radii, see of().
  bool apart = false;  ///< The trees' bounds are disjoint; nothing else is set.

  static NodeTransform of(const SphereTree& a, const SphereTree& b, const Pose& X_AB);
};

/// Pairs of indices into two trees. The arrays grow and never shrink; their users keep the number of pairs.
struct PairList {
  std::vector<std::int32_t> a, b;

  void make_room(std::size_t pairs) {
    if (pairs <= a.size()) return;
    const std::size_t size = std::max(pairs, 2 * a.size());
    a.resize(size);
    b.resize(size);
  }
};

}  // namespace sixdof::ist
