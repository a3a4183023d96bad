#pragma once

#include <array>
#include <limits>

#include <Eigen/Core>

namespace sixdof {

/// Closest points of two sets of points, in the frame of the input.
struct ClosestPoints {
  double distance = 0.0;  ///< Length of on_a - on_b, more accurate than the difference of the rounded points.
  Eigen::Vector3d on_a = Eigen::Vector3d::Zero();
  Eigen::Vector3d on_b = Eigen::Vector3d::Zero();
};

using TriangleCorners = std::array<Eigen::Vector3d, 3>;

/// Absolute errors of the distances below are at most this times (longest edge + distance): they are those of the exact
/// distance between figures whose corners are off by a few roundings of their differences. That holds for parallel and
/// nearly parallel edges, needles and flat triangles, collinear or coincident corners alike, and does not grow with the
/// distance of the figures from the origin. Points are off by that in the direction of the distance; sideways, where
/// figures are nearly parallel, they are one of many nearly closest.
inline constexpr double k_triangle_distance_error = 1e-15;

/// Returned where the computed difference of two disjoint triangles rounds to zero: positive, below every real answer.
inline constexpr double k_least_distance = std::numeric_limits<double>::min();

/// Distance of point `p` (as set a) and triangle `t` (as set b).
ClosestPoints point_triangle_distance(const Eigen::Vector3d& p, const TriangleCorners& t);

/// Distance of segment p0 p1 (as set a) and segment q0 q1 (as set b).
ClosestPoints segment_segment_distance(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1, const Eigen::Vector3d& q0,
                                       const Eigen::Vector3d& q1);

/// Distance of two triangles; exactly 0, with a common point, if and only if triangles_intersect(). Triangles that are
/// apart by less than the rounding of their differences can be k_least_distance apart.
ClosestPoints triangle_triangle_distance(const TriangleCorners& a, const TriangleCorners& b);

/// A lower bound on what triangle_triangle_distance() returns, at a tenth of its cost: the gap along the normal of the
/// one or the other triangle, less the rounding of both. The distance itself, up to rounding, where the closest points
/// lie inside of a face; negative where nothing can be said.
double triangle_gap(const TriangleCorners& a, const TriangleCorners& b);

/// Whether two closed triangles have a point in common: exact for the given doubles, also for touching, coplanar and
/// degenerate triangles (limits of the coordinates: predicates.h).
bool triangles_intersect(const TriangleCorners& a, const TriangleCorners& b);

}  // namespace sixdof
