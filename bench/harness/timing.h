#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <sixdof/geometry/pose.h>
#include <sixdof/measure/latency.h>
#include "bench/harness/guarded_query.h"

/// How queries are timed. The functions are templates on the question, so that the timed loops contain nothing but the
/// query.

namespace sixdof::bench {

/// Passes over the poses that time single queries. Each visits all poses, since the same pose twice in a row is the
/// best case of a warm start.
constexpr int k_latency_passes = 3;

/// Times of single queries, by wall clock.
struct SingleTimes {
  /// Of the first pass: caches are in whatever state the query before left them, and other work on the machine may
  /// interrupt.
  Latency once;
  /// Of the least of k_latency_passes times of every query: interruptions rarely meet the same query in every pass.
  Latency least;
};

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

/// Asks with a clock around the query. @returns the examined answer and the wall time in ns
template <class Ask>
auto ask_with_clock(const Pose& pose, GuardedQuery<Ask>& query) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  auto answer = query.ask_timed(pose);
  benchmark::DoNotOptimize(answer);
  const auto stop = Clock::now();
  query.examine(pose, answer);
  return std::pair(answer, std::chrono::duration<double, std::nano>(stop - start).count());
}

/// Poses that fail in any pass are removed.
template <class Ask>
SingleTimes time_each(std::vector<Pose>& poses, GuardedQuery<Ask> query) {
  std::vector<double> once_ns(poses.size()), least_ns(poses.size());
  std::vector<bool> failed(poses.size());
  for (int pass = 0; pass < k_latency_passes; ++pass) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const auto [answer, took_ns] = ask_with_clock(poses[i], query);
      if (pass == 0) once_ns[i] = took_ns;
      least_ns[i] = pass == 0 ? took_ns : std::min(least_ns[i], took_ns);
      if (!answer.ok()) failed[i] = true;
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (failed[i]) continue;
    poses[kept] = poses[i];
    once_ns[kept] = once_ns[i];
    least_ns[kept++] = least_ns[i];
  }
  poses.resize(kept);
  once_ns.resize(kept);
  least_ns.resize(kept);
  return {latency(once_ns), latency(least_ns)};
}

/// The timed loop of a row on cold caches: one round over all poses, with `evict` before each query. Times are set by
/// hand: Google Benchmark's own clocks are system calls, which take as long as a query when nothing is in the caches.
/// @returns times of single queries, without those that failed
template <class Ask, class Evict>
Latency time_cold(benchmark::State& state, std::span<const Pose> poses, GuardedQuery<Ask> query, Evict& evict) {
  std::vector<double> times_ns;
  const auto round = static_cast<benchmark::IterationCount>(poses.size());
  while (state.KeepRunningBatch(round)) {
    for (const Pose& pose : poses) {
      evict();
      const auto [answer, took_ns] = ask_with_clock(pose, query);
      state.SetIterationTime(1e-9 * took_ns);
      if (answer.ok()) times_ns.push_back(took_ns);
    }
  }
  return latency(times_ns);
}

}  // namespace sixdof::bench
