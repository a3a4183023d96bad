#pragma once

#include <cmath>
#include <cstddef>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace sixdof::vps {

/// Cubic voxels over a body's box, grouped in bricks of 8 x 8 x 8. Voxel (x, y, z) covers
/// [origin + size (x, y, z), origin + size (x + 1, y + 1, z + 1)] in the body's mesh frame.
struct VoxelGrid {
  static constexpr int k_edge = 8;  ///< Voxels along a brick's edge.
  static constexpr int k_brick_voxels = k_edge * k_edge * k_edge;

  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  double size = 1.0;                               ///< Edge of a voxel, in the mesh's length unit.
  Eigen::Array3i bricks = Eigen::Array3i::Zero();  ///< Count along each axis.

  /// A grid with at least `margin` whole voxels around the box. The box begins in the middle of a voxel: on voxel faces
  /// rounding would decide.
  static VoxelGrid around(const Eigen::AlignedBox3d& box, double voxel_size, int margin) {
    VoxelGrid grid;
    grid.size = voxel_size;
    grid.origin = box.min().array() - (margin + 0.5) * voxel_size;
    for (int axis = 0; axis < 3; ++axis) {
      const double voxels = std::floor(box.sizes()[axis] / voxel_size + margin + 0.5) + 1 + margin;
      grid.bricks[axis] = static_cast<int>(std::ceil(voxels / k_edge));
    }
    return grid;
  }

  bool operator==(const VoxelGrid& other) const {
    return origin == other.origin && size == other.size && (bricks == other.bricks).all();
  }

  Eigen::Array3i voxels() const { return bricks * k_edge; }  ///< Count along each axis.
  double voxel_count() const { return voxels().cast<double>().prod(); }

  /// Continuous voxel coordinates of a point: voxel (x, y, z) covers [x, x + 1) and so on.
  Eigen::Vector3d coordinates(const Eigen::Vector3d& point) const { return (point - origin) / size; }

  /// In the mesh's frame.
  Eigen::Vector3d center(int x, int y, int z) const {
    return origin + size * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5);
  }

  /// Number of a row of voxels along x.
  std::size_t row(int y, int z) const {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(bricks.y() * k_edge) + static_cast<std::size_t>(y);
  }

  /// Index into the table of bricks of the brick that holds a voxel.
  std::size_t brick_of(int x, int y, int z) const {
    const std::size_t bx = static_cast<unsigned>(x) / k_edge, by = static_cast<unsigned>(y) / k_edge,
                      bz = static_cast<unsigned>(z) / k_edge;
    return (bz * static_cast<std::size_t>(bricks.y()) + by) * static_cast<std::size_t>(bricks.x()) + bx;
  }

  /// Index of a voxel inside its brick, 0 .. 511; x runs fastest.
  static int index_in_brick(int x, int y, int z) {
    constexpr int k_last = k_edge - 1;
    return ((z & k_last) * k_edge + (y & k_last)) * k_edge + (x & k_last);
  }
};

}  // namespace sixdof::vps
