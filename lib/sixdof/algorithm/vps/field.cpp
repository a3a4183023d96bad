#include <sixdof/algorithm/vps/field.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <sixdof/algorithm/vps/winding_number.h>
#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>
#include <sixdof/geometry/closest_point.h>

namespace sixdof::vps {
namespace {

constexpr int k_edge = VoxelGrid::k_edge;
constexpr int k_samples = DistanceField::k_samples;

/// Signed distances, in voxels, at the centres of a brick's voxels.
std::vector<float> measure_brick(const VoxelMap& map, const Tree& tree, const WindingNumber& winding,
                                 const Eigen::Array3i& corner) {
  std::vector<float> distances;
  distances.reserve(VoxelGrid::k_brick_voxels);
  // A distance changes by no more than the way from the point where it was measured last.
  constexpr double k_rounding_up = 1.0 + 1e-9;
  double bound = std::numeric_limits<double>::infinity();
  Eigen::Vector3d before = map.grid.center(corner.x(), corner.y(), corner.z());
  for (int z = corner.z(); z < corner.z() + k_edge; ++z) {
    for (int y = corner.y(); y < corner.y() + k_edge; ++y) {
      for (int x = corner.x(); x < corner.x() + k_edge; ++x) {
        const std::int32_t layer = map.layer(x, y, z);
        if (layer < -DistanceField::k_border) {  // out of every spline's reach that can be negative
          distances.push_back(static_cast<float>(-layer));
          continue;
        }
        const Eigen::Vector3d center = map.grid.center(x, y, z);
        const double distance =
            closest_point(tree, center, k_rounding_up * (bound + (center - before).norm()))->distance;
        bound = distance;
        before = center;
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
  std::vector<Eigen::Array3i> corners;  // of the voxelmap's stored bricks, in the order of its table
  std::vector<std::size_t> cells;       // their places in the table
  std::vector<std::int32_t> measured_at(map.table.size(), -1);
  for (std::size_t cell = 0; cell < map.table.size(); ++cell) {
    if (map.table[cell] < 0) continue;
    const auto c = static_cast<int>(cell);
    measured_at[cell] = static_cast<std::int32_t>(corners.size());
    corners.push_back(k_edge *
                      Eigen::Array3i(c % bricks.x(), c / bricks.x() % bricks.y(), c / bricks.x() / bricks.y()));
    cells.push_back(cell);
  }
  std::vector<std::vector<float>> measured(corners.size());
  parallel::for_each(corners.size(),
                     [&](std::size_t i) { measured[i] = measure_brick(map, tree, winding, corners[i]); });

  const auto sample = [&](int x, int y, int z) -> float {
    if (x < 0 || y < 0 || z < 0 || x >= n.x() || y >= n.y() || z >= n.z()) return k_border;
    const std::int32_t at = measured_at[map.grid.brick_of(x, y, z)];
    if (at < 0) return k_border;
    return measured[static_cast<std::size_t>(at)][static_cast<std::size_t>(VoxelGrid::place_in_brick(x, y, z))];
  };
  DistanceField field;
  field.grid = map.grid;
  field.table.assign(map.table.size(), 0);
  field.samples.assign(k_brick_samples, 1.0f);
  std::vector<float> brick(k_brick_samples);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    auto next = brick.begin();
    for (int z = -1; z <= k_edge; ++z) {
      for (int y = -1; y <= k_edge; ++y) {
        for (int x = -1; x <= k_edge; ++x) *next++ = sample(corners[i].x() + x, corners[i].y() + y, corners[i].z() + z);
      }
    }
    if (*std::min_element(brick.begin(), brick.end()) >= 0.0f) continue;
    field.table[cells[i]] = static_cast<std::int32_t>(field.stored_bricks());
    field.samples.insert(field.samples.end(), brick.begin(), brick.end());
  }
  if (field.stored_bricks() >= k_most_bricks) {
    throw BadArgument(fmt::format("{}: voxels of size {} need {} bricks of the distance field, more than {}",
                                  mesh.name(), map.grid.size, field.stored_bricks(), k_most_bricks - 1));
  }
  field.samples.push_back(1.0f);  // rows are read four samples at a time, the last of them one beyond
  return field;
}

}  // namespace sixdof::vps
