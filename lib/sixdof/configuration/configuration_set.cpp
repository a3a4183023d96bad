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
#include <sixdof/base/visible_text.h>
#include <sixdof/configuration/set_fields.h>

namespace sixdof {
namespace {

constexpr const char* k_format = "sixdof-configuration-set";
constexpr std::uint64_t k_format_version = 3;
constexpr const char* k_volume_grid = "volume_grid";  ///< A group that is there if volumes have a grid of their own.

std::string hash_of(const SetDescription& set, const std::vector<BucketSummary>& buckets) {
  return detail::hash_of(k_format, k_format_version, set.generator_version, set.a, set.b, set.grid, set.volume_grid,
                         buckets);
}

void check_mesh(const std::filesystem::path& file, char which, const MeshIdentity& expected, const Mesh& mesh) {
  if (expected.hash == mesh.hash()) return;
  throw BadArgument(fmt::format(
      "{}: the set was made for another mesh {}: {} ({} triangles, content hash {}), not {} ({} triangles, {})",
      file.string(), which, expected.name, expected.triangles, expected.hash, mesh.name(), mesh.triangles().size(),
      mesh.hash()));
}

}  // namespace

MeshIdentity MeshIdentity::of(const Mesh& mesh) {
  return {.name = mesh.name(),
          .hash = mesh.hash(),
          .triangles = mesh.triangles().size(),
          .box_min = mesh.box().min(),
          .box_max = mesh.box().max(),
          .volume = mesh.volume()};
}

struct ConfigurationSetWriter::State {
  State(const std::filesystem::path& path, SetDescription set) : description(std::move(set)), atomic(path) {}

  SetDescription description;
  AtomicFile atomic;
  std::optional<hdf5::File> file;
  std::vector<BucketSummary> buckets;
};

ConfigurationSetWriter::ConfigurationSetWriter(std::filesystem::path path, SetDescription description) {
  for (const BucketKind kind : {BucketKind::distance, BucketKind::volume}) {
    if (description.grid_of(kind).configurations() == 0) throw BadArgument("a configuration set needs a grid");
  }
  state_ = std::make_unique<State>(path, std::move(description));
  const SetDescription& set = state_->description;
  const hdf5::Session session;
  hdf5::File& file = state_->file.emplace(hdf5::File::create(state_->atomic));
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
  const hdf5::Session session;
  const hdf5::File file = detail::open_format(path_, k_format, k_format_version, "a sixdof configuration set");
  description_.generator_version = file.read_string("/", "generator_version");
  description_.a = detail::read_identity(file, path_, "mesh_a");
  description_.b = detail::read_identity(file, path_, "mesh_b");
  description_.grid = detail::read_grid(file, path_, "/");
  if (file.exists(k_volume_grid)) description_.volume_grid = detail::read_grid(file, path_, k_volume_grid);
  buckets_ = detail::read_summaries(file, path_);
  for (const BucketSummary& bucket : buckets_) {
    const Grid& grid = description_.grid_of(bucket.key.kind);
    const auto [rows, columns] = file.matrix_size(bucket.key.name());
    if (rows != grid.rotations.size() || columns != grid.directions.size()) {
      throw BadFile(path_.string(), bucket.key.name(),
                    fmt::format("is {} x {}, not {} rotations x {} directions", rows, columns, grid.rotations.size(),
                                grid.directions.size()));
    }
  }
  hash_ = detail::check_content_hash(file, path_, hash_of(description_, buckets_));
  // Not before: the hash is that of the words as they are. Paths stay, to be opened.
  std::vector<std::string*> words{&description_.a.name, &description_.b.name, &description_.generator_version,
                                  &description_.grid.spec, &description_.grid.sampler};
  if (description_.volume_grid)
    words.insert(words.end(), {&description_.volume_grid->spec, &description_.volume_grid->sampler});
  for (BucketSummary& bucket : buckets_) words.insert(words.end(), {&bucket.oracle, &bucket.oracle_version});
  for (std::string* const text : words) *text = visible_text(*text, k_any_length);
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
