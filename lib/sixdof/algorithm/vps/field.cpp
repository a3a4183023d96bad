#include <sixdof/algorithm/vps/field.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <sixdof/algorithm/vps/surface_voxels.h>
#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>
#include <sixdof/geometry/closest_point.h>
#include <sixdof/geometry/tree.h>

namespace sixdof::vps {
namespace {

constexpr int k_voxels = VoxelGrid::k_edge;  // along a brick's edge

/// Signed distances, in voxels, at the centres of the voxels of the brick whose first voxel is `corner`.
std::vector<float> measure_brick(const VoxelMap& map, const Tree& tree, const WindingNumber& winding,
                                 const Eigen::Array3i& corner) {
  std::vector<float> distances;
  distances.reserve(VoxelGrid::k_brick_voxels);
  // A distance is at most that of the last voxel plus the distance from that voxel.
  constexpr double k_rounding_up = 1.0 + 1e-9;
  double bound = std::numeric_limits<double>::infinity();
  Eigen::Vector3d last = map.grid.center(corner.x(), corner.y(), corner.z());
  for (int z = corner.z(); z < corner.z() + k_voxels; ++z) {
    for (int y = corner.y(); y < corner.y() + k_voxels; ++y) {
      for (int x = corner.x(); x < corner.x() + k_voxels; ++x) {
        const std::int32_t layer = map.layer(x, y, z);
        if (layer < -DistanceField::k_border) {  // has no weight where the field can be negative
          distances.push_back(static_cast<float>(-layer));
          continue;
        }
        const Eigen::Vector3d center = map.grid.center(x, y, z);
        const double distance = closest_point(tree, center, k_rounding_up * (bound + (center - last).norm()))->distance;
        bound = distance;
        last = center;
        const bool inside = layer > 0 || (layer == 0 && winding.at(center) > 0.5);
        distances.push_back(static_cast<float>((inside ? -distance : distance) / map.grid.size));
      }
    }
  }
  return distances;
}

}  // namespace

DistanceField DistanceField::build(const Mesh& mesh, const VoxelMap& map) {
  const Tree tree(mesh);
  const WindingNumber winding(tree);
  const Eigen::Array3i bricks = map.grid.bricks, n = map.grid.voxels();
  std::vector<Eigen::Array3i> corners;  // first voxels of the voxelmap's stored bricks, in the order of its table
  std::vector<std::size_t> entries;     // their indices in the table
  std::vector<std::int32_t> measured_index(map.table.size(), -1);
  for (std::size_t entry = 0; entry < map.table.size(); ++entry) {
    if (map.table[entry] < 0) continue;
    const auto e = static_cast<int>(entry);
    measured_index[entry] = static_cast<std::int32_t>(corners.size());
    corners.push_back(k_voxels *
                      Eigen::Array3i(e % bricks.x(), e / bricks.x() % bricks.y(), e / bricks.x() / bricks.y()));
    entries.push_back(entry);
  }
  std::vector<std::vector<float>> measured(corners.size());
  parallel::for_each(corners.size(),
                     [&](std::size_t i) { measured[i] = measure_brick(map, tree, winding, corners[i]); });

  const auto coefficient = [&](int x, int y, int z) -> float {
    if (x < 0 || y < 0 || z < 0 || x >= n.x() || y >= n.y() || z >= n.z()) return k_border;
    const std::int32_t brick = measured_index[map.grid.brick_of(x, y, z)];
    if (brick < 0) return k_border;
    return measured[static_cast<std::size_t>(brick)][static_cast<std::size_t>(VoxelGrid::index_in_brick(x, y, z))];
  };
  DistanceField field;
  field.grid = map.grid;
  field.table.assign(map.table.size(), 0);
  field.coefficients.assign(k_brick_coefficients, 1.0f);
  std::vector<float> brick(k_brick_coefficients);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    auto next = brick.begin();
    for (int z = -1; z <= k_voxels; ++z) {
      for (int y = -1; y <= k_voxels; ++y) {
        for (int x = -1; x <= k_voxels; ++x) {
          *next++ = coefficient(corners[i].x() + x, corners[i].y() + y, corners[i].z() + z);
        }
      }
    }
    if (*std::min_element(brick.begin(), brick.end()) >= 0.0f) continue;
    field.table[entries[i]] = static_cast<std::int32_t>(field.stored_bricks());
    field.coefficients.insert(field.coefficients.end(), brick.begin(), brick.end());
  }
  if (field.stored_bricks() >= k_max_bricks) {
    throw BadArgument(fmt::format("{}: voxels of size {} need {} bricks of the distance field, more than {}",
                                  mesh.name(), map.grid.size, field.stored_bricks(), k_max_bricks - 1));
  }
  field.coefficients.push_back(1.0f);  // rows are read four at a time: the last one ends here
  return field;
}

}  // namespace sixdof::vps
