#pragma once

#include <cstdint>
#include <vector>

#include <sixdof/algorithm/vps/voxelmap.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof::vps {

/// Smoothly interpolated signed distance to a body, negative inside, in voxels.
///
/// The field is a tensor product of quadratic B-splines. Their coefficients, one per voxel, are the exact distances of
/// the voxels' centres to the surface, signed by the voxelmap's regions and, in surface voxels, by the winding number.
/// The field and its gradient are continuous; the distance to a plane is reproduced exactly, a surface of mean
/// curvature H is displaced by H size^2 / 4, and an edge is rounded off over one voxel. Where a mesh intersects itself,
/// its inner walls count as surface.
///
/// A brick of 8^3 voxels is stored if one of its coefficients is negative, with the neighbours that its splines need
/// (10^3 floats). Elsewhere the field is positive.
struct DistanceField {
  static constexpr int k_brick_edge = VoxelGrid::k_edge + 2;  ///< Coefficients along a stored brick's edge.
  static constexpr int k_brick_coefficients = k_brick_edge * k_brick_edge * k_brick_edge;
  /// Upper bound, sqrt(3/4), on the distance from the surface at which the field may be negative outside, in voxels.
  /// The field is a weighted mean of coefficients, and each is at least the signed distance at the point minus the
  /// distance from there to its voxel's centre (or it is k_border, where none was computed). The mean of these
  /// distances is at most their root mean square; the weights of a quadratic B-spline have a variance of 1/4 along each
  /// axis.
  static constexpr double k_reach = 0.8660254037844387;
  /// Layers outside the body that the voxelmap must store, so that the coefficients of all splines near it are exact.
  static constexpr int k_border = 4;

  static constexpr std::uint64_t k_max_bricks = std::uint64_t{1} << 21;  ///< Queries index coefficients with 32 bits.

  VoxelGrid grid;
  std::vector<std::int32_t> table;  ///< Per brick of the grid: its index in `coefficients`; 0: the field is positive.
  std::vector<float> coefficients;  ///< k_brick_coefficients per brick, x fastest, in voxels. Brick 0 is all 1.

  /// @param map of the same mesh, with a border of at least k_border
  /// @throws BadArgument if the body needs k_max_bricks or more.
  static DistanceField build(const Mesh& mesh, const VoxelMap& map);

  std::uint64_t stored_bricks() const { return coefficients.size() / k_brick_coefficients; }
  std::size_t bytes() const { return table.size() * sizeof(table[0]) + coefficients.size() * sizeof(coefficients[0]); }
};

}  // namespace sixdof::vps
