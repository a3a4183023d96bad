#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include <sixdof/configuration/configuration_set.h>
#include <sixdof/configuration/generation_job.h>
#include <sixdof/generation/distance_generator.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/query/registry.h>

/// What `sixdof generate` does: plan a set (generate_plan.cpp) or make it (generate_shards.cpp).

namespace sixdof::cli {

/// A job, and what it takes to do it.
struct GenerationWork {
  const DistanceGenerator& generator;
  const Mesh& a;
  const Mesh& b;
  const SetDescription& set;
  const GenerationJob& job;
  unsigned threads = 1;
  bool progress = false;  ///< Show it where stderr is not a terminal, too.
};

/// The generator whose distances `oracle` measures: the ray cast for its own name and for an empty one, otherwise the
/// march by the distances of an algorithm. @throws BadArgument
std::unique_ptr<DistanceGenerator> generator_of(const std::string& oracle, const Registry& registry);

/// Prints the size of a set: grids, distinct rotations, buckets, configurations, bytes.
/// @param distances, volumes numbers of buckets
void print_counts(const SetDescription& set, std::size_t distances, std::size_t volumes);

/// What print_counts() prints, as an object. `sixdof generate --help` documents the keys, also of estimate_as_json().
nlohmann::ordered_json counts_as_json(const SetDescription& set, std::size_t distances, std::size_t volumes);

/// Times a seeded sample of the job's rays. Prints the estimated processor time, time and memory of the job, and the
/// sample's median, p99 and greatest processor time of a ray and its unreachable configurations.
/// @param shards 0 for a whole set in one process
/// @param seconds wall time for the sample
void print_estimate(const GenerationWork& work, std::size_t shards, double seconds, std::uint64_t seed);

/// What print_estimate() prints, as an object.
nlohmann::ordered_json estimate_as_json(const GenerationWork& work, std::size_t shards, double seconds,
                                        std::uint64_t seed);

/// Makes the whole set in memory, writes it to `output` and prints a summary.
void generate_set(const GenerationWork& work, const std::filesystem::path& output);

/// Makes shards in a folder, which is made if missing, and prints a summary.
/// @param shards how many, and the number of the one to make; 0: all
/// @param resume keep valid shards that are there; replace damaged ones, remove stale temporary files
/// @throws BadArgument for a shard of another job; BadFile, without `resume`, for any shard that is there
void generate_shards(const GenerationWork& work, const std::filesystem::path& folder, ShardNumber shards, bool resume);

}  // namespace sixdof::cli
