#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Core>

#include <sixdof/geometry/tree.h>

namespace sixdof {

/// A point of a mesh's surface, in the mesh's frame.
struct SurfacePoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double distance = std::numeric_limits<double>::infinity();  ///< From the query point, unsigned.
  std::uint32_t triangle = 0;                                 ///< Index into Mesh::triangles().
};

/// The point of the mesh's surface closest to `p` (mesh frame); none if no point is nearer than `within`. Of several
/// equally near, the one on the triangle that comes first in tree order. The same bits on every instruction set.
std::optional<SurfacePoint> closest_point(const Tree& tree, const Eigen::Vector3d& p,
                                          double within = std::numeric_limits<double>::infinity());

/// The same for one triangle, given by its corners: by the Voronoi region that p lies in. On needles and flat triangles
/// the point is on the triangle but may not be the closest one; triangle_triangle_distance() has no such limit. Source:
/// C. Ericson, Real-Time Collision Detection (2005), section 5.1.5.
Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& p, const Tree::Corners& corners);

}  // namespace sixdof
