#include <sixdof/configuration/configuration_set.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>
#include <sixdof/base/hash.h>
#include <sixdof/base/hdf5.h>

namespace sixdof {
namespace {

constexpr const char* k_format = "sixdof-configuration-set";
constexpr std::uint64_t k_format_version = 1;
constexpr std::size_t k_chunk_bytes = std::size_t{1} << 20;  ///< HDF5's chunk cache of 1 MiB holds one.

std::string_view to_string(BucketKind kind) { return kind == BucketKind::distance ? "distance" : "volume"; }

/// Hash of a sequence of named fields; lengths are part of it, so that no two sequences run into one another.
class FieldHash {
 public:
  void add(std::string_view text) {
    const std::array<std::uint64_t, 1> size{text.size()};
    hash_.add_values(std::span<const std::uint64_t>(size));
    hash_.add(std::as_bytes(std::span(text)));
  }
  void add(std::span<const double> values) {
    const std::array<std::uint64_t, 1> size{values.size()};
    hash_.add_values(std::span<const std::uint64_t>(size));
    hash_.add_values(values);
  }
  void add(double value) { add(std::span<const double>(&value, 1)); }
  void add(std::uint64_t value) { hash_.add_values(std::span<const std::uint64_t>(&value, 1)); }
  void add(const MeshStamp& mesh) {
    add(mesh.name);
    add(mesh.hash);
    add(mesh.triangles);
    add(std::span<const double>(mesh.box_min.data(), 3));
    add(std::span<const double>(mesh.box_max.data(), 3));
    add(mesh.volume);
  }
  std::string hex() const { return hash_.hex(); }

 private:
  ContentHash hash_;
};

std::span<const double> values_of(const std::vector<Eigen::Vector3d>& directions) {
  return {directions.front().data(), 3 * directions.size()};
}

std::span<const double> values_of(const std::vector<Eigen::Vector4d>& rotations) {
  return {rotations.front().data(), 4 * rotations.size()};
}

std::string hash_of(std::span<const double> values) {
  FieldHash hash;
  hash.add(values);
  return hash.hex();
}

std::string hash_of(const SetDescription& set, const std::vector<BucketSummary>& buckets) {
  FieldHash hash;
  hash.add(k_format);
  hash.add(k_format_version);
  hash.add(set.generator_version);
  hash.add(set.a);
  hash.add(set.b);
  hash.add(set.grid.spec);
  hash.add(set.grid.sampler);
  hash.add(set.grid.direction_step_degrees);
  hash.add(set.grid.rotation_step_degrees);
  hash.add(values_of(set.grid.directions));
  hash.add(values_of(set.grid.rotations));
  for (const BucketSummary& bucket : buckets) {
    hash.add(bucket.key.name());
    hash.add(bucket.target);
    hash.add(bucket.aim);
    hash.add(bucket.tolerance);
    hash.add(bucket.largest_residual);
    hash.add(bucket.reachable);
    hash.add(bucket.oracle);
    hash.add(bucket.oracle_version);
    hash.add(bucket.hash);
  }
  return hash.hex();
}

void write_stamp(hdf5::File& file, const std::string& group, const MeshStamp& mesh) {
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

MeshStamp read_stamp(const hdf5::File& file, const std::string& name, const std::string& group) {
  MeshStamp mesh;
  mesh.name = file.read_string(group, "name");
  mesh.hash = file.read_string(group, "content_hash");
  mesh.triangles = file.read_count(group, "triangles");
  mesh.volume = file.read_number(group, "volume");
  const std::string box_name = group + "/box";
  if (file.matrix_size(box_name) != std::pair<std::size_t, std::size_t>(2, 3)) {
    throw BadFile(name, box_name, "is not 2 x 3");
  }
  const std::vector<double> box = file.read_matrix(box_name);
  mesh.box_min = {box[0], box[1], box[2]};
  mesh.box_max = {box[3], box[4], box[5]};
  return mesh;
}

template <int size>
std::vector<Eigen::Matrix<double, size, 1>> read_vectors(const hdf5::File& file, const std::string& name,
                                                         const std::string& object) {
  const auto [rows, columns] = file.matrix_size(object);
  if (columns != size || rows == 0 || rows > k_max_grid_samples) {
    throw BadFile(name, object, fmt::format("is {} x {}, not n x {}", rows, columns, size));
  }
  const std::vector<double> values = file.read_matrix(object);
  std::vector<Eigen::Matrix<double, size, 1>> vectors(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    vectors[i] = Eigen::Map<const Eigen::Matrix<double, size, 1>>(&values[i * size]);
  }
  return vectors;
}

void write_summary(hdf5::File& file, const BucketSummary& bucket) {
  const std::string object = bucket.key.name();
  file.write_attribute(object, "target_percent", static_cast<std::uint64_t>(bucket.key.percent));
  file.write_attribute(object, "target", bucket.target);
  file.write_attribute(object, "aim", bucket.aim);
  file.write_attribute(object, "tolerance", bucket.tolerance);
  file.write_attribute(object, "largest_residual", bucket.largest_residual);
  file.write_attribute(object, "reachable", bucket.reachable);
  file.write_attribute(object, "oracle", bucket.oracle);
  file.write_attribute(object, "oracle_version", bucket.oracle_version);
  file.write_attribute(object, "content_hash", bucket.hash);
}

BucketSummary read_summary(const hdf5::File& file, BucketKey key) {
  const std::string object = key.name();
  return {.key = key,
          .target = file.read_number(object, "target"),
          .aim = file.read_number(object, "aim"),
          .tolerance = file.read_number(object, "tolerance"),
          .largest_residual = file.read_number(object, "largest_residual"),
          .reachable = file.read_count(object, "reachable"),
          .oracle = file.read_string(object, "oracle"),
          .oracle_version = file.read_string(object, "oracle_version"),
          .hash = file.read_string(object, "content_hash")};
}

std::uint64_t count_reachable(std::span<const double> travel) {
  return static_cast<std::uint64_t>(
      std::count_if(travel.begin(), travel.end(), [](double s) { return !std::isnan(s); }));
}

void check_mesh(const std::filesystem::path& file, char which, const MeshStamp& stamp, const Mesh& mesh) {
  if (stamp.hash == mesh.hash()) return;
  throw BadArgument(fmt::format(
      "{}: the set was made for another mesh {}: {} ({} triangles, content hash {}), not {} ({} triangles, {})",
      file.string(), which, stamp.name, stamp.triangles, stamp.hash, mesh.name(), mesh.triangles().size(),
      mesh.hash()));
}

}  // namespace

std::string BucketKey::name() const { return fmt::format("{}/{:02}", to_string(kind), percent); }

BucketKey BucketKey::parse(std::string_view name) {
  for (const BucketKind kind : {BucketKind::distance, BucketKind::volume}) {
    const std::string prefix = fmt::format("{}/", to_string(kind));
    if (!name.starts_with(prefix)) continue;
    const std::string_view digits = name.substr(prefix.size());
    BucketKey key{kind, 0};
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), key.percent);
    if (error == std::errc() && end == digits.data() + digits.size() && key.percent >= 0 &&
        key.percent <= k_max_percent) {
      return key;
    }
  }
  throw BadArgument(
      fmt::format("bucket '{}': it reads distance/NN or volume/NN, NN from 00 to {}", name, k_max_percent));
}

