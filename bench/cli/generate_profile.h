#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "bench/cli/generate_shards.h"

namespace sixdof::cli {

struct ProfileRequest {
  /// Rotations besides those that turn an axis onto an axis, drawn by seed; all of the grid if absent.
  std::optional<std::size_t> rotations;
  std::uint64_t seed = 1;
};

/// Solves configurations of a set without keeping them, and prints how evenly the work is spread: work and processor
/// time of the median and the worst, and where it is; reachable ones by bucket.
void print_profile(const GenerationWork& work, const ProfileRequest& request);

}  // namespace sixdof::cli
