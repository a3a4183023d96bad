#pragma once

#include <span>

#include <Eigen/Core>

#include <sixdof/geometry/tree.h>

namespace sixdof::detail {

/// Whether the convex hull of a few points is certainly nowhere nearer to a mesh's surface than `clearance`. If one of
/// the points is inside of the solid, then so is the hull. A separating axis is found for every triangle that is not
/// culled by the volumes of the tree, so the answer "yes" is certain, and "no" may be a hull that is only close.
/// @param points up to k_most_hull_points, in the mesh's frame
/// @param clearance a length above the rounding of the points
bool is_hull_clear(const Tree& tree, std::span<const Eigen::Vector3d> points, double clearance);

inline constexpr std::size_t k_most_hull_points = 8;
/// Triangles that are tested at most: a hull with more around it is not called clear.
inline constexpr std::size_t k_most_hull_triangles = 5000;

/// The same of a single triangle.
bool is_hull_clear(const Tree::Corners& triangle, std::span<const Eigen::Vector3d> points, double clearance);

}  // namespace sixdof::detail
