#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// Concave polygons with more corners than this are refused: cutting ears takes quadratic time (about a second here).
inline constexpr std::size_t k_most_corners_of_a_concave_polygon = 10'000;

/// Appends the n - 2 triangles of a polygon with n >= 3 corners to `triangles`, in the polygon's orientation.
///
/// - Strictly convex (seen along its Newell normal): a fan from the first corner.
/// - Otherwise: ears are cut in the projection along the axis nearest the Newell normal, so that a concave face gets
///   its own surface and not a folded one. Corners on a straight line survive as corners of triangles; a corner that
///   repeats its neighbour yields a collapsed triangle, which Mesh::build counts.
/// - No area at all: a fan of zero-area triangles, which keeps the surface closed and shows in Mesh::repairs().
///
/// A polygon that is not planar becomes a surface only by this choice; another program may choose otherwise.
/// @param corners vertex indices, all in range, counter-clockwise seen from outside.
/// @return empty, or why the polygon cannot be triangulated: it crosses itself, or is concave with more than
/// k_most_corners_of_a_concave_polygon corners. `triangles` is unchanged then.
std::string triangulate(std::span<const std::uint32_t> corners, const std::vector<Eigen::Vector3d>& vertices,
                        std::vector<Triangle>& triangles);

}  // namespace sixdof
