#include <sixdof/algorithm/vps/voxelmap.h>

#include <cmath>

#include <fmt/format.h>

#include <sixdof/algorithm/preparation.h>
#include <sixdof/algorithm/vps/surface_voxels.h>
#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>
#include <sixdof/geometry/tree.h>

namespace sixdof::vps {
namespace {

constexpr int k_edge = VoxelGrid::k_edge;

/// One layer of bricks along z, built by one thread.
struct Slab {
  std::vector<std::int32_t> table;   ///< As VoxelMap::table, stored bricks counted from 0 within the slab.
  std::vector<std::int16_t> layers;  ///< 512 per stored brick.
  std::uint64_t inside = 0;
};

Slab build_slab(const VoxelMap& map, const DistanceTransform& distances, const FreeRuns& runs, int bz) {
  const Eigen::Array3i n = map.grid.voxels();
  const auto nx = static_cast<std::size_t>(n.x()), ny = static_cast<std::size_t>(n.y());
  const auto bricks_x = static_cast<std::size_t>(map.grid.bricks.x());
  const std::size_t bricks = bricks_x * static_cast<std::size_t>(map.grid.bricks.y());
  std::vector<std::int16_t> layers(nx * ny * k_edge);
  std::vector<std::int32_t> nearest(bricks, INT32_MAX);  // smallest squared distance in the brick
  std::vector<std::int16_t> greatest(bricks, INT16_MIN);
  Slab slab;
  DistanceTransform::Scratch scratch;
  std::vector<std::int32_t> squared;
  for (int z = 0; z < k_edge; ++z) {
    distances.slice(bz * k_edge + z, scratch, squared);
    for (int y = 0; y < n.y(); ++y) {
      const std::size_t row = static_cast<std::size_t>(y) * nx;
      std::int16_t* const layer = layers.data() + static_cast<std::size_t>(z) * nx * ny + row;
      for (const FreeRuns::Run& run : runs.row(y, bz * k_edge + z)) {
        if (run.inside) slab.inside += static_cast<std::uint64_t>(run.end - run.begin);
        for (std::int32_t x = run.begin; x < run.end; ++x) {
          const auto distance = static_cast<std::int32_t>(
              std::lround(std::sqrt(static_cast<double>(squared[row + static_cast<std::size_t>(x)]))));
          layer[x] = static_cast<std::int16_t>(std::max(run.inside ? distance : -distance, map.min_layer()));
        }
      }
      for (std::size_t x = 0; x < nx; ++x) {
        const std::size_t brick = map.grid.brick_of(static_cast<int>(x), y, 0);
        nearest[brick] = std::min(nearest[brick], squared[row + x]);
        greatest[brick] = std::max(greatest[brick], layer[x]);
      }
    }
  }
  std::int32_t stored = 0;
  for (std::size_t brick = 0; brick < bricks; ++brick) {
    if (greatest[brick] < -map.border) {
      slab.table.push_back(-1 - static_cast<std::int32_t>(std::floor(std::sqrt(nearest[brick]))));
      continue;
    }
    slab.table.push_back(stored++);
    const std::size_t first = (brick / bricks_x * nx + brick % bricks_x) * k_edge;
    for (std::size_t z = 0; z < k_edge; ++z) {
      for (std::size_t y = 0; y < k_edge; ++y) {
        const auto row = layers.begin() + static_cast<std::ptrdiff_t>(first + (z * ny + y) * nx);
        slab.layers.insert(slab.layers.end(), row, row + k_edge);
      }
    }
  }
  return slab;
}

}  // namespace

VoxelMap VoxelMap::build(const Mesh& mesh, double voxel_size, int border) {
  require_solid(mesh, "a voxelmap");
  VoxelMap map;
  map.grid = VoxelGrid::around(mesh.box(), voxel_size, VoxelMap::k_margin);
  map.border = border;
  if (map.grid.voxel_count() > k_max_voxels) {
    throw BadArgument(fmt::format("{}: {:.3g} voxels of size {} are more than {:.0e}", mesh.name(),
                                  map.grid.voxel_count(), voxel_size, k_max_voxels));
  }
  // No voxel lies deeper than half the body's smallest extent.
  map.layer_bits = 0.5 * mesh.box().sizes().minCoeff() / voxel_size + 1.0 < INT8_MAX && border < INT8_MAX ? 8 : 16;

  const Tree tree(mesh);
  const SurfaceVoxels surface(mesh, map.grid);
  const FreeRuns runs(surface, WindingNumber(tree));
  const DistanceTransform distances(surface);
  map.surface_voxels = surface.count();

  std::vector<Slab> slabs(static_cast<std::size_t>(map.grid.bricks.z()));
  parallel::for_each(slabs.size(),
                     [&](std::size_t bz) { slabs[bz] = build_slab(map, distances, runs, static_cast<int>(bz)); });

  // Brick 0 represents the bricks that are not stored; the slabs' bricks follow in their order.
  const auto per_word = static_cast<std::size_t>(32 / map.layer_bits);
  const std::size_t words_per_brick = VoxelGrid::k_brick_voxels / per_word;
  const std::uint32_t mask = map.layer_bits == 8 ? 0xffu : 0xffffu;
  const auto pack = [&](const std::vector<std::int16_t>& layers) {
    for (std::size_t i = 0; i < layers.size(); i += per_word) {
      std::uint32_t word = 0;
      for (std::size_t k = 0; k < per_word; ++k) {
        word |= (static_cast<std::uint32_t>(layers[i + k]) & mask) << (k * static_cast<unsigned>(map.layer_bits));
      }
      map.words.push_back(word);
    }
  };
  std::size_t stored = 1;
  for (const Slab& slab : slabs) stored += slab.layers.size() / VoxelGrid::k_brick_voxels;
  if (stored >= k_max_bricks) {
    throw BadArgument(fmt::format("{}: voxels of size {} fill {} bricks, more than {}", mesh.name(), voxel_size, stored,
                                  k_max_bricks - 1));
  }
  map.words.reserve(stored * words_per_brick);
  pack(std::vector<std::int16_t>(VoxelGrid::k_brick_voxels, static_cast<std::int16_t>(map.min_layer())));
  for (Slab& slab : slabs) {
    const auto offset = static_cast<std::int32_t>(map.words.size() / words_per_brick);
    for (const std::int32_t entry : slab.table) map.table.push_back(entry < 0 ? entry : entry + offset);
    pack(slab.layers);
    map.inside_voxels += slab.inside;
    slab = {};
  }
  return map;
}

}  // namespace sixdof::vps
