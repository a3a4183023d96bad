#pragma once

#include <cstdint>
#include <functional>

#include <sixdof/configuration/generation_job.h>
#include <sixdof/generation/distance_generator.h>

namespace sixdof {

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
