#pragma once

#include <cstddef>

#include <sixdof/repair/repair.h>
#include <sixdof/repair/surface.h>

namespace sixdof::repairing {

/// Largest part of its shell's area that a hole may have. A border that needs more is that of a sheet, not a hole.
inline constexpr double k_largest_hole = 0.9;

/// Fills the loops of at most `max_edges` border edges with the triangulation of least area, without new vertices
/// (G. Barequet and M. Sharir, "Filling gaps in the boundary of a polyhedron", Computer-Aided Geometric Design 12,
/// 1995). A loop passes no vertex twice; neighbouring triangles agree in direction around it. Loops stay open where
/// every triangulation needs an edge that is there already, or more than k_largest_hole of the area of the triangles
/// that edges connect to it.
/// @return repairs made
std::size_t fill_holes(Surface& surface, std::size_t max_edges, RepairLog& log);

}  // namespace sixdof::repairing
