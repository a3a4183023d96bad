#pragma once

#include <cstddef>
#include <filesystem>

#include <sixdof/configuration/generation_job.h>
#include <sixdof/configuration/set_description.h>
#include <sixdof/generation/distance_generator.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof::cli {

/// A job, and what it takes to do it.
struct GenerationWork {
  const DistanceGenerator& generator;
  const Mesh& a;
  const Mesh& b;
  const SetDescription& set;
  const GenerationJob& job;
  unsigned threads = 0;   ///< 0: as many as the machine has.
  bool progress = false;  ///< Show it where stderr is not a terminal, too.
};

/// Makes the whole set in memory, writes it to `output` and prints a summary.
void generate_set(const GenerationWork& work, const std::filesystem::path& output);

/// Which shards to make, and where.
struct ShardRequest {
  std::filesystem::path folder;
  std::size_t count = 1;
  std::size_t only = 0;  ///< Number of the one to make; 0: all.
  bool resume = false;   ///< Keep valid shards that are there; replace damaged ones, remove stale temporary files.
};

/// Makes shards in a folder, which is made if missing, and prints a summary.
/// @throws BadArgument for a shard of another job; BadFile, without `resume`, for any shard that is there
void generate_shards(const GenerationWork& work, const ShardRequest& request);

}  // namespace sixdof::cli
