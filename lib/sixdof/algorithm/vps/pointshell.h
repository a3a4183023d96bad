#pragma once

#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

namespace sixdof::vps {

/// The pointshell of a body: near-uniform points on its surface. The cell of a point is the part of the surface that is
/// nearer to it than to any other point with a similar normal.
///
/// - Points lie on the surface, in the mesh's frame, about `spacing` apart. The normals in a cell are within
///   k_same_side of the point's, so both sides of a thin plate or of a sharp edge have their own points.
/// - The normal is the mean over the cell (its area vector, normalised). It points INTO the body.
/// - The area is the cell's (length^2); the areas sum to the mesh's, up to rounding.
struct PointShell {
  static constexpr double k_same_side = 0.5;  ///< Cosine of the largest angle between a point's normal and its cell's.

  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;
  std::vector<double> areas;

  /// Projects the centre of each surface voxel of size `spacing` to the closest triangle, once for each of the six
  /// directions +-x, +-y, +-z that triangles in the voxel face; removes points that are too close to another; moves the
  /// rest to the middle of their cells. The same bits for every number of threads.
  /// @param spacing in the mesh's length unit
  /// @throws BadMesh if the mesh is not solid(), since its normals would have no meaning
  static PointShell build(const Mesh& mesh, double spacing);
};

}  // namespace sixdof::vps