MeshStamp MeshStamp::of(const Mesh& mesh) {
  return {.name = mesh.name(),
          .hash = mesh.hash(),
          .triangles = mesh.triangles().size(),
          .box_min = mesh.box().min(),
          .box_max = mesh.box().max(),
          .volume = mesh.volume()};
}

struct ConfigurationSetWriter::State {
  State(std::filesystem::path target, SetDescription set)
      : path(std::move(target)), description(std::move(set)), atomic(path) {}

  std::filesystem::path path;
  SetDescription description;
  AtomicFile atomic;
  std::unique_ptr<hdf5::File> file;
  std::vector<BucketSummary> buckets;
};

ConfigurationSetWriter::ConfigurationSetWriter(std::filesystem::path path, SetDescription description) {
  const Grid& grid = description.grid;
  if (grid.directions.empty() || grid.rotations.empty()) throw BadArgument("a configuration set needs a grid");
  state_ = std::make_unique<State>(std::move(path), std::move(description));
  const SetDescription& set = state_->description;
  const hdf5::Session session;
  state_->file = std::make_unique<hdf5::File>(hdf5::File::create(state_->atomic.temporary_path(), state_->path));
  hdf5::File& file = *state_->file;
  file.write_attribute("/", "format", std::string(k_format));
  file.write_attribute("/", "format_version", k_format_version);
  file.write_attribute("/", "generator_version", set.generator_version);
  file.write_attribute("/", "grid", set.grid.spec);
  file.write_attribute("/", "sampler", set.grid.sampler);
  file.write_attribute("/", "direction_step_degrees", set.grid.direction_step_degrees);
  file.write_attribute("/", "rotation_step_degrees", set.grid.rotation_step_degrees);
  write_stamp(file, "mesh_a", set.a);
  write_stamp(file, "mesh_b", set.b);
  file.write_matrix("directions", values_of(set.grid.directions).data(), set.grid.directions.size(), 3, 0);
  file.write_matrix("rotations", values_of(set.grid.rotations).data(), set.grid.rotations.size(), 4, 0);
  file.make_group("distance");
  file.make_group("volume");
}

ConfigurationSetWriter::~ConfigurationSetWriter() {
  if (!state_ || !state_->file) return;
  const hdf5::Session session;
  state_->file.reset();
}

