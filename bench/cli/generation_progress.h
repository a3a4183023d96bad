#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "bench/cli/progress_line.h"
#include <sixdof/configuration/generation_job.h>

namespace sixdof::cli {

/// The status line of a run that makes shards: configurations of each kind, their rate, and the time left, in which
/// each kind counts with its own rate.
class GenerationProgress {
 public:
  /// @param shards those that will be made
  GenerationProgress(const GenerationJob& job, const SetDescription& set, std::span<const ShardNumber> shards,
                     bool always);

  /// `done` configurations of a kind in the shard that is being made.
  void show(BucketKind kind, std::uint64_t done);
  void shard_done();

 private:
  using Clock = std::chrono::steady_clock;
  struct Kind {
    std::uint64_t total = 0;
    std::uint64_t before = 0;  ///< In shards that are done.
    std::uint64_t now = 0;     ///< In the one that is being made.
    double seconds = 0.0;

    std::uint64_t done() const { return before + now; }
  };

  StatusLine line_;
  std::array<Kind, 2> kinds_;  ///< By BucketKind.
  Clock::time_point last_ = Clock::now();
};

}  // namespace sixdof::cli
