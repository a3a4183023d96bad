#pragma once

#include <cstddef>

#include <sixdof/repair/repair.h>
#include <sixdof/repair/surface.h>

namespace sixdof::repairing {

/// Drops triangles without which a surface is closed: fins, inner walls, stray pieces.
///
/// The surface divides space into cells. Which ones lie on the two sides of a triangle follows from its neighbours:
/// around an edge, the space between two successive triangles is one cell, and at an edge of one triangle its two sides
/// are one cell. The cell outside of all has the surface's outline as its boundary. In parts that edges connect and
/// that have edges of an odd number of triangles:
/// - a sheet has the same cell on both sides: it encloses nothing. Sheets go, those outside only if they have at most
///   `max_sheet` of the area of the rest: a larger one may be a part of the shape (a sail), and then all stays;
/// - a wall has cells on both sides that are not outside, so the outline does not need it. It goes where an edge of an
///   odd number of triangles has no other wall: a cavity that a wall reaches stays.
/// They go only if every edge then has an even number of triangles, and a volume is left. An open surface has one cell
/// on both sides everywhere, and stays; so does one with an edge that sheets and walls do not explain.
///
/// A stray piece is connected to nothing by edges, open, and flat: a hole's border would enclose more (k_largest_hole).
/// It goes if all the rest is closed, and it lies inside of it or has at most `max_sheet` of its area. Sheets outside,
/// and stray pieces, have at most half of it together.
/// @return triangles dropped
std::size_t drop_superfluous(Surface& surface, double max_sheet, RepairLog& log);

}  // namespace sixdof::repairing
