#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/distance_generator.h>
#include <sixdof/configuration/grid.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// What a job remembers of a grid: make_grid(spec) makes it again.
struct GridStamp {
  std::string spec;
  std::string hash;  ///< Of the directions and rotations.

  static GridStamp of(const Grid& grid);
  bool operator==(const GridStamp&) const = default;
};

/// Everything that the values of a configuration set depend on: equal jobs give equal bits, on one machine or many.
struct GenerationJob {
  std::string program;  ///< The build that computes.
  std::string generator_version;
  std::string oracle, oracle_version;  ///< Of the distances (and of contact).
  MeshStamp a, b;
  GridStamp grid;
  std::optional<GridStamp> volume_grid;
  std::vector<BucketSummary> buckets;  ///< Ascending by key: key, target, aim and tolerance, nothing measured.

  /// @param program names the build that computes, version and commit: bits of two builds are not mixed
  /// @param distances, volumes percentages, each once
  /// @throws BadArgument
  static GenerationJob of(std::string program, const DistanceGenerator& generator, const Mesh& a, const Mesh& b,
                          const SetDescription& set, std::span<const int> distances, std::span<const int> volumes);

  bool has(BucketKind kind) const;
  std::string hash() const;
  /// What sets this job apart from another, in words; empty if nothing does.
  std::string difference(const GenerationJob& other) const;
  /// The head of the set that the job makes. @throws BadArgument if this build makes other grids of the same names
  SetDescription describe() const;
};

/// One of `count` shards, from 1.
struct ShardNumber {
  std::size_t number = 1, count = 1;
  bool operator==(const ShardNumber&) const = default;
};

/// The rotations of a grid without their repetitions, in the order in which they first stand in it.
struct DistinctRotations {
  std::vector<std::uint32_t> first;           ///< Of each distinct rotation: its first index in the grid.
  std::vector<std::uint32_t> representative;  ///< Of each rotation of the grid: the first index of its like.

  explicit DistinctRotations(std::span<const Eigen::Vector4d> rotations);

  /// A shard's part of `first`; sizes of shards differ by one at most.
  std::span<const std::uint32_t> part(ShardNumber shard) const;
};

/// @throws BadArgument unless 1 <= number <= count and every shard has a rotation of every grid of the set.
void check_shard_number(ShardNumber shard, const SetDescription& set, const GenerationJob& job);

struct ShardOptions {
  unsigned threads = 0;  ///< 0: as many as the machine has.
  /// Called now and then, one call at a time, with the configurations of a kind that this shard has so far.
  std::function<void(BucketKind kind, std::uint64_t done)> progress;
  std::function<bool()> cancelled;  ///< True ends the work with Interrupted.
};

/// Computes one shard: buckets in the job's order, with one row per distinct rotation of the shard. The bits of a row
/// depend on neither shards nor threads.
/// @param set the job's, with its grids
/// @throws what generate_distances() and generate_volumes() throw
Generated generate_shard(const GenerationJob& job, const SetDescription& set, ShardNumber shard,
                         const DistanceGenerator& generator, const Mesh& a, const Mesh& b,
                         const ShardOptions& options = {});

}  // namespace sixdof
