#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <sixdof/algorithm/vps/grid.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/tree.h>

namespace sixdof::vps {

/// Approximate winding number of a mesh's surface around a point: 1 inside a body, 0 outside, 2 where two bodies of one
/// mesh overlap.
///
/// The sum of the triangles' solid angles. Nodes of the tree farther away than k_far_ratio of their radii are
/// approximated by one dipole (Barill et al., Fast winding numbers for soups and clouds, 2018), with a total error of a
/// few hundredths. The tree outlives it.
class WindingNumber {
 public:
  explicit WindingNumber(const Tree& tree);

  /// @param p in the mesh's frame
  double at(const Eigen::Vector3d& p) const;

 private:
  static constexpr double k_far_ratio = 3.0;

  /// Far-field approximation of a node's triangles.
  struct Dipole {
    Eigen::Vector3d area_vector = Eigen::Vector3d::Zero();  ///< Sum of the triangles' area vectors.
    Eigen::Vector3d center = Eigen::Vector3d::Zero();       ///< Area-weighted.
    double radius = 0.0;                                    ///< Farthest corner from `center`.
  };

  const Tree* tree_;
  std::vector<Dipole> dipoles_;  ///< Per node of the tree.
};

/// The voxels that a mesh's surface touches: one bit per voxel of the grid, rows along x padded to 64 bits.
class SurfaceVoxels {
 public:
  /// Separating-axis test of every triangle, in parallel; the result does not depend on the number of threads.
  SurfaceVoxels(const Mesh& mesh, const VoxelGrid& grid);

  const VoxelGrid& grid() const { return grid_; }
  /// Bit x % 64 of word x / 64 is set if the surface touches voxel (x, y, z).
  std::span<const std::uint64_t> row(int y, int z) const {
    return {bits_.data() + grid_.row(y, z) * words_per_row_, words_per_row_};
  }
  std::size_t count() const;

 private:
  VoxelGrid grid_;
  std::size_t words_per_row_;
  std::vector<std::uint64_t> bits_;
};

/// The voxels that the surface does not touch, as maximal runs along x, each wholly inside or outside the body. Runs
/// are connected through faces of voxels. The region connected to the grid's border is outside. Every other region
/// is enclosed by surface voxels: it is inside if the mesh's winding number at one of its voxels is above 1/2, else it
/// is a void (a cavity bounded by an inner shell, or a pocket whose opening is narrower than a voxel). The outermost
/// voxels of the grid must be untouched.
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

/// Exact squared Euclidean distances between voxel centres and the nearest surface voxel's centre: lower envelopes of
/// parabolas, axis by axis (Felzenszwalb and Huttenlocher, Distance transforms of sampled functions, 2012). The
/// constructor does the pass along z; slice() does the other two for one z.
class DistanceTransform {
 public:
  explicit DistanceTransform(const SurfaceVoxels& surface);

  /// Working memory of one thread.
  struct Scratch {
    std::vector<std::int32_t> values, centers, bounds, output;
  };

  /// @param squared output: nx * ny squared distances in voxels, x fastest
  void slice(int z, Scratch& scratch, std::vector<std::int32_t>& squared) const;

 private:
  static constexpr std::uint16_t k_none = 0xffff;  ///< No surface voxel on this line along z.

  Eigen::Array3i n_;
  std::vector<std::uint16_t> along_z_;
};

}  // namespace sixdof::vps
