#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include <sixdof/query/registry.h>
#include <sixdof/generation/distance_generator.h>
#include <sixdof/configuration/generation_job.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof::cli {

/// A job with all that it takes to do it.
struct GenerationWork {
  const DistanceGenerator& generator;
  const Mesh& a;
  const Mesh& b;
  const SetDescription& set;
  const GenerationJob& job;
  unsigned threads = 0;   ///< 0: as many as the machine has.
  bool progress = false;  ///< Show it where stderr is no terminal, too.
};

/// Makes the whole set in memory and writes it to `output`. Prints what it did.
void generate_set(const GenerationWork& work, const std::filesystem::path& output);

/// Which shards to make, and where.
struct ShardRequest {
  std::filesystem::path folder;
  std::size_t count = 1;
  std::size_t only = 0;  ///< The number of the one to make; 0: all, in turn.
  bool resume = false;   ///< Shards that are there and sound stay, damaged ones and stale temporary files go.
};

/// Makes shards in a folder, which is made if missing. Prints what it did.
/// @throws BadFile for a shard of another job, or, without `resume`, any that is there
void generate_shards(const GenerationWork& work, const ShardRequest& request);

}  // namespace sixdof::cli
