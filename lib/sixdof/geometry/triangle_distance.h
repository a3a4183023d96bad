#pragma once

#include <array>
#include <limits>

#include <Eigen/Core>

namespace sixdof {

/// Closest points of two triangles, in the frame of the input.
struct ClosestPoints {
  double distance = 0.0;  ///< Length of on_a - on_b, more accurate than the difference of the rounded points.
  Eigen::Vector3d on_a = Eigen::Vector3d::Zero();
  Eigen::Vector3d on_b = Eigen::Vector3d::Zero();
};

using TriangleCorners = std::array<Eigen::Vector3d, 3>;

/// The absolute error of a distance is at most this times (longest edge + distance): it is the exact distance of
/// triangles whose corners are off by a few roundings of their differences. That holds for parallel and nearly parallel
/// edges, needles and flat triangles, collinear or coincident corners, and at any distance from the origin. The error
/// of the points along the distance has the same bound; where triangles are nearly parallel, the points are one pair of
/// many that are nearly closest.
inline constexpr double k_triangle_distance_error = 1e-15;

/// The distance of disjoint triangles whose computed difference rounds to zero.
inline constexpr double k_least_distance = std::numeric_limits<double>::min();

/// Distance of two closed triangles, each of which may be a segment or a point. It is exactly 0, with a common point,
/// if and only if triangles_intersect().
ClosestPoints triangle_triangle_distance(const TriangleCorners& a, const TriangleCorners& b);

/// A lower bound on triangle_triangle_distance(): the gap along the normal of the one or the other triangle, less the
/// rounding of both. Equal to the distance, up to rounding, where a closest point lies inside a face; negative if there
/// is no gap.
double triangle_gap(const TriangleCorners& a, const TriangleCorners& b);

/// Whether two closed triangles have a point in common. Exact for the given doubles (limits of the coordinates:
/// predicates.h), also where triangles touch, are coplanar or degenerate.
bool triangles_intersect(const TriangleCorners& a, const TriangleCorners& b);

/// Limits of triangle_triangle_distance() and of oracle/triangle_distances.cpp.
namespace detail {

/// Below this sine of the angle between two edges they count as parallel: the error is the sine times the edge.
inline constexpr double k_parallel_sine = 2.0 * 0x1p-53;
/// Above this sine one refinement is enough: the error of the first solution is about roundoff / sine^2 = 1e-10 times
/// (distance / edge).
inline constexpr double k_wide_sine = 1e-3;
/// A first solution farther than this outside of [0, 1] is not refined. Refinement could move it into [0, 1] only at a
/// distance of 1e9 edges, and there the border is as close as the interior.
inline constexpr double k_margin = 0.125;
/// Triangles are disjoint if their projections on the line through the closest points have a gap of more than this
/// times the size: the rounding of a dot product of differences is less than 8 units.
inline constexpr double k_safe_gap = 16.0 * 0x1p-53;

}  // namespace detail

}  // namespace sixdof
