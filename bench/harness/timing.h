#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <benchmark/benchmark.h>

#include <sixdof/geometry/pose.h>

/// How queries are timed. Everything here is a template on the question (a callable Pose -> Outcome), so that nothing
/// but the query itself stands in the timed loops.

namespace sixdof::bench {

using Clock = std::chrono::steady_clock;

inline std::int64_t nanoseconds(Clock::duration d) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(d).count();
}

/// The haptic deadline: a query that takes longer breaks a 1 kHz loop.
constexpr std::int64_t k_deadline_ns = 1'000'000;

/// Each query's own time is the least of this many passes over the bucket: the interruptions of a machine that does
/// other things as well hardly hit the same query every time. Whole passes and not one query several times over, since
/// a repeated pose is the best case of every warm start.
constexpr int k_latency_passes = 3;

/// Distribution of single queries' times.
struct Latency {
  std::int64_t p50_ns = 0;
  std::int64_t p99_ns = 0;
  std::int64_t p999_ns = 0;
  std::int64_t max_ns = 0;
  double over_1ms = 0.0;  ///< Share of queries beyond the haptic deadline, 0..1.
};

/// Nearest-rank percentiles: p999 of fewer than a thousand queries is their maximum. All zero for no samples.
Latency latency_of(std::vector<std::int64_t> samples);

/// What reading the clock twice in a row shows, in ns (median of many): contained in every single query's time.
double clock_overhead_ns();

/// The timed loop: whole rounds over all poses, so that the mean is over the bucket and not over a part of it. One
/// iteration is one query.
template <class Ask>
void time_mean(benchmark::State& state, std::span<const Pose> poses, Ask ask) {
  const auto round = static_cast<benchmark::IterationCount>(poses.size());
  while (state.KeepRunningBatch(round)) {
    for (const Pose& pose : poses) {
      auto answer = ask(pose);
      benchmark::DoNotOptimize(answer);
    }
  }
}

/// Every query timed by itself.
template <class Ask>
Latency time_each(std::span<const Pose> poses, Ask ask) {
  std::vector<std::int64_t> least(poses.size());
  for (int pass = 0; pass < k_latency_passes; ++pass) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const auto start = Clock::now();
      auto answer = ask(poses[i]);
      benchmark::DoNotOptimize(answer);
      const std::int64_t took = nanoseconds(Clock::now() - start);
      if (pass == 0 || took < least[i]) least[i] = took;
    }
  }
  return latency_of(std::move(least));
}

}  // namespace sixdof::bench
