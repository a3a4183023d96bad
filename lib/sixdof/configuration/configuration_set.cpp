#include <sixdof/configuration/configuration_set.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/base/hdf5.h>
#include <sixdof/configuration/set_fields.h>

namespace sixdof {
namespace {

constexpr const char* k_format = "sixdof-configuration-set";
constexpr std::uint64_t k_format_version = 3;
constexpr const char* k_volume_grid = "volume_grid";  ///< A group that is there if volumes have a grid of their own.

void check_grid(const Grid& grid) {
  if (grid.directions.empty() || grid.rotations.empty()) throw BadArgument("a configuration set needs a grid");
}

std::string hash_of(const SetDescription& set, const std::vector<BucketSummary>& buckets) {
  detail::FieldHash hash;
  hash.add(k_format);
  hash.add(k_format_version);
  hash.add(set.generator_version);
  hash.add(set.a);
  hash.add(set.b);
  hash.add(set.grid);
  hash.add(std::uint64_t{set.volume_grid ? 1u : 0u});
  if (set.volume_grid) hash.add(*set.volume_grid);
  for (const BucketSummary& bucket : buckets) hash.add(bucket);
  return hash.hex();
}

void check_mesh(const std::filesystem::path& file, char which, const MeshIdentity& expected, const Mesh& mesh) {
  if (expected.hash == mesh.hash()) return;
  throw BadArgument(fmt::format(
      "{}: the set was made for another mesh {}: {} ({} triangles, content hash {}), not {} ({} triangles, {})",
      file.string(), which, expected.name, expected.triangles, expected.hash, mesh.name(), mesh.triangles().size(),
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
  file.write_attribute("/", "format_version", k_format_version);
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
    if (std::isinf(s) || s < 0.0) throw BadArgument(fmt::format("bucket {}: translation {}", name, s));
  }
  const hdf5::Session session;
  state_->buckets.push_back(
      detail::write_bucket(*state_->file, std::move(summary), translations, grid.directions.size()));
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
  detail::check_format(file, path_, k_format, k_format_version, "a sixdof configuration set");
  description_.generator_version = file.read_string("/", "generator_version");
  description_.a = detail::read_identity(file, path_, "mesh_a");
  description_.b = detail::read_identity(file, path_, "mesh_b");
  description_.grid = detail::read_grid(file, path_, "/");
  if (file.exists(k_volume_grid)) description_.volume_grid = detail::read_grid(file, path_, k_volume_grid);
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

const BucketSummary& ConfigurationSet::summary(BucketKey key) const {
  const auto found = std::ranges::find(buckets_, key, &BucketSummary::key);
  if (found != buckets_.end()) return *found;
  std::vector<std::string> names;
  for (const BucketSummary& bucket : buckets_) names.push_back(bucket.key.name());
  throw BadArgument(fmt::format("{}: no bucket {}; there are {}", path_.string(), key.name(), fmt::join(names, ", ")));
}

std::vector<double> ConfigurationSet::read(BucketKey key) const {
  return detail::read_translations(path_, summary(key));
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
