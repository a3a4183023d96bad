#pragma once

#include <sixdof/models/surface.h>

namespace sixdof {

/// A closed loop of consecutive vertices of a surface: vertex j lies at (2 j + shift) / (2 count) revolutions about the
/// axis. A single vertex is a pole.
struct Ring {
  std::uint32_t first = 0;
  std::uint32_t count = 1;
  std::uint32_t shift = 0;  ///< 0 or 1 half step: neighbouring rings of equal count are staggered.
};

/// Number of triangles between two rings.
inline std::size_t strip_size(std::uint32_t lower, std::uint32_t upper) {
  return (lower == 1 ? 0 : lower) + (upper == 1 ? 0 : upper);
}

/// Joins two rings by triangles in the order of their angles. Both rings are counter-clockwise seen against the
/// direction from `lower` to `upper`; the triangles face away from the axis.
void stitch(Surface& surface, const Ring& lower, const Ring& upper);

}  // namespace sixdof
