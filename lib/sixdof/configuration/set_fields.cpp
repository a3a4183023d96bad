#include <sixdof/configuration/set_fields.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof::detail {
namespace {

// Attributes by name, in the order of the file.
constexpr std::tuple k_mesh_attributes{
    std::pair{"name", &MeshIdentity::name}, std::pair{"content_hash", &MeshIdentity::hash},
    std::pair{"triangles", &MeshIdentity::triangles}, std::pair{"volume", &MeshIdentity::volume}};
/// Attributes that are not there if they are empty.
constexpr std::tuple k_place_attributes{std::pair{"path", &MeshIdentity::path},
                                        std::pair{"absolute_path", &MeshIdentity::absolute_path}};
constexpr std::tuple k_grid_attributes{std::pair{"grid", &Grid::spec}, std::pair{"sampler", &Grid::sampler},
                                       std::pair{"direction_step_degrees", &Grid::direction_step_degrees},
                                       std::pair{"rotation_step_degrees", &Grid::rotation_step_degrees}};
constexpr std::tuple k_bucket_attributes{std::pair{"nominal", &BucketSummary::nominal},
                                         std::pair{"target", &BucketSummary::target},
                                         std::pair{"tolerance", &BucketSummary::tolerance},
                                         std::pair{"largest_residual", &BucketSummary::largest_residual},
                                         std::pair{"reachable", &BucketSummary::reachable},
                                         std::pair{"oracle", &BucketSummary::oracle},
                                         std::pair{"oracle_version", &BucketSummary::oracle_version},
                                         std::pair{"content_hash", &BucketSummary::hash}};

/// Calls f(name, member) for every attribute of a table.
template <class Object, class... Attributes, class F>
void for_each_attribute(Object& object, const std::tuple<Attributes...>& table, const F& f) {
  std::apply([&](const auto&... one) { (f(one.first, object.*one.second), ...); }, table);
}

struct AttributeWriter {
  hdf5::File& file;
  const std::string& at;
  void operator()(const char* name, const auto& value) const { file.write_attribute(at, name, value); }
};

struct AttributeReader {
  const hdf5::File& file;
  const std::string& at;
  void operator()(const char* name, std::string& value) const { value = file.read_string(at, name); }
  void operator()(const char* name, auto& number) const {
    number = file.read_attribute<std::decay_t<decltype(number)>>(at, name);
  }
};

/// Number of values that are not NaN.
std::uint64_t count_reachable(std::span<const double> translations) {
  return static_cast<std::uint64_t>(std::ranges::count_if(translations, [](double s) { return !std::isnan(s); }));
}

template <int size>
std::span<const double> values_of(const std::vector<Eigen::Matrix<double, size, 1>>& vectors) {
  return {vectors.front().data(), size * vectors.size()};
}

/// The path of an object in a group.
std::string in_group(const std::string& group, const char* object) {
  return group == "/" ? object : group + "/" + object;
}

template <int size>
void read_vectors(const hdf5::File& file, const std::filesystem::path& path, const std::string& object,
                  std::vector<Eigen::Matrix<double, size, 1>>& vectors) {
  const auto [rows, columns] = file.matrix_size(object);
  if (columns != size || rows == 0 || rows > k_max_grid_size) {
    throw BadFile(path.string(), object, fmt::format("is {} x {}, not n x {}", rows, columns, size));
  }
  const std::vector<double> values = file.read_matrix(object);
  for (std::size_t i = 0; i < rows; ++i) vectors.emplace_back(&values[i * size]);
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
  for (const Eigen::Vector3d& corner : {mesh.box_min, mesh.box_max}) add(std::span<const double>(corner.data(), 3));
  add(mesh.volume);
}

void FieldHash::add(const Grid& grid) {
  for_each_attribute(grid, k_grid_attributes, [this](const char*, const auto& value) { add(value); });
  add(values_of(grid.directions));
  add(values_of(grid.rotations));
}

void FieldHash::add(const std::optional<Grid>& grid) {
  add(std::uint64_t{grid ? 1u : 0u});
  if (grid) add(*grid);
}

void FieldHash::add(const std::vector<BucketSummary>& buckets) {
  for (const BucketSummary& bucket : buckets) {
    add(bucket.key.name());
    for_each_attribute(bucket, k_bucket_attributes, [this](const char*, const auto& value) { add(value); });
  }
}

hdf5::File open_format(const std::filesystem::path& path, std::string_view format, std::uint64_t version,
                       std::string_view what) {
  hdf5::File file = hdf5::File::open(path);
  if (file.read_string("/", "format") != format) {
    throw BadFile(path.string(), "root", fmt::format("is not {}", what));
  }
  if (const std::uint64_t found = file.read_attribute<std::uint64_t>("/", "format_version"); found != version) {
    throw BadFile(path.string(), "root",
                  fmt::format("has format version {}, but this build reads version {}; make it again with "
                              "`sixdof generate`",
                              found, version));
  }
  return file;
}

std::string check_content_hash(const hdf5::File& file, const std::filesystem::path& path, const std::string& hash) {
  if (file.read_string("/", "content_hash") == hash) return hash;
  throw BadFile(path.string(), "root", "content does not have the hash that was stored with it: damaged or edited");
}

void write_identity(hdf5::File& file, const std::string& group, const MeshIdentity& mesh) {
  file.make_group(group);
  for_each_attribute(mesh, k_mesh_attributes, AttributeWriter{file, group});
  for_each_attribute(mesh, k_place_attributes, [&](const char* name, const std::string& value) {
    if (!value.empty()) file.write_attribute(group, name, value);
  });
  Eigen::Matrix<double, 3, 2> box;
  box << mesh.box_min, mesh.box_max;
  file.write_matrix(group + "/box", box.data(), 2, 3, 0);
}

MeshIdentity read_identity(const hdf5::File& file, const std::filesystem::path& path, const std::string& group) {
  MeshIdentity mesh;
  for_each_attribute(mesh, k_mesh_attributes, AttributeReader{file, group});
  for_each_attribute(mesh, k_place_attributes, [&](const char* name, std::string& value) {
    if (file.has_attribute(group, name)) value = file.read_string(group, name);
  });
  const std::string box_name = group + "/box";
  if (file.matrix_size(box_name) != std::pair<std::size_t, std::size_t>(2, 3)) {
    throw BadFile(path.string(), box_name, "is not 2 x 3");
  }
  const std::vector<double> box = file.read_matrix(box_name);
  mesh.box_min = Eigen::Vector3d(&box[0]);
  mesh.box_max = Eigen::Vector3d(&box[3]);
  return mesh;
}

void write_grid(hdf5::File& file, const std::string& group, const Grid& grid) {
  for_each_attribute(grid, k_grid_attributes, AttributeWriter{file, group});
  file.write_matrix(in_group(group, "directions"), values_of(grid.directions).data(), grid.directions.size(), 3, 0);
  file.write_matrix(in_group(group, "rotations"), values_of(grid.rotations).data(), grid.rotations.size(), 4, 0);
}

Grid read_grid(const hdf5::File& file, const std::filesystem::path& path, const std::string& group) {
  Grid grid;
  for_each_attribute(grid, k_grid_attributes, AttributeReader{file, group});
  read_vectors(file, path, in_group(group, "directions"), grid.directions);
  read_vectors(file, path, in_group(group, "rotations"), grid.rotations);
  return grid;
}

BucketSummary write_bucket(hdf5::File& file, BucketSummary summary, std::span<const double> translations,
                           std::size_t directions) {
  constexpr std::size_t k_chunk_bytes = std::size_t{1} << 20;  // fits HDF5's chunk cache
  summary.reachable = count_reachable(translations);
  summary.hash = hash_of(translations);
  const std::string object = summary.key.name();
  const std::size_t chunk_rows = std::max<std::size_t>(1, k_chunk_bytes / (sizeof(double) * directions));
  file.write_matrix(object, translations.data(), translations.size() / directions, directions, chunk_rows);
  const double percent = summary.key.percent;
  if (percent == std::floor(percent)) {  // A count, as in sets that have no other percentages.
    file.write_attribute(object, "target_percent", static_cast<std::uint64_t>(percent));
  } else {
    file.write_attribute(object, "target_percent", percent);
  }
  for_each_attribute(summary, k_bucket_attributes, AttributeWriter{file, object});
  return summary;
}

std::vector<BucketSummary> read_summaries(const hdf5::File& file, const std::filesystem::path& path) {
  std::vector<BucketSummary> buckets;
  for (const BucketKind kind : {BucketKind::distance, BucketKind::volume}) {
    const std::string group = to_string(kind);
    if (!file.exists(group)) continue;
    for (const std::string& name : file.names(group)) {
      const std::string object = group + "/" + name;
      const std::optional<double> percent = parse_percent(name);
      if (!percent || BucketKey{kind, *percent}.percent_text() != name) {
        throw BadFile(path.string(), object, "is no name of a bucket");
      }
      BucketSummary bucket{.key = {kind, *percent}};
      for_each_attribute(bucket, k_bucket_attributes, AttributeReader{file, object});
      buckets.push_back(std::move(bucket));
    }
  }
  std::ranges::sort(buckets, {}, &BucketSummary::key);
  return buckets;
}

std::vector<double> read_translations(const std::filesystem::path& path, const BucketSummary& summary) {
  std::vector<double> translations;
  {
    const hdf5::Session session;
    translations = hdf5::File::open(path).read_matrix(summary.key.name());
  }
  if (hash_of(std::span<const double>(translations)) != summary.hash ||
      count_reachable(translations) != summary.reachable) {
    throw BadFile(path.string(), summary.key.name(),
                  "values do not have the hash that was stored with them: damaged, edited or replaced since opening");
  }
  return translations;
}

}  // namespace sixdof::detail
