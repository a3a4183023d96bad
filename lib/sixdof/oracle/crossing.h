#pragma once

#include <optional>

#include <Eigen/Core>

#include <sixdof/geometry/triangle_distance.h>

/// The intersection of a triangle of A with a triangle of B, decided by signs of determinants (predicates.h).
namespace sixdof {

/// Intersection of a triangle of A with a triangle of B. Its direction start -> end is that of
/// (normal of A's triangle) x (normal of B's triangle): on A's triangle the part inside B lies to the left of it, on
/// B's triangle the part inside A to the right.
struct Segment {
  Eigen::Vector3d start, end;
  /// The side that pierces the other triangle at that end: 0, 1, 2 for A's triangle, 3, 4, 5 for B's. Side 0 runs from
  /// corner 0 to 1, side 1 from corner 1 to 2, side 2 from corner 2 to 0.
  int start_side = 0, end_side = 0;
};

/// Decides exactly, for B translated by the infinitesimal e of predicates.h, whether and how two triangles intersect.
/// Corners of `b` are in A's frame.
std::optional<Segment> cross(const TriangleCorners& a, const TriangleCorners& b);

namespace detail {
/// Rounding of a projection's difference, relative to the largest coordinate and the axis: a dozen roundings.
inline constexpr double k_projection_rounding = 1e-14;
}  // namespace detail

/// Whether two triangles are certainly separated by a plane through an edge of one of them and across that triangle.
/// Most pairs of triangles of faces in one plane, up to rounding, are separated in this way: fans, strips and grids
/// that lie on each other. cross() tests it first, since such pairs otherwise need exact arithmetic to decide on which
/// side of the plane a corner lies.
bool certainly_apart(const TriangleCorners& a, const TriangleCorners& b);

/// Which of an edge and a triangle belongs to B and is translated by e; the other belongs to A.
enum class Perturbed {
  edge,
  triangle
};

/// Whether the edge from `p` to `q` pierces the triangle: +1 against the triangle's normal (into the body), -1 along
/// it, 0 not at all. Exact, as cross().
int pierce(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const TriangleCorners& triangle, Perturbed perturbed);

}  // namespace sixdof