void ConfigurationSetWriter::write(BucketSummary summary, std::span<const double> travel) {
  const Grid& grid = state_->description.grid;
  const std::string name = summary.key.name();
  BucketKey::parse(name);
  for (const BucketSummary& other : state_->buckets) {
    if (other.key == summary.key) throw BadArgument(fmt::format("bucket {}: written already", name));
  }
  if (travel.size() != grid.configurations()) {
    throw BadArgument(
        fmt::format("bucket {}: {} values for {} configurations", name, travel.size(), grid.configurations()));
  }
  for (const double s : travel) {
    if (std::isinf(s) || s < 0.0) throw BadArgument(fmt::format("bucket {}: travel {}", name, s));
  }
  summary.reachable = count_reachable(travel);
  summary.hash = hash_of(travel);
  const std::size_t chunk_rows = std::max<std::size_t>(1, k_chunk_bytes / (sizeof(double) * grid.directions.size()));
  const hdf5::Session session;
  state_->file->write_matrix(name, travel.data(), grid.rotations.size(), grid.directions.size(), chunk_rows);
  write_summary(*state_->file, summary);
  state_->buckets.push_back(std::move(summary));
}

void ConfigurationSetWriter::commit() {
  std::ranges::sort(state_->buckets, {}, &BucketSummary::key);
  const hdf5::Session session;
  state_->file->write_attribute("/", "content_hash", hash_of(state_->description, state_->buckets));
  state_->file->close();
  state_->file.reset();
  state_->atomic.commit();
}

ConfigurationSet::ConfigurationSet(std::filesystem::path path) : path_(std::move(path)) {
  const std::string name = path_.string();
  const hdf5::Session session;
  const hdf5::File file = hdf5::File::open(path_);
  if (file.read_string("/", "format") != k_format) throw BadFile(name, "root", "is not a sixdof configuration set");
  const std::uint64_t version = file.read_count("/", "format_version");
  if (version != k_format_version) {
    throw BadFile(name, "root",
                  fmt::format("is of format version {}; this build reads version {}", version, k_format_version));
  }
  description_.generator_version = file.read_string("/", "generator_version");
  description_.a = read_stamp(file, name, "mesh_a");
  description_.b = read_stamp(file, name, "mesh_b");
  Grid& grid = description_.grid;
  grid.spec = file.read_string("/", "grid");
  grid.sampler = file.read_string("/", "sampler");
  grid.direction_step_degrees = file.read_number("/", "direction_step_degrees");
  grid.rotation_step_degrees = file.read_number("/", "rotation_step_degrees");
  grid.directions = read_vectors<3>(file, name, "directions");
  grid.rotations = read_vectors<4>(file, name, "rotations");
  for (const BucketKind kind : {BucketKind::distance, BucketKind::volume}) {
    if (!file.exists(std::string(to_string(kind)))) continue;
    for (int percent = 0; percent <= BucketKey::k_max_percent; ++percent) {
      const BucketKey key{kind, percent};
      if (!file.exists(key.name())) continue;
      const auto [rows, columns] = file.matrix_size(key.name());
      if (rows != grid.rotations.size() || columns != grid.directions.size()) {
        throw BadFile(name, key.name(),
                      fmt::format("is {} x {}, not {} rotations x {} directions", rows, columns, grid.rotations.size(),
                                  grid.directions.size()));
      }
      buckets_.push_back(read_summary(file, key));
    }
  }
  hash_ = file.read_string("/", "content_hash");
  if (hash_of(description_, buckets_) != hash_) {
    throw BadFile(name, "root", "content does not have the hash that was stored with it: damaged or edited");
  }
}

bool ConfigurationSet::has(BucketKey key) const {
  return std::ranges::find(buckets_, key, &BucketSummary::key) != buckets_.end();
}

const BucketSummary& ConfigurationSet::summary(BucketKey key) const {
  const auto found = std::ranges::find(buckets_, key, &BucketSummary::key);
  if (found != buckets_.end()) return *found;
  std::vector<std::string> names;
  for (const BucketSummary& bucket : buckets_) names.push_back(bucket.key.name());
  throw BadArgument(fmt::format("{}: no bucket {}; there are {}", path_.string(), key.name(), fmt::join(names, ", ")));
}

std::vector<double> ConfigurationSet::read(BucketKey key) const {
  const BucketSummary& bucket = summary(key);
  const std::string name = key.name();
  std::vector<double> travel;
  {
    const hdf5::Session session;
    travel = hdf5::File::open(path_).read_matrix(name);
  }
  ++buckets_read_;
  if (hash_of(travel) != bucket.hash || travel.size() != grid().configurations()) {
    throw BadFile(path_.string(), name,
                  "values do not have the hash that was stored with them: damaged, edited or replaced since opening");
  }
  if (count_reachable(travel) != bucket.reachable) {
    throw BadFile(path_.string(), name,
                  fmt::format("{} values are numbers, but {} are said to be reachable", count_reachable(travel),
                              bucket.reachable));
  }
  return travel;
}

void ConfigurationSet::check_meshes(const Mesh& a, const Mesh& b) const {
  check_mesh(path_, 'A', description_.a, a);
  check_mesh(path_, 'B', description_.b, b);
}

bool looks_like_configuration_set(const std::filesystem::path& path) {
  constexpr std::string_view k_signature = "\x89HDF\r\n\x1a\n";
  std::array<char, k_signature.size()> head{};
  std::ifstream in(path, std::ios::binary);
  in.read(head.data(), head.size());
  return in && std::string_view(head.data(), head.size()) == k_signature;
}

}  // namespace sixdof
