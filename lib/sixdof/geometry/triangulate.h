#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// Concave polygons with more corners than this are not triangulated: the time of ear clipping is quadratic.
inline constexpr std::size_t k_most_corners_of_a_concave_polygon = 10'000;

/// A polygon is flat if its corners are this close to its plane, as a fraction of its largest coordinate in magnitude:
/// ten times the rounding of coordinates written with six digits.
inline constexpr double k_flatness = 1e-5;

/// What triangulate() finds a polygon to be.
enum class PolygonShape {
  simple,    ///< Flat and without crossings: its triangles are the polygon.
  not_flat,  ///< Without crossings: its triangles are one of several surfaces with the same boundary.
  crossing,  ///< It crosses itself: its triangles have its boundary, but overlap.
  too_large  ///< Concave with more than k_most_corners_of_a_concave_polygon corners: not triangulated.
};

/// Appends the n - 2 triangles of a polygon with n >= 3 corners to `triangles`, in the polygon's orientation.
///
/// - Strictly convex (seen along its Newell normal): a fan from the first corner.
/// - Otherwise: ears are clipped in the projection along the axis nearest the Newell normal. Corners on a straight line
///   remain corners of triangles; a corner that repeats its neighbour yields a collapsed triangle, which Mesh::build
///   counts. Where a polygon that crosses itself has no ear left, any corner is clipped.
/// - No area at all: a fan of zero-area triangles, which keeps the surface closed and is counted in Mesh::repairs().
///
/// @param corners vertex indices, all in range, counter-clockwise seen from outside.
/// @return the polygon's shape; `triangles` is unchanged if it is too_large.
PolygonShape triangulate(std::span<const std::uint32_t> corners, const std::vector<Eigen::Vector3d>& vertices,
                         std::vector<Triangle>& triangles);

}  // namespace sixdof
