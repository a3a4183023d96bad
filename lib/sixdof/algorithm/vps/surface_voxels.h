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
  /// Bit x % 64 of word x / 64 is set if the surface touches voxel (x, y, z).
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

/// The voxels that the surface does not touch, as maximal runs along x, each wholly inside or outside the body.
///
/// Runs are connected through faces of voxels. The region connected to the grid's border is outside. Every other region
/// is enclosed by surface voxels: it is inside if the mesh's winding number at one of its voxels is above 1/2, else it
/// is a void (a cavity bounded by an inner shell, or a pocket whose opening is narrower than a voxel).
///
/// The outermost voxels of the grid must be untouched.
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

 private:
  std::size_t rows_per_slice_;
  std::vector<std::size_t> first_;
  std::vector<Run> runs_;
};

}  // namespace sixdof::vps
