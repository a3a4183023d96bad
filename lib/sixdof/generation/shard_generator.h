#pragma once

#include <sixdof/base/run_options.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/generation_job.h>
#include <sixdof/generation/distance_generator.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// Computes one shard: the job's buckets in their order, with one row per distinct rotation of the shard. The bits of a
/// row depend neither on the number of shards nor on that of threads.
/// @param set the job's description, with its grids
/// @param run a step is one configuration that is solved, those of all distances before those of the volumes
/// @throws what generate_distances() and generate_volumes() throw
Generated generate_shard(const GenerationJob& job, const SetDescription& set, ShardNumber shard,
                         const DistanceGenerator& generator, const Mesh& a, const Mesh& b, const RunOptions& run = {});

}  // namespace sixdof
