#pragma once

#include <sixdof/models/surface.h>

namespace sixdof {

/// A closed loop of vertices that follow one another in a surface's list: vertex j lies at (2 j + shift) / (2 count) of
/// a turn. One vertex alone is a pole.
struct Ring {
  std::uint32_t first = 0;
  std::uint32_t count = 1;
  std::uint32_t shift = 0;  ///< 0 or 1 half step: neighbouring rings of like count are staggered for better triangles.
};

/// Number of triangles between two rings.
inline std::size_t strip_size(std::uint32_t lower, std::uint32_t upper) {
  return (lower == 1 ? 0 : lower) + (upper == 1 ? 0 : upper);
}

/// Joins two rings by triangles, zipping them up in the order of their angles. Both run counter-clockwise seen against
/// the direction from `lower` to `upper`; triangles then face away from the axis.
void stitch(Surface& surface, const Ring& lower, const Ring& upper);

}  // namespace sixdof
