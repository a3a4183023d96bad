#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <span>
#include <vector>

#include <benchmark/benchmark.h>

#include <sixdof/geometry/pose.h>
#include <sixdof/measure/latency.h>
#include "bench/harness/guarded_query.h"

/// How queries are timed. The functions are templates on the question, so that the timed loops contain nothing but the
/// query.

namespace sixdof::bench {

/// The time of a query is the least of this many passes over the bucket: interruptions by other work on the machine
/// rarely meet the same query in every pass. Each pass visits all poses, since the same pose twice in a row is the best
/// case of a warm start.
constexpr int k_latency_passes = 3;

/// Time between two successive readings of the clock in ns (median of many). The time of every query contains it.
inline double clock_overhead_ns() {
  using Clock = std::chrono::steady_clock;
  constexpr std::size_t k_gaps = 10'001;
  std::vector<double> gaps_ns(k_gaps);
  for (double& gap_ns : gaps_ns) {
    const auto start = Clock::now();
    gap_ns = std::chrono::duration<double, std::nano>(Clock::now() - start).count();
  }
  std::nth_element(gaps_ns.begin(), gaps_ns.begin() + k_gaps / 2, gaps_ns.end());
  return gaps_ns[k_gaps / 2];
}

/// The timed loop of a row: whole rounds over all poses, so that the mean is over all of them. One iteration is one
/// query.
template <class Ask>
void time_mean(benchmark::State& state, std::span<const Pose> poses, GuardedQuery<Ask> query) {
  const auto round = static_cast<benchmark::IterationCount>(poses.size());
  while (state.KeepRunningBatch(round)) {
    for (const Pose& pose : poses) {
      auto answer = query.ask_timed(pose);
      benchmark::DoNotOptimize(answer);
    }
  }
}

/// The distribution of the times of single queries, by wall clock. Poses that fail in any pass are removed.
template <class Ask>
Latency time_each(std::vector<Pose>& poses, GuardedQuery<Ask> query) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> least_ns(poses.size());
  std::vector<bool> failed(poses.size());
  for (int pass = 0; pass < k_latency_passes; ++pass) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const auto start = Clock::now();
      auto answer = query.ask_timed(poses[i]);
      benchmark::DoNotOptimize(answer);
      const auto stop = Clock::now();
      const double took_ns = std::chrono::duration<double, std::nano>(stop - start).count();
      if (pass == 0 || took_ns < least_ns[i]) least_ns[i] = took_ns;
      query.examine(poses[i], answer);
      if (!answer.ok()) failed[i] = true;
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (failed[i]) continue;
    poses[kept] = poses[i];
    least_ns[kept++] = least_ns[i];
  }
  poses.resize(kept);
  least_ns.resize(kept);
  return latency(least_ns);
}

}  // namespace sixdof::bench
