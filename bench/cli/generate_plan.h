#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bench/cli/generate_shards.h"
#include <sixdof/configuration/configuration_set.h>

namespace sixdof::cli {

/// Prints what a job consists of: grids, distinct rotations, buckets, configurations, bytes.
void print_counts(const SetDescription& set, std::size_t distances, std::size_t volumes);

/// The buckets of one kind in the order in which a ray meets them: distances from far to near, volumes from contact
/// inwards.
std::vector<BucketSummary> buckets_in_order(const GenerationJob& job, BucketKind kind);

struct EstimateRequest {
  std::size_t shards = 0;  ///< 0: a whole set in one process.
  double seconds = 5.0;    ///< For the sample.
  std::uint64_t seed = 1;
};

/// Times a seeded sample of the real work and prints what the whole would take: CPU time, time, memory.
void print_estimate(const GenerationWork& work, const EstimateRequest& request);

}  // namespace sixdof::cli
