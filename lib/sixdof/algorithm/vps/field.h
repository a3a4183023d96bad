#pragma once

#include <cstdint>
#include <vector>

#include <sixdof/algorithm/vps/voxelmap.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof::vps {

/// Smoothly interpolated signed distance to a body, negative inside, in voxels.
///
/// Samples are the exact distances of the voxels' centres to the surface, signed by the voxelmap's regions and, in
/// surface voxels, by the winding number. They are the coefficients of a tensor product of quadratic B-splines: the
/// field and its gradient are continuous, a plane's distance is reproduced exactly, a surface of mean curvature H is
/// moved by H size^2 / 4, and an edge is rounded off over one voxel. Where a mesh intersects itself, its inner walls
/// count as surface.
///
/// Stored are bricks of 8^3 voxels, with the neighbouring samples that their splines need (10^3 floats, 4000 bytes),
/// that have a negative sample; elsewhere the field is positive.
struct DistanceField {
  static constexpr int k_samples = VoxelGrid::k_edge + 2;  ///< Along a brick's edge, one beyond on each side.
  static constexpr int k_brick_samples = k_samples * k_samples * k_samples;
  /// How far outside the surface the field may be negative, in voxels. It is a mean of samples, each no smaller than
  /// the signed distance at the point less the way from there to the sample (or than k_border, which stands for what is
  /// left unmeasured). The mean way is at most its root mean square: the squares of a quadratic B-spline's ways average
  /// 1/4 along each axis.
  static constexpr double k_reach = 0.8660254037844387;
  /// Layers outside that the voxelmap must store so that every sample near the body is exact.
  static constexpr int k_border = 4;

  static constexpr std::uint64_t k_most_bricks = std::uint64_t{1} << 21;  ///< The inner loops count samples in 32 bits.

  VoxelGrid grid;
  std::vector<std::int32_t> table;  ///< Per brick of the grid, its number in `samples`; 0: positive throughout.
  std::vector<float> samples;       ///< k_brick_samples per brick, x fastest, in voxels. Brick 0 is all 1.

  /// @param map of the same mesh, with a border of at least k_border
  /// @throws BadArgument if the body needs k_most_bricks or more.
  static DistanceField build(const Mesh& mesh, const VoxelMap& map);

  std::uint64_t stored_bricks() const { return samples.size() / k_brick_samples; }
  std::size_t bytes() const { return table.size() * sizeof(table[0]) + samples.size() * sizeof(samples[0]); }
};

}  // namespace sixdof::vps
