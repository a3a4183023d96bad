#include <sixdof/configuration/set_fields.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof::detail {
namespace {

/// Size of a chunk of a matrix of translations; it fits HDF5's chunk cache.
constexpr std::size_t k_chunk_bytes = std::size_t{1} << 20;

std::string hash_of(std::span<const double> translations) {
  FieldHash hash;
  hash.add(translations);
  return hash.hex();
}

/// Number of values that are not NaN.
std::uint64_t count_reachable(std::span<const double> translations) {
  return static_cast<std::uint64_t>(std::ranges::count_if(translations, [](double s) { return !std::isnan(s); }));
}

std::span<const double> values_of(const std::vector<Eigen::Vector3d>& directions) {
  return {directions.front().data(), 3 * directions.size()};
}

std::span<const double> values_of(const std::vector<Eigen::Vector4d>& rotations) {
  return {rotations.front().data(), 4 * rotations.size()};
}

/// The path of an object in a group.
std::string in_group(const std::string& group, const char* object) {
  return group == "/" ? object : group + "/" + object;
}

template <int size>
std::vector<Eigen::Matrix<double, size, 1>> read_vectors(const hdf5::File& file, const std::filesystem::path& path,
                                                         const std::string& object) {
  const auto [rows, columns] = file.matrix_size(object);
  if (columns != size || rows == 0 || rows > k_max_grid_size) {
    throw BadFile(path.string(), object, fmt::format("is {} x {}, not n x {}", rows, columns, size));
  }
  const std::vector<double> values = file.read_matrix(object);
  std::vector<Eigen::Matrix<double, size, 1>> vectors(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    vectors[i] = Eigen::Map<const Eigen::Matrix<double, size, 1>>(&values[i * size]);
  }
  return vectors;
}

}  // namespace

void FieldHash::add(std::string_view text) {
  add(std::uint64_t{text.size()});
  hash_.add(std::as_bytes(std::span(text)));
}

void FieldHash::add(std::span<const double> values) {
  add(std::uint64_t{values.size()});
  hash_.add_values(values);
}

void FieldHash::add(const MeshIdentity& mesh) {
  add(mesh.name);
  add(mesh.hash);
  add(mesh.triangles);
  add(std::span<const double>(mesh.box_min.data(), 3));
  add(std::span<const double>(mesh.box_max.data(), 3));
  add(mesh.volume);
}

void FieldHash::add(const Grid& grid) {
  add(grid.spec);
  add(grid.sampler);
  add(grid.direction_step_degrees);
  add(grid.rotation_step_degrees);
  add(values_of(grid.directions));
  add(values_of(grid.rotations));
}

void FieldHash::add(const BucketSummary& bucket) {
  add(bucket.key.name());
  add(bucket.nominal);
  add(bucket.target);
  add(bucket.tolerance);
  add(bucket.largest_residual);
  add(bucket.reachable);
  add(bucket.oracle);
  add(bucket.oracle_version);
  add(bucket.hash);
}

std::string hash_of(const Grid& grid) {
  FieldHash hash;
  hash.add(grid);
  return hash.hex();
}

void check_format(const hdf5::File& file, const std::filesystem::path& path, std::string_view format,
                  std::uint64_t version, std::string_view what) {
  if (file.read_string("/", "format") != format) {
    throw BadFile(path.string(), "root", fmt::format("is not {}", what));
  }
  if (const std::uint64_t found = file.read_count("/", "format_version"); found != version) {
    throw BadFile(path.string(), "root",
                  fmt::format("has format version {}, but this build reads version {}; make it again with "
                              "`sixdof generate`",
                              found, version));
  }
}

void write_identity(hdf5::File& file, const std::string& group, const MeshIdentity& mesh) {
  file.make_group(group);
  file.write_attribute(group, "name", mesh.name);
  file.write_attribute(group, "content_hash", mesh.hash);
  file.write_attribute(group, "triangles", mesh.triangles);
  file.write_attribute(group, "volume", mesh.volume);
  std::array<double, 6> box{};
  for (std::size_t i = 0; i < 3; ++i) {
    box[i] = mesh.box_min[static_cast<Eigen::Index>(i)];
    box[3 + i] = mesh.box_max[static_cast<Eigen::Index>(i)];
  }
  file.write_matrix(group + "/box", box.data(), 2, 3, 0);
}

