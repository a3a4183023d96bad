#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <sixdof/algorithm/vps/grid.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof::vps {

class WindingNumber;

/// The voxels that a mesh's surface touches: one bit per voxel of the grid, rows along x padded to 64 bits.
class SurfaceVoxels {
 public:
  /// Separating-axis test of every triangle, in parallel; the result does not depend on the number of threads.
  SurfaceVoxels(const Mesh& mesh, const VoxelGrid& grid);

  const VoxelGrid& grid() const { return grid_; }
  bool touched(int x, int y, int z) const {
    return (row(y, z)[static_cast<std::size_t>(x) / 64] >> (static_cast<unsigned>(x) % 64) & 1u) != 0;
  }
  /// Bit x % 64 of word x / 64 tells voxel (x, y, z).
  std::span<const std::uint64_t> row(int y, int z) const {
    return {bits_.data() + row_index(y, z) * words_per_row_, words_per_row_};
  }
  std::size_t count() const;  ///< Number of touched voxels.

 private:
  std::size_t row_index(int y, int z) const {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(grid_.voxels().y()) + static_cast<std::size_t>(y);
  }

  VoxelGrid grid_;
  std::size_t words_per_row_;
  std::vector<std::uint64_t> bits_;
};

/// What lies between the surface voxels: maximal runs of untouched voxels along x, each wholly inside or outside.
///
/// Outside is what a flood from the grid's border reaches through faces of untouched voxels. Every other connected
/// region is enclosed by surface voxels, and is inside if the mesh winds around it (winding number above 1/2 at one of
/// its voxels), or else a void: a cavity bounded by an inner shell, or a passage narrower than a voxel leads to it.
class FreeRuns {
 public:
  struct Run {
    std::int32_t begin, end;  ///< Voxels begin <= x < end.
    bool inside;
  };

  FreeRuns(const SurfaceVoxels& surface, const WindingNumber& winding);

  std::span<const Run> row(int y, int z) const {
    const std::size_t r = static_cast<std::size_t>(z) * rows_per_slice_ + static_cast<std::size_t>(y);
    return {runs_.data() + first_[r], first_[r + 1] - first_[r]};
  }
  std::size_t regions() const { return regions_; }  ///< Connected regions, the outside included.
  std::size_t voids() const { return voids_; }      ///< Enclosed regions that are not inside.

 private:
  std::size_t rows_per_slice_;
  std::vector<std::size_t> first_;
  std::vector<Run> runs_;
  std::size_t regions_ = 0;
  std::size_t voids_ = 0;
};

}  // namespace sixdof::vps
