#pragma once

#include <cstddef>

#include <sixdof/repair/repair.h>
#include <sixdof/repair/surface.h>

namespace sixdof::repairing {

/// Drops all but the first of triangles with the same corners and direction. Of two with opposite directions the second
/// is dropped if an edge has an odd number of triangles without it: two bodies may have a wall in common, which stays.
/// @return repairs made
std::size_t drop_duplicates(Surface& surface, RepairLog& log);

/// Whether the corners lie on a line within rounding.
bool is_degenerate(const Surface& surface, const Triangle& t);

/// Removes triangles whose corners lie on a line within rounding. Two corners within rounding become one. Otherwise the
/// corner c opposite the longest edge lies on it: the neighbour at that edge is split at c, so that a closed surface
/// stays closed. Those with two or more neighbours at that edge stay.
/// @return repairs made
std::size_t drop_degenerate(Surface& surface, RepairLog& log);

}  // namespace sixdof::repairing
