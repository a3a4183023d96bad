#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include <sixdof/algorithm/vps/grid.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof::vps {

/// The voxelmap of a body: an integer layer v for every voxel. v = 0 where the surface touches the voxel; elsewhere |v|
/// is the Euclidean distance from the voxel's centre to the nearest surface voxel's centre, in voxels, rounded to the
/// nearest integer (at least 1); v > 0 inside, v < 0 outside. On an axis-aligned face these are McNeely's layers 1, 2,
/// 3, ...; on a slanted one |v| stays a distance, where layers grown from neighbour to neighbour count shorter (through
/// corners) or longer (through faces).
///
/// |v| size differs from the distance of the voxel's centre to the surface by at most k_layer_error voxels.
///
/// Memory: 4 bytes per brick of the grid, and 512 or 1024 bytes (8 or 16 bits per layer) for each stored brick. Stored
/// are the bricks that hold a voxel with v >= -border; of a brick further outside the table keeps one distance.
/// Building takes 2 bytes and 1 bit per voxel of the grid for as long as it lasts.
struct VoxelMap {
  /// Rounding to an integer 1/2, and half a voxel's diagonal between a surface voxel's centre and the surface in it.
  static constexpr double k_layer_error = 0.5 + 0.8660254037844387;

  VoxelGrid grid;
  int border = 0;      ///< Layers outside that are stored.
  int layer_bits = 8;  ///< 8 where the body is thin enough for 127 layers, else 16.
  std::uint64_t surface_voxels = 0;
  std::uint64_t inside_voxels = 0;  ///< Voxels with v > 0.
  std::uint64_t voids = 0;          ///< Regions enclosed by surface voxels but outside the body.

  /// Per brick of the grid, x fastest: its number in `words`, or -1 - d for a brick that is not stored, d being the
  /// smallest distance (in voxels, rounded down) of its voxels' centres to a surface voxel's centre.
  std::vector<std::int32_t> table;
  /// Layers of the stored bricks, layer_bits each, packed into words from the lowest bits up. Brick 0 stands for all
  /// that is far outside: every layer is the least.
  std::vector<std::uint32_t> words;

  /// @param voxel_size edge of a voxel, in the mesh's length unit
  /// @param border >= 0, layers outside to store
  /// @throws BadMesh if the mesh is not solid(); BadArgument if the grid would pass k_most_voxels, or the body
  /// k_most_bricks.
  static VoxelMap build(const Mesh& mesh, double voxel_size, int border);

  static constexpr double k_most_voxels = 8e9;  ///< 16 GB while building: beyond it the size is taken for a slip.
  static constexpr std::uint64_t k_most_bricks = std::uint64_t{1} << 22;  ///< The inner loops count voxels in 32 bits.

  std::int32_t least_layer() const { return layer_bits == 8 ? INT8_MIN : INT16_MIN; }

  /// Layer of a voxel of the grid; least_layer() in bricks that are not stored.
  std::int32_t layer(int x, int y, int z) const {
    return stored_layer(std::max(table[grid.brick_of(x, y, z)], 0), x, y, z);
  }

  /// Lower bound, in voxels, of the distance from the centre of a voxel outside to the nearest surface voxel's centre;
  /// 0 where v >= 0. Squares of such distances are integers d^2 >= (|v| - 1/2)^2, so d^2 >= v^2 - |v| + 1.
  float outside_distance(int x, int y, int z) const {
    const std::int32_t entry = table[grid.brick_of(x, y, z)];
    if (entry < 0) return static_cast<float>(-1 - entry);
    const auto v = static_cast<float>(stored_layer(entry, x, y, z));
    return v < 0.0f ? std::sqrt(v * v + v + 1.0f) : 0.0f;
  }

  std::uint64_t stored_bricks() const {
    return words.size() * static_cast<std::uint64_t>(32 / layer_bits) / VoxelGrid::k_brick_voxels;
  }
  std::size_t bytes() const { return table.size() * sizeof(table[0]) + words.size() * sizeof(words[0]); }

 private:
  std::int32_t stored_layer(std::int32_t brick, int x, int y, int z) const {
    const std::size_t i = static_cast<std::size_t>(brick) * VoxelGrid::k_brick_voxels +
                          static_cast<std::size_t>(VoxelGrid::place_in_brick(x, y, z));
    // Shift the layer to the top of its word, then down again with its sign.
    if (layer_bits == 8) return std::bit_cast<std::int32_t>(words[i / 4] << (24 - i % 4 * 8)) >> 24;
    return std::bit_cast<std::int32_t>(words[i / 2] << (16 - i % 2 * 16)) >> 16;
  }
};

}  // namespace sixdof::vps
