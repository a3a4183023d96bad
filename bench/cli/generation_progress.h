#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <sixdof/configuration/generation_job.h>
#include <sixdof/configuration/set_description.h>
#include "bench/common/progress_line.h"

namespace sixdof::cli {

/// The status line of a run that makes shards: configurations of each kind, their rate, and the time left. Distances
/// and volumes have rates of their own.
class GenerationProgress {
 public:
  /// @param shards those that will be made, in this order
  GenerationProgress(const GenerationJob& job, const SetDescription& set, std::span<const ShardNumber> shards,
                     bool always);

  /// @param done configurations of the current shard, distances before volumes
  void show(std::uint64_t done);
  void shard_done();

 private:
  using Clock = std::chrono::steady_clock;
  /// Configurations of one kind of bucket.
  struct Kind {
    std::vector<std::uint64_t> of_shard;
    std::uint64_t total = 0;
    std::uint64_t done = 0;
    double seconds = 0.0;
  };

  StatusLine line_;
  std::array<Kind, 2> kinds_;  ///< By BucketKind.
  std::size_t shard_ = 0;
  std::uint64_t done_in_shard_ = 0;
  Clock::time_point last_ = Clock::now();
};

}  // namespace sixdof::cli
