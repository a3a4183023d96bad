#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sixdof/configuration/bucket.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/grid.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// Identifies a grid in a shard: make_grid(spec) makes it again.
struct GridIdentity {
  std::string spec;
  std::string hash;  ///< Of the directions and rotations.

  static GridIdentity of(const Grid& grid);
  bool operator==(const GridIdentity&) const = default;
};

/// Everything that the values of a configuration set depend on. Equal jobs give equal bits, on one machine or many.
struct GenerationJob {
  std::string program;  ///< Version and commit of the build that computes. Shards of two builds are not merged.
  std::string generator_version;
  std::string oracle, oracle_version;  ///< The method that measures distances (and contact).
  MeshIdentity a, b;
  GridIdentity grid;
  std::optional<GridIdentity> volume_grid;
  std::vector<BucketSummary> buckets;  ///< Ascending by key, with key, nominal, target and tolerance.

  /// @param set with the identities of its meshes
  /// @param distances, volumes percentages, each once
  /// @throws BadArgument
  static GenerationJob of(std::string program, const std::string& oracle, const std::string& oracle_version,
                          const Mesh& a, const SetDescription& set, std::span<const double> distances,
                          std::span<const double> volumes);

  bool has(BucketKind kind) const;
  std::string hash() const;
  /// The differences from another job in words; empty if there are none.
  std::string difference(const GenerationJob& other) const;
  /// The description of the set that the job makes.
  /// @throws BadArgument if this build makes other grids from the same descriptions
  SetDescription describe() const;
};

/// One of `count` shards; the first has number 1.
struct ShardNumber {
  std::size_t number = 1, count = 1;
  bool operator==(const ShardNumber&) const = default;
};

/// A shard's part of a grid's distinct rotations. Sizes of shards differ by one at most.
std::span<const std::uint32_t> rotations_of(ShardNumber shard, const DistinctRotations& distinct);

/// @throws BadArgument unless 1 <= number <= count and every shard has a rotation of every grid of the set.
void check_shard_number(ShardNumber shard, const SetDescription& set, const GenerationJob& job);

}  // namespace sixdof
