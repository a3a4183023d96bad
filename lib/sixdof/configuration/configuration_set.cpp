#include <sixdof/configuration/configuration_set.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>
#include <sixdof/base/hdf5.h>
#include <sixdof/configuration/set_fields.h>

namespace sixdof {
namespace {

constexpr const char* k_format = "sixdof-configuration-set";
/// Version 2 is version 1 plus a grid of their own for volumes. Sets with one grid stay version 1.
constexpr std::uint64_t k_one_grid = 1;
constexpr std::uint64_t k_two_grids = 2;
constexpr const char* k_volume_grid = "volume_grid";

std::uint64_t format_version(const SetDescription& set) { return set.volume_grid ? k_two_grids : k_one_grid; }

void check_grid(const Grid& grid) {
  if (grid.directions.empty() || grid.rotations.empty()) throw BadArgument("a configuration set needs a grid");
}

std::string hash_of(const SetDescription& set, const std::vector<BucketSummary>& buckets) {
  detail::FieldHash hash;
  hash.add(k_format);
  hash.add(format_version(set));
  hash.add(set.generator_version);
  hash.add(set.a);
  hash.add(set.b);
  hash.add(set.grid);
  if (set.volume_grid) hash.add(*set.volume_grid);
  for (const BucketSummary& bucket : buckets) hash.add(bucket);
  return hash.hex();
}

void check_mesh(const std::filesystem::path& file, char which, const MeshIdentity& stamp, const Mesh& mesh) {
  if (stamp.hash == mesh.hash()) return;
  throw BadArgument(fmt::format(
      "{}: the set was made for another mesh {}: {} ({} triangles, content hash {}), not {} ({} triangles, {})",
      file.string(), which, stamp.name, stamp.triangles, stamp.hash, mesh.name(), mesh.triangles().size(),
      mesh.hash()));
}

}  // namespace

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
  check_grid(description.grid);
  if (description.volume_grid) check_grid(*description.volume_grid);
  state_ = std::make_unique<State>(std::move(path), std::move(description));
  const SetDescription& set = state_->description;
  const hdf5::Session session;
  state_->file = std::make_unique<hdf5::File>(hdf5::File::create(state_->atomic.temporary_path(), state_->path));
  hdf5::File& file = *state_->file;
  file.write_attribute("/", "format", std::string(k_format));
  file.write_attribute("/", "format_version", format_version(set));
  file.write_attribute("/", "generator_version", set.generator_version);
  detail::write_grid(file, "/", set.grid);
  if (set.volume_grid) {
    file.make_group(k_volume_grid);
    detail::write_grid(file, k_volume_grid, *set.volume_grid);
  }
  detail::write_identity(file, "mesh_a", set.a);
  detail::write_identity(file, "mesh_b", set.b);
  file.make_group("distance");
  file.make_group("volume");
}

ConfigurationSetWriter::~ConfigurationSetWriter() {
  if (!state_ || !state_->file) return;
  const hdf5::Session session;
  state_->file.reset();
}

void ConfigurationSetWriter::write(BucketSummary summary, std::span<const double> translations) {
  const Grid& grid = state_->description.grid_of(summary.key.kind);
  const std::string name = summary.key.name();
  BucketKey::parse(name);
  for (const BucketSummary& other : state_->buckets) {
    if (other.key == summary.key) throw BadArgument(fmt::format("bucket {}: written already", name));
  }
  if (translations.size() != grid.configurations()) {
    throw BadArgument(
        fmt::format("bucket {}: {} values for {} configurations", name, translations.size(), grid.configurations()));
  }
  for (const double s : translations) {
    if (std::isinf(s) || s < 0.0) throw BadArgument(fmt::format("bucket {}: translations {}", name, s));
  }
  summary.reachable = detail::count_reachable(translations);
  summary.hash = detail::hash_of(translations);
  const hdf5::Session session;
  state_->file->write_matrix(name, translations.data(), grid.rotations.size(), grid.directions.size(),
                             detail::chunk_rows(grid.directions.size()));
  detail::write_summary(*state_->file, summary);
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
  if (version != k_one_grid && version != k_two_grids) {
    throw BadFile(
        name, "root",
        fmt::format("is of format version {}; this build reads versions {} and {}", version, k_one_grid, k_two_grids));
  }
  description_.generator_version = file.read_string("/", "generator_version");
  description_.a = detail::read_identity(file, path_, "mesh_a");
  description_.b = detail::read_identity(file, path_, "mesh_b");
  description_.grid = detail::read_grid(file, path_, "/");
  if (version == k_two_grids) description_.volume_grid = detail::read_grid(file, path_, k_volume_grid);
  for (const BucketKey key : detail::bucket_keys(file)) {
    const Grid& grid = description_.grid_of(key.kind);
    const auto [rows, columns] = file.matrix_size(key.name());
    if (rows != grid.rotations.size() || columns != grid.directions.size()) {
      throw BadFile(name, key.name(),
                    fmt::format("is {} x {}, not {} rotations x {} directions", rows, columns, grid.rotations.size(),
                                grid.directions.size()));
    }
    buckets_.push_back(detail::read_summary(file, key));
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
  std::vector<double> translations;
  {
    const hdf5::Session session;
    translations = hdf5::File::open(path_).read_matrix(name);
  }
  ++buckets_read_;
  if (detail::hash_of(translations) != bucket.hash || translations.size() != grid(key.kind).configurations()) {
    throw BadFile(path_.string(), name,
                  "values do not have the hash that was stored with them: damaged, edited or replaced since opening");
  }
  if (detail::count_reachable(translations) != bucket.reachable) {
    throw BadFile(path_.string(), name,
                  fmt::format("{} values are numbers, but {} are said to be reachable", detail::count_reachable(translations),
                              bucket.reachable));
  }
  return translations;
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
