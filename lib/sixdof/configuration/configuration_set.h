#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <sixdof/configuration/bucket.h>
#include <sixdof/configuration/grid.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// Identifies a mesh in a set, so that the set is never used with another one.
struct MeshIdentity {
  std::string name;                                   ///< Mesh::name()
  std::string hash;                                   ///< Mesh::hash()
  std::uint64_t triangles = 0;                        ///< How many it has.
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero();  ///< Lower corner of Mesh::box(), in the mesh's frame (length).
  Eigen::Vector3d box_max = Eigen::Vector3d::Zero();  ///< Upper corner.
  double volume = 0.0;                                ///< Mesh::volume() (length^3).
  /// Where a mesh that is no model of the catalogue was when the set was made, as the user wrote it; empty for a model.
  /// No part of content hashes: the same mesh may lie anywhere (set_meshes.h).
  std::string path;
  std::string absolute_path;  ///< The same, absolute.

  /// That of a mesh, without paths.
  static MeshIdentity of(const Mesh& mesh);
  /// Length of the box's diagonal.
  double diagonal() const { return (box_max - box_min).norm(); }
};

/// Everything that defines the configurations of a set but their translations.
struct SetDescription {
  std::string generator_version;    ///< Version of the program that made the set.
  MeshIdentity a;                   ///< The fixed mesh.
  MeshIdentity b;                   ///< The moving mesh.
  Grid grid;                        ///< Of the distance buckets, and of the volume buckets unless they have their own.
  std::optional<Grid> volume_grid;  ///< Grid of the volume buckets, if it is not `grid`; the paper's is coarser.

  /// The grid of the buckets of a kind.
  const Grid& grid_of(BucketKind kind) const { return kind == BucketKind::volume && volume_grid ? *volume_grid : grid; }
};

/// Writes a set, whole or not at all. The same input gives the same bytes (for one version of zlib).
class ConfigurationSetWriter {
 public:
  /// @throws BadFile if the file cannot be created; BadArgument if the grid is empty.
  ConfigurationSetWriter(std::filesystem::path path, SetDescription description);
  /// Without commit() nothing is left of the file.
  ~ConfigurationSetWriter();
  ConfigurationSetWriter(const ConfigurationSetWriter&) = delete;
  ConfigurationSetWriter& operator=(const ConfigurationSetWriter&) = delete;

  /// Adds a bucket. @param translations s of rotation r and direction u at [r * directions + u], NaN where unreachable
  /// @throws BadArgument if the bucket is there already, the size is wrong, or a value is infinite or negative.
  void write(BucketSummary summary, std::span<const double> translations);

  /// Makes the file appear under its name. @throws BadFile if it cannot be written whole
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A set on disk. Opening reads the description, the grids and the summaries; values are read bucket by bucket.
/// May be used from several threads (reads are serialized in the process).
class ConfigurationSet {
 public:
  /// @throws BadFile if the file is not a configuration set, is of another format version, truncated or damaged.
  explicit ConfigurationSet(std::filesystem::path path);

  /// The file, as it was named.
  const std::filesystem::path& path() const { return path_; }
  /// Meshes and grids.
  const SetDescription& description() const { return description_; }
  /// The grid of the buckets of a kind.
  const Grid& grid(BucketKind kind) const { return description_.grid_of(kind); }
  /// Distances before volumes, each by percentage.
  const std::vector<BucketSummary>& buckets() const { return buckets_; }
  /// Content hash of everything in the set: description, grids, summaries and (by their own hashes) values. It does not
  /// depend on compression.
  const std::string& hash() const { return hash_; }

  /// Everything about a bucket but its values.
  /// @throws BadArgument naming the buckets of the set if this is none of them.
  const BucketSummary& summary(BucketKey key) const;

  /// The translation s of rotation r and direction u at [r * directions + u], in the meshes' length unit, NaN where
  /// unreachable. Reads no other bucket.
  /// @throws BadArgument if there is no such bucket; BadFile if it is damaged or the file has changed since opening.
  std::vector<double> read(BucketKey key) const;

  /// @throws BadArgument if the set was made for other meshes, saying which.
  void check_meshes(const Mesh& a, const Mesh& b) const;

 private:
  std::filesystem::path path_;
  SetDescription description_;
  std::vector<BucketSummary> buckets_;
  std::string hash_;
};

/// True if the file begins with HDF5's signature. Commands tell a set from a mesh by it.
bool looks_like_configuration_set(const std::filesystem::path& path);

}  // namespace sixdof
