#include <sixdof/algorithm/vps/cached_structures.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <sixdof/algorithm/load_or_build.h>
#include <sixdof/base/cache.h>

namespace sixdof::vps {
namespace {

// To be increased whenever the same mesh and settings give another structure or layout.
constexpr int k_voxelmap_version = 2;
constexpr int k_pointshell_version = 3;
constexpr int k_field_version = 3;

/// Whether every entry of a table refers to a stored brick. Queries rely on it: they do not check indices.
bool within(const std::vector<std::int32_t>& table, std::uint64_t bricks) {
  return std::all_of(table.begin(), table.end(),
                     [&](std::int32_t entry) { return entry < 0 || static_cast<std::uint64_t>(entry) < bricks; });
}

std::size_t brick_count(const VoxelGrid& grid) {
  return static_cast<std::size_t>(grid.bricks.cast<std::int64_t>().prod());
}

CacheEntry pack_voxelmap(const VoxelMap& map) {
  CacheEntry entry;
  entry.put<double>("grid", {map.grid.origin.x(), map.grid.origin.y(), map.grid.origin.z(), map.grid.size});
  entry.put<std::int32_t>("shape",
                          {map.grid.bricks.x(), map.grid.bricks.y(), map.grid.bricks.z(), map.border, map.layer_bits});
  entry.put<std::uint64_t>("counts", {map.surface_voxels, map.inside_voxels});
  entry.put("table", map.table);
  entry.put("words", map.words);
  return entry;
}

std::optional<VoxelMap> unpack_voxelmap(CacheEntry entry) {
  const auto grid = entry.take<double>("grid");
  const auto shape = entry.take<std::int32_t>("shape");
  const auto counts = entry.take<std::uint64_t>("counts");
  if (grid.size() != 4 || shape.size() != 5 || counts.size() != 2) return std::nullopt;
  VoxelMap map;
  map.grid = {{grid[0], grid[1], grid[2]}, grid[3], {shape[0], shape[1], shape[2]}};
  map.border = shape[3];
  map.layer_bits = shape[4];
  map.surface_voxels = counts[0];
  map.inside_voxels = counts[1];
  map.table = entry.take<std::int32_t>("table");
  map.words = entry.take<std::uint32_t>("words");
  const bool valid = (map.layer_bits == 8 || map.layer_bits == 16) && map.grid.bricks.minCoeff() > 0 &&
                     map.table.size() == brick_count(map.grid) && map.stored_bricks() > 0 &&
                     map.stored_bricks() < VoxelMap::k_max_bricks && within(map.table, map.stored_bricks());
  return valid ? std::optional(std::move(map)) : std::nullopt;
}

std::vector<double> flatten(const std::vector<Eigen::Vector3d>& vectors) {
  std::vector<double> numbers;
  numbers.reserve(3 * vectors.size());
  for (const Eigen::Vector3d& v : vectors) numbers.insert(numbers.end(), {v.x(), v.y(), v.z()});
  return numbers;
}

std::vector<Eigen::Vector3d> unflatten(std::span<const double> numbers) {
  std::vector<Eigen::Vector3d> vectors;
  vectors.reserve(numbers.size() / 3);
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
    vectors.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  }
  return vectors;
}

CacheEntry pack_pointshell(const PointShell& shell) {
  CacheEntry entry;
  entry.put("points", flatten(shell.points));
  entry.put("normals", flatten(shell.normals));
  entry.put("areas", shell.areas);
  return entry;
}

std::optional<PointShell> unpack_pointshell(CacheEntry entry) {
  PointShell shell;
  shell.points = unflatten(entry.take<double>("points"));
  shell.normals = unflatten(entry.take<double>("normals"));
  shell.areas = entry.take<double>("areas");
  const bool valid =
      !shell.points.empty() && shell.points.size() == shell.normals.size() && shell.points.size() == shell.areas.size();
  return valid ? std::optional(std::move(shell)) : std::nullopt;
}

CacheEntry pack_field(const DistanceField& field) {
  CacheEntry entry;
  entry.put("table", field.table);
  entry.put("coefficients", field.coefficients);
  return entry;
}

std::optional<DistanceField> unpack_field(CacheEntry entry, const VoxelGrid& grid) {
  DistanceField field;
  field.grid = grid;
  field.table = entry.take<std::int32_t>("table");
  field.coefficients = entry.take<float>("coefficients");
  const bool valid = field.table.size() == brick_count(grid) &&
                     field.coefficients.size() == field.stored_bricks() * DistanceField::k_brick_coefficients + 1 &&
                     std::none_of(field.table.begin(), field.table.end(), [](std::int32_t i) { return i < 0; }) &&
                     within(field.table, field.stored_bricks());
  return valid ? std::optional(std::move(field)) : std::nullopt;
}

}  // namespace

VoxelMap cached_voxelmap(const Mesh& mesh, double voxel_size, int border) {
  const std::string key = fmt::format("version {}, mesh {}, voxel size {:a}, border {}", k_voxelmap_version,
                                      mesh.hash(), voxel_size, border);
  return load_or_build(
      "vps-voxelmap", key, [&] { return VoxelMap::build(mesh, voxel_size, border); }, pack_voxelmap, unpack_voxelmap);
}

PointShell cached_pointshell(const Mesh& mesh, double spacing) {
  const std::string key = fmt::format("version {}, mesh {}, spacing {:a}", k_pointshell_version, mesh.hash(), spacing);
  return load_or_build(
      "vps-pointshell", key, [&] { return PointShell::build(mesh, spacing); }, pack_pointshell, unpack_pointshell);
}

DistanceField cached_field(const Mesh& mesh, const VoxelMap& map) {
  const std::string key = fmt::format("version {}, mesh {}, voxel size {:a}, border {}", k_field_version, mesh.hash(),
                                      map.grid.size, map.border);
  return load_or_build(
      "vps-field", key, [&] { return DistanceField::build(mesh, map); }, pack_field,
      [&](CacheEntry entry) { return unpack_field(std::move(entry), map.grid); });
}

}  // namespace sixdof::vps
