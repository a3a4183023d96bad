#pragma once

#include <cstddef>

#include <sixdof/repair/repair.h>
#include <sixdof/repair/surface.h>

namespace sixdof::repairing {

/// Welds border vertices closer than `tolerance` (length) to each other, directly or over others between them: all get
/// the position of the one with the lowest number; or, if inner vertices are as close to that one, of the closest of
/// these. Inner vertices are not welded to each other. Triangles that collapse are dropped.
/// @return repairs made
std::size_t weld_border(Surface& surface, double tolerance, RepairLog& log);

/// Gives every triangle's corners new numbers and drops those that collapse. @return how many were dropped
std::size_t renumber(Surface& surface, std::span<const std::uint32_t> number, RepairLog& log);

}  // namespace sixdof::repairing
