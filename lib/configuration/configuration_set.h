#pragma once

#include <atomic>
#include <compare>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <sixdof/base/atomic_file.h>
#include <sixdof/configuration/grid.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// What a bucket holds fixed: the separation (percent of A's box diagonal) or the overlap (percent of A's volume).
enum class BucketKind {
  distance,
  volume
};

std::string to_string(BucketKind kind);

struct BucketKey {
  BucketKind kind = BucketKind::distance;
  int percent = 0;

  auto operator<=>(const BucketKey&) const = default;

  /// Its dataset, and its part of a benchmark's name with ':' for '/': "distance/05", "volume/10".
  std::string name() const;
  /// The inverse of name(). @throws BadArgument
  static BucketKey parse(std::string_view name);

  /// Largest percentage a bucket may have.
  static constexpr int k_max_percent = 100;
};

/// What a set remembers of a mesh, so that it is never used with another.
struct MeshStamp {
  std::string name;
  std::string hash;  ///< Mesh::hash()
  std::uint64_t triangles = 0;
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero();
  Eigen::Vector3d box_max = Eigen::Vector3d::Zero();
  double volume = 0.0;

  static MeshStamp of(const Mesh& mesh);
  double diagonal() const { return (box_max - box_min).norm(); }
};

/// Everything that defines a set's configurations but their travel.
struct SetDescription {
  std::string generator_version;  ///< Of the program that made the set.
  MeshStamp a, b;
  Grid grid;
  std::optional<Grid> volume_grid;  ///< Of the volume buckets, where they have another; the paper's is coarser.

  const Grid& grid_of(BucketKind kind) const { return kind == BucketKind::volume && volume_grid ? *volume_grid : grid; }
};

/// One bucket but its values. Lengths in the meshes' unit, volumes in its cube.
struct BucketSummary {
  BucketKey key;
  double target = 0.0;  ///< The percentage as a distance or volume.
  /// What the configurations were solved for. It differs from `target` only in bucket 0, which is aimed just outside
  /// contact.
  double aim = 0.0;
  double tolerance = 0.0;         ///< |measured - aim| is at most this in every reachable configuration.
  double largest_residual = 0.0;  ///< The largest |measured - aim| when the set was made.
  std::uint64_t reachable = 0;    ///< Configurations whose travel is a number; filled by the writer.
  std::string oracle;             ///< What measured, e.g. "fcl-rss".
  std::string oracle_version;
  std::string hash;  ///< Content hash of the values; filled by the writer.
};

/// Writes a set, whole or not at all. The same input gives the same bytes (for one version of zlib).
class ConfigurationSetWriter {
 public:
  /// @throws BadFile if the file cannot be created; BadArgument if the grid is empty.
  ConfigurationSetWriter(std::filesystem::path path, SetDescription description);
  ~ConfigurationSetWriter();
  ConfigurationSetWriter(const ConfigurationSetWriter&) = delete;
  ConfigurationSetWriter& operator=(const ConfigurationSetWriter&) = delete;

  /// Adds a bucket.
  /// @param travel s of rotation r and direction u at [r * directions + u], NaN where unreachable.
  /// @throws BadArgument if the bucket is there already, the size is wrong, or a value is infinite or negative.
  void write(BucketSummary summary, std::span<const double> travel);

  /// Makes the file appear under its name.
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A set on disk. Opening reads the description, the grid and the summaries; values are read bucket by bucket.
/// May be used from several threads (reading is one at a time in the process).
class ConfigurationSet {
 public:
  /// @throws BadFile if the file is no configuration set, of a version this build does not know, truncated or damaged.
  explicit ConfigurationSet(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  const SetDescription& description() const { return description_; }
  const Grid& grid(BucketKind kind) const { return description_.grid_of(kind); }
  /// Distances before volumes, each by percentage.
  const std::vector<BucketSummary>& buckets() const { return buckets_; }
  /// Content hash of everything in the set: description, grid, summaries and (by their own hashes) values. It does not
  /// depend on compression.
  const std::string& hash() const { return hash_; }

  bool has(BucketKey key) const;
  /// @throws BadArgument naming the buckets there are.
  const BucketSummary& summary(BucketKey key) const;

  /// The travel s of rotation r and direction u at [r * directions + u], in the meshes' unit, NaN where unreachable.
  /// Touches no other bucket.
  /// @throws BadArgument if there is no such bucket; BadFile if it is damaged or the file has changed since opening.
  std::vector<double> read(BucketKey key) const;

  /// How many times read() has read values: shows that a benchmark reads only what it needs.
  std::size_t buckets_read() const { return buckets_read_; }

  /// @throws BadArgument if the set was made for other meshes, saying which.
  void check_meshes(const Mesh& a, const Mesh& b) const;

 private:
  std::filesystem::path path_;
  SetDescription description_;
  std::vector<BucketSummary> buckets_;
  std::string hash_;
  mutable std::atomic<std::size_t> buckets_read_{0};
};

/// True if the file begins as HDF5 files do; how commands tell a set from a mesh.
bool looks_like_configuration_set(const std::filesystem::path& path);

}  // namespace sixdof
