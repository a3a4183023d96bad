#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include <sixdof/base/run_options.h>
#include <sixdof/configuration/bucket.h>
#include <sixdof/configuration/generation_job.h>
#include <sixdof/configuration/set_description.h>

namespace sixdof {

/// Returns the rows of a shard's bucket.
using ShardSource = std::function<Bucket(ShardNumber shard, BucketKey key)>;

/// Writes the set that the shards of a job make, whole or not at all: every row to its rotation and to the repeats of
/// it. The bytes are the same for every number of shards. Holds one bucket and one shard's part of it in memory.
/// @param set the job's description, with its grids
/// @param run a step is one bucket of one shard; one thread is used
/// @throws BadFile, Interrupted, and what `source` throws
void assemble_set(const std::filesystem::path& output, const GenerationJob& job, const SetDescription& set,
                  std::size_t shards, const ShardSource& source, const RunOptions& run = {});

/// Makes one set of all shards of a folder. Reads and checks every file of the name shard-*.h5 before anything is
/// written, and ignores other files.
/// @param run as of assemble_set()
/// @throws BadFile naming every shard that is missing, repeated, of another job or damaged; what assemble_set() throws
void merge_shards(const std::filesystem::path& folder, const std::filesystem::path& output, const RunOptions& run = {});

}  // namespace sixdof
