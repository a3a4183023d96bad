#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include <sixdof/algorithm/vps/grid.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof::vps {

/// The voxelmap of a body: an integer layer v for every voxel. v = 0 where the surface touches the voxel; elsewhere |v|
/// is the Euclidean distance from the voxel's centre to the nearest surface voxel's centre, in voxels, rounded to the
/// nearest integer (at least 1); v > 0 inside, v < 0 outside. On an axis-aligned face these are McNeely's layers.
///
/// |v| size differs from the distance of the voxel's centre to the surface by at most k_layer_error voxels.
///
/// A brick is stored if it has a voxel with v >= -border; for the others the table has one distance. Building needs 2
/// bytes and 1 bit per voxel of the grid.
struct VoxelMap {
  /// Rounding to an integer 1/2, and half a voxel's diagonal between a surface voxel's centre and the surface in it.
  static constexpr double k_layer_error = 0.5 + 0.8660254037844387;

  VoxelGrid grid;
  int border = 0;      ///< Stored layers outside the body.
  int layer_bits = 8;  ///< 8 if no layer exceeds 127, else 16.
  std::uint64_t surface_voxels = 0;
  std::uint64_t inside_voxels = 0;  ///< Voxels with v > 0.

  /// Per brick of the grid, x fastest: its number in `words`, or -1 - d for a brick that is not stored, d being the
  /// smallest distance (in voxels, rounded down) of its voxels' centres to a surface voxel's centre.
  std::vector<std::int32_t> table;
  /// Layers of the stored bricks, layer_bits each, packed into words from the lowest bits up. Brick 0 represents the
  /// bricks that are not stored: all its layers are min_layer().
  std::vector<std::uint32_t> words;

  /// @param voxel_size edge of a voxel, in the mesh's length unit
  /// @param border number of layers outside the body to store, >= 0
  /// @throws BadMesh if the mesh is not solid(); BadArgument beyond k_max_voxels or k_max_bricks
  static VoxelMap build(const Mesh& mesh, double voxel_size, int border);

  static constexpr double k_max_voxels = 8e9;  ///< 16 GB while building: a larger grid is taken for a mistake.
  static constexpr int k_margin = 2;  ///< Empty voxels around the box: the outermost ones have to be (FreeRuns).
  static constexpr std::uint64_t k_max_bricks = std::uint64_t{1} << 22;  ///< Queries index voxels with 32 bits.

  std::int32_t min_layer() const { return layer_bits == 8 ? INT8_MIN : INT16_MIN; }

  /// Layer of a voxel of the grid; min_layer() in bricks that are not stored.
  std::int32_t layer(int x, int y, int z) const {
    const std::size_t brick = static_cast<std::size_t>(std::max(table[grid.brick_of(x, y, z)], 0));
    const std::size_t i =
        brick * VoxelGrid::k_brick_voxels + static_cast<std::size_t>(VoxelGrid::index_in_brick(x, y, z));
    // Shift the layer to the top of its word, then down again with sign extension.
    if (layer_bits == 8) return std::bit_cast<std::int32_t>(words[i / 4] << (24 - i % 4 * 8)) >> 24;
    return std::bit_cast<std::int32_t>(words[i / 2] << (16 - i % 2 * 16)) >> 16;
  }

  std::uint64_t stored_bricks() const {
    return words.size() * static_cast<std::uint64_t>(32 / layer_bits) / VoxelGrid::k_brick_voxels;
  }
  std::size_t bytes() const { return table.size() * sizeof(table[0]) + words.size() * sizeof(words[0]); }
};

}  // namespace sixdof::vps
