#pragma once

#include <cstdint>
#include <vector>

#include <sixdof/geometry/tree.h>

/// What one target of a ray teaches the next. Internal: use ray_cast.h.
namespace sixdof::ray_cast {

/// All pairs of triangles of two trees, covered by the children of nodes that were bounded against volumes of the other
/// tree ("visits"). A child that was culled keeps the reason as a line: at translation t the pair is surely
///   low + slope * t
/// apart, up to the translation at which the line was made, and at larger ones surely as far as there. The slope, of an axis
/// that separates along the ray, is 0 to 1. The line knows no target. So a narrower target, whose translation is smaller, opens
/// only what lines no longer cull.
struct CastFront {
  static constexpr float k_never = -1e30f;  ///< `low` of a child that no line culls.
  static constexpr float k_always =
      1e30f;  ///< `low` of a lane without a child, and of a child with a visit of its own.

  /// The whole tree, where volumes are named by 8 * node + lane.
  static constexpr std::uint32_t k_root = 0xffffffffu;

  struct Visit {
    std::uint32_t node;   ///< Its children were bounded.
    std::uint32_t other;  ///< Volume of the other tree that they were bounded against, by 8 * node + lane.
    bool opens_a;         ///< Whose node it is.
  };

  struct alignas(64) Lines {
    float low[Tree::k_width];
    float slope[Tree::k_width];
  };

  /// A child still to be looked into.
  struct Open {
    std::uint32_t visit;
    std::uint32_t lane;
    float height;  ///< Of what hits first, most likely the lowest.
  };

  std::vector<Visit> visits;
  std::vector<Lines> lines;  ///< Of each visit.
  std::size_t fresh = 0;     ///< Visits of the cast that began it.
  double target = 0.0;          ///< The last one.

  std::vector<Open> open;                ///< Scratch.
  std::vector<std::uint32_t> uncovered;  ///< Scratch: visits of which a child is no longer culled.

  void clear() {
    visits.clear();
    lines.clear();
  }
};

}  // namespace sixdof::ray_cast
