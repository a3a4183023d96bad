#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>

/// Exact winding numbers of closed surfaces. Internal: outside of the library use distance.h or overlap.h.
///
/// The winding number of a closed surface around a point p is 1 inside of a body and 0 outside, and counts every layer
/// where a mesh overlaps itself. It is the sum of the signed crossings of the surface by the shortest axis-parallel
/// segment from p that leaves the mesh's box. Crossings are decided exactly for B translated by the infinitesimal e of
/// predicates.h, so segments through edges and vertices, and points on the surface, are no special cases.
namespace sixdof::detail {

/// How a query maps a point of B to A's frame: X_AB * p, rounded.
using PointTransform = Eigen::Vector3d (*)(const Pose& X_AB, const Eigen::Vector3d& p);

/// Winding number of A's surface around the point `p` (A's frame) of B; `triangles` is scratch.
int winding_of_a(const Tree& a, const Eigen::Vector3d& p, std::vector<std::uint32_t>& triangles);

/// The same sum, term by term: calls `add(i, n)` for each triangle i of A, in tree order, that the segment from `p`
/// crosses; n is 1 or -1.
void for_each_winding_term(const Tree& a, const Eigen::Vector3d& p, std::vector<std::uint32_t>& triangles,
                           const std::function<void(std::uint32_t i, int n)>& add);

/// Winding number of B's surface around the point `p` (A's frame) of A. `transform` maps the corners of B.
int winding_of_b(const Tree& b, const Pose& X_AB, PointTransform transform, const Eigen::Vector3d& p,
                 std::vector<std::uint32_t>& triangles);

}  // namespace sixdof::detail