MeshIdentity read_identity(const hdf5::File& file, const std::filesystem::path& path, const std::string& group) {
  MeshIdentity mesh;
  mesh.name = file.read_string(group, "name");
  mesh.hash = file.read_string(group, "content_hash");
  mesh.triangles = file.read_count(group, "triangles");
  mesh.volume = file.read_number(group, "volume");
  const std::string box_name = group + "/box";
  if (file.matrix_size(box_name) != std::pair<std::size_t, std::size_t>(2, 3)) {
    throw BadFile(path.string(), box_name, "is not 2 x 3");
  }
  const std::vector<double> box = file.read_matrix(box_name);
  mesh.box_min = {box[0], box[1], box[2]};
  mesh.box_max = {box[3], box[4], box[5]};
  return mesh;
}

void write_grid(hdf5::File& file, const std::string& group, const Grid& grid) {
  file.write_attribute(group, "grid", grid.spec);
  file.write_attribute(group, "sampler", grid.sampler);
  file.write_attribute(group, "direction_step_degrees", grid.direction_step_degrees);
  file.write_attribute(group, "rotation_step_degrees", grid.rotation_step_degrees);
  file.write_matrix(in_group(group, "directions"), values_of(grid.directions).data(), grid.directions.size(), 3, 0);
  file.write_matrix(in_group(group, "rotations"), values_of(grid.rotations).data(), grid.rotations.size(), 4, 0);
}

Grid read_grid(const hdf5::File& file, const std::filesystem::path& path, const std::string& group) {
  Grid grid;
  grid.spec = file.read_string(group, "grid");
  grid.sampler = file.read_string(group, "sampler");
  grid.direction_step_degrees = file.read_number(group, "direction_step_degrees");
  grid.rotation_step_degrees = file.read_number(group, "rotation_step_degrees");
  grid.directions = read_vectors<3>(file, path, in_group(group, "directions"));
  grid.rotations = read_vectors<4>(file, path, in_group(group, "rotations"));
  return grid;
}

BucketSummary write_bucket(hdf5::File& file, BucketSummary summary, std::span<const double> translations,
                           std::size_t directions) {
  summary.reachable = count_reachable(translations);
  summary.hash = hash_of(translations);
  const std::string object = summary.key.name();
  const std::size_t chunk_rows = std::max<std::size_t>(1, k_chunk_bytes / (sizeof(double) * directions));
  file.write_matrix(object, translations.data(), translations.size() / directions, directions, chunk_rows);
  file.write_attribute(object, "target_percent", static_cast<std::uint64_t>(summary.key.percent));
  file.write_attribute(object, "nominal", summary.nominal);
  file.write_attribute(object, "target", summary.target);
  file.write_attribute(object, "tolerance", summary.tolerance);
  file.write_attribute(object, "largest_residual", summary.largest_residual);
  file.write_attribute(object, "reachable", summary.reachable);
  file.write_attribute(object, "oracle", summary.oracle);
  file.write_attribute(object, "oracle_version", summary.oracle_version);
  file.write_attribute(object, "content_hash", summary.hash);
  return summary;
}

BucketSummary read_summary(const hdf5::File& file, BucketKey key) {
  const std::string object = key.name();
  return {.key = key,
          .nominal = file.read_number(object, "nominal"),
          .target = file.read_number(object, "target"),
          .tolerance = file.read_number(object, "tolerance"),
          .largest_residual = file.read_number(object, "largest_residual"),
          .reachable = file.read_count(object, "reachable"),
          .oracle = file.read_string(object, "oracle"),
          .oracle_version = file.read_string(object, "oracle_version"),
          .hash = file.read_string(object, "content_hash")};
}

std::vector<double> read_translations(const std::filesystem::path& path, const BucketSummary& summary) {
  std::vector<double> translations;
  {
    const hdf5::Session session;
    translations = hdf5::File::open(path).read_matrix(summary.key.name());
  }
  if (hash_of(translations) != summary.hash || count_reachable(translations) != summary.reachable) {
    throw BadFile(path.string(), summary.key.name(),
                  "values do not have the hash that was stored with them: damaged, edited or replaced since opening");
  }
  return translations;
}

std::vector<BucketKey> bucket_keys(const hdf5::File& file) {
  std::vector<BucketKey> keys;
  for (const BucketKind kind : {BucketKind::distance, BucketKind::volume}) {
    if (!file.exists(to_string(kind))) continue;
    for (int percent = 0; percent <= BucketKey::k_max_percent; ++percent) {
      const BucketKey key{kind, percent};
      if (file.exists(key.name())) keys.push_back(key);
    }
  }
  return keys;
}

}  // namespace sixdof::detail
