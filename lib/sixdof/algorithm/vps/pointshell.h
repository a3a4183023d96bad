#pragma once

#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

namespace sixdof::vps {

/// The pointshell of a body: near-uniform points on its surface. Each stands for a cell of the surface: the part that
/// is nearer to it than to any other point facing the same way.
///
/// - Points lie on the surface, in the body's mesh frame, about `spacing` apart. Both sides of a thin plate and both
///   sides of a sharp edge have their own points: a point stands only for surface within k_same_side of its own normal.
/// - The normal is the mean over the cell (its area vector, normalised), pointing INTO the body, of unit length: on
///   flat parts the face normal, on curved parts smooth over a cell.
/// - The area is the cell's (length^2); all of them sum to the mesh's area, up to rounding.
struct PointShell {
  static constexpr double k_same_side = 0.5;  ///< Cosine of the largest angle between a point's normal and its cell's.

  double spacing = 0.0;
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;
  std::vector<double> areas;

  /// Centres of surface voxels of size `spacing` are projected to the closest triangle, once for each of the six main
  /// directions that triangles in the voxel face (a thin plate has points on both sides), thinned out, and moved to the
  /// middle of their cells. Deterministic for any number of threads.
  /// @param spacing in the mesh's length unit
  /// @throws BadMesh if the mesh is not solid(): the normals would mean nothing.
  static PointShell build(const Mesh& mesh, double spacing);
};

}  // namespace sixdof::vps
