#pragma once

#include <cstdint>
#include <vector>

#include <sixdof/geometry/tree.h>

namespace sixdof::ray_cast {

/// The front of a dual-tree traversal: what the search for one target of a ray leaves for the next. Notation: see
/// ray_cast_traversal.h. Internal: use ray_cast.h.
///
/// To expand a pair of volumes is to bound the children of one of them against the other. The pairs of a child and the
/// other volume that were not expanded themselves are the front: each pair of triangles is below exactly one of
/// them. A pair of the front has a separating-axis bound: at translation t its distance is at least
///   offset + slope * t
/// for t up to that at which the bound was made, and at least the value there for larger t. The slope n . u of a
/// separating axis n is 0 to 1. Bounds do not depend on the target. A smaller target, which is met at a smaller
/// translation, expands only pairs whose bounds no longer reach it.
struct CastFront {
  static constexpr float k_no_bound = -1e30f;     ///< Offset of a pair that no axis is known to separate.
  static constexpr float k_not_in_front = 1e30f;  ///< Offset of a lane without a child, or whose pair was expanded.

  /// Stands for the whole tree where volumes are given by their slots.
  static constexpr std::uint32_t k_root = 0xffffffffu;

  struct Expansion {
    std::uint32_t node;   ///< Its children were bounded
    std::uint32_t other;  ///< against this volume of the other tree (a slot).
    bool expands_a;       ///< Whether the node is of tree A.
  };

  /// Separating-axis bounds of the children of one expansion, [lane].
  struct alignas(64) AxisBounds {
    float offset[Tree::k_width];
    float slope[Tree::k_width];
  };

  /// A pair of volumes still to be expanded: a child of an expansion's node, and its other volume.
  struct Pending {
    std::uint32_t expansion;
    std::uint32_t lane;
    float projection;  ///< Of the difference of the balls' centres on the axis of the best hit: the least first.
  };

  std::vector<Expansion> expansions;
  std::vector<AxisBounds> bounds;  ///< Of each expansion.
  std::size_t initial_size = 0;    ///< Number of expansions after the first target.
  double target = 0.0;             ///< The last one.

  std::vector<Pending> pending;          ///< Scratch: a stack.
  std::vector<std::uint32_t> uncovered;  ///< Scratch: expansions with a child whose bound no longer reaches the target.

  void clear() {
    expansions.clear();
    bounds.clear();
  }
};

}  // namespace sixdof::ray_cast
