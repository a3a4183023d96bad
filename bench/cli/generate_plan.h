#pragma once

#include <cstddef>
#include <cstdint>

#include <sixdof/configuration/set_description.h>
#include "bench/cli/generate_shards.h"

namespace sixdof::cli {

/// Prints the size of a set: grids, distinct rotations, buckets, configurations, bytes.
/// @param distances, volumes numbers of buckets
void print_counts(const SetDescription& set, std::size_t distances, std::size_t volumes);

struct EstimateRequest {
  std::size_t shards = 0;  ///< 0: a whole set in one process.
  double seconds = 5.0;    ///< Wall time for the sample.
  std::uint64_t seed = 1;
};

/// Times a seeded sample of the job's rays. Prints the estimated processor time, time and memory of the job, and the
/// sample's median, p99 and greatest processor time of a ray and its unreachable configurations.
void print_estimate(const GenerationWork& work, const EstimateRequest& request);

}  // namespace sixdof::cli
