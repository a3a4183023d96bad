#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/generation_job.h>
#include <sixdof/configuration/shard_file.h>

namespace sixdof {

/// Where the rows of a shard's bucket come from.
using ShardSource = std::function<Bucket(ShardNumber shard, BucketKey key)>;

struct AssembleOptions {
  std::function<void(std::uint64_t done, std::uint64_t total)> progress;  ///< In parts of the work, now and then.
  std::function<bool()> cancelled;                                        ///< True ends the work with Interrupted.
};

/// Writes the set that the shards of a job make, whole or not at all: every row to its rotation and to the repetitions
/// of it. Bit for bit the same file for every number of shards. Holds one bucket and one shard's part of it in memory.
/// @param set the job's, with its grids
/// @throws BadFile, Interrupted, and what `source` throws
void assemble_set(const std::filesystem::path& output, const GenerationJob& job, const SetDescription& set,
                  std::size_t shards, const ShardSource& source, const AssembleOptions& options = {});

/// The shards of a folder, by number, all of one job and every value checked. Files that are not called shard-*.h5 do
/// not matter.
/// @throws BadFile naming every shard that is missing, stands there twice, is of another job or damaged
std::vector<ShardFile> open_shards(const std::filesystem::path& folder, const AssembleOptions& options = {});

/// Makes one set of all shards of a folder. @throws what open_shards() and assemble_set() throw
void merge_shards(const std::filesystem::path& folder, const std::filesystem::path& output,
                  const AssembleOptions& options = {});

}  // namespace sixdof
