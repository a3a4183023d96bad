#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <sixdof/geometry/raw_mesh.h>
#include <sixdof/geometry/sides.h>
#include <sixdof/repair/repair.h>

/// The steps of repair_mesh(), one source file for each, and what they share. Vertices keep their numbers; some may be
/// in no triangle. Every step returns the number of repairs that it made.
namespace sixdof::repairing {

/// Welds border vertices closer than `tolerance` (length) to each other, directly or over others between them: all get
/// the position of the one with the lowest number; or, if inner vertices are as close to that one, of the closest of
/// these. Inner vertices are not welded to each other. Triangles that collapse are dropped.
std::size_t weld_border(RawMesh& surface, double tolerance, RepairLog& log);

/// Drops all but the first of triangles with the same corners and direction. Of two with opposite directions the second
/// is dropped if an edge has an odd number of triangles without it: two bodies may have a wall in common, which stays.
std::size_t drop_duplicates(RawMesh& surface, RepairLog& log);

/// Removes triangles whose corners lie on a line within rounding. Two corners within rounding become one. Otherwise the
/// corner c opposite the longest edge lies on it: the neighbour at that edge is split at c, so that a closed surface
/// stays closed. Those with two or more neighbours at that edge stay.
std::size_t drop_degenerate(RawMesh& surface, RepairLog& log);

/// Splits border edges at the border vertices that lie on them within `tolerance` (length) and more than it from their
/// ends, if a border edge from such a vertex runs along them: then the triangles on both sides have the same edges. A
/// split that would turn a part over is left out.
std::size_t split_at_t_junctions(RawMesh& surface, double tolerance, RepairLog& log);

/// Turns triangles so that neighbours agree. A patch is what edges of two triangles connect.
/// - A closed patch that is in no other closed patch faces outwards.
/// - A closed patch inside of another keeps the direction of most of its triangles, and is turned over if the outermost
///   patch around it is: a cavity stays one.
/// - An open patch keeps the direction of most of its triangles.
/// - A patch with one side only (a Moebius strip) stays as it is.
std::size_t orient(RawMesh& surface, RepairLog& log);

/// Drops triangles without which a surface is closed: fins, inner walls, stray pieces.
///
/// The surface divides space into cells. Around an edge, the space between two successive triangles is one cell; at an
/// edge of one triangle, both of its sides are one cell. The outermost cell is called the outside. Only components
/// (parts that edges connect) with an edge of an odd number of triangles are changed:
/// - A sheet has the same cell on both sides: it encloses nothing. Sheets are dropped, those outside only up to
///   `max_sheet` of the area of the rest. With a larger one, which may be a part of the shape (a sail), all stay.
/// - A wall has cells on both sides that are not the outside: the outline does not need it. It is dropped where an edge
///   of an odd number of triangles has no other wall. A cavity that a wall reaches stays.
/// A component is changed only if every edge then has an even number of triangles and a volume is left. So open
/// surfaces stay, and those with an odd edge that sheets and walls do not explain.
///
/// A stray piece is a component of its own, open, and flat (the border of a hole encloses more: k_largest_hole). It is
/// dropped if all the rest is closed, and it lies inside of it or has at most `max_sheet` of its area. Sheets outside
/// and stray pieces together have at most half of that area.
std::size_t drop_superfluous(RawMesh& surface, double max_sheet, RepairLog& log);

/// Largest part of its shell's area that a hole may have. A border that needs more is that of a sheet, not a hole.
inline constexpr double k_largest_hole = 0.9;

/// Fills the loops of at most `max_edges` border edges with the triangulation of least area, without new vertices
/// (G. Barequet and M. Sharir, "Filling gaps in the boundary of a polyhedron", Computer-Aided Geometric Design 12,
/// 1995). A loop passes no vertex twice; neighbouring triangles agree in direction around it. Loops stay open where
/// every triangulation needs an edge that is there already, or more than k_largest_hole of the area of the triangles
/// that edges connect to it.
std::size_t fill_holes(RawMesh& surface, std::size_t max_edges, RepairLog& log);

/// Whether the corners lie on a line within rounding.
bool is_degenerate(const RawMesh& surface, const Triangle& t);

/// Gives every triangle's corners new numbers and drops those that collapse.
void renumber(RawMesh& surface, std::span<const std::uint32_t> number, RepairLog& log);

/// Removes the triangles that are marked; those beyond the marks, which were added meanwhile, stay.
void erase_marked(std::vector<Triangle>& triangles, const std::vector<std::uint8_t>& marked);

/// The start and end of a side in the direction of its triangle.
inline std::uint32_t start_of(const Side& s) { return s.forward ? s.low : s.high; }
inline std::uint32_t end_of(const Side& s) { return s.forward ? s.high : s.low; }
/// The corner opposite a side.
inline std::uint32_t apex_of(const Side& s, const std::vector<Triangle>& triangles) {
  return triangles[s.triangle()][(s.corner + 2 - 3 * s.triangle()) % 3];
}

/// The sides of edges with one triangle, in the order of sorted_sides().
std::vector<Side> border_sides(std::span<const Side> sorted);

/// An edge in space.
struct Segment {
  Eigen::Vector3d from, to;

  double length() const { return (to - from).norm(); }
  /// Parameter of the closest point of the line: 0 at the start, 1 at the end.
  double parameter(const Eigen::Vector3d& p) const { return (p - from).dot(to - from) / (to - from).squaredNorm(); }
  /// Distance of the segment.
  double distance(const Eigen::Vector3d& p) const {
    return (from + std::clamp(parameter(p), 0.0, 1.0) * (to - from) - p).norm();
  }
  bool holds_inside(const Eigen::Vector3d& p, double tolerance) const {
    return distance(p) <= tolerance && (p - from).norm() > tolerance && (p - to).norm() > tolerance;
  }
};

/// Distance within which positions cannot be told apart: a few roundings of the largest coordinate.
inline double rounding_at(const Eigen::Vector3d& p) {
  constexpr double k_roundings = 4.0 * 0x1p-53;
  return k_roundings * p.lpNorm<Eigen::Infinity>();
}

}  // namespace sixdof::repairing
