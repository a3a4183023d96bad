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
#include <sixdof/query/timed_loop.h>
#include "bench/harness/cache_eviction.h"
#include "bench/harness/counted_loop.h"
#include "bench/harness/guarded_query.h"

/// How queries are timed. The functions are templates on the question, so that the timed loops contain nothing but the
/// query. Queries in a process of their own are timed there, by the same loops (query/timed_loop.h).

namespace sixdof::bench {

/// Times of single queries, by wall clock.
struct SingleTimes {
  /// Of the first pass: caches are in whatever state the query before left them, and other work on the machine may
  /// interrupt.
  Latency once;
  /// Of the least of k_latency_passes times of every query: interruptions rarely meet the same query in every pass.
  Latency least;
  /// Places of the longest times of each among the poses; 0 for no poses.
  std::size_t slowest_once = 0, slowest_least = 0;
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

/// Counter by which a row hands the processor time of a query, in ns, to RowReporter: Google Benchmark's own is that of
/// this process.
inline constexpr const char* k_processor_inside = "processor_inside_ns";

/// The timed loop of a row: whole rounds over all poses, so that the mean is over all of them. One iteration is one
/// query. Rows of isolated algorithms set the time by hand (PlannedRow::manual_time).
template <class Ask>
void time_mean(benchmark::State& state, std::span<const Pose> poses, GuardedQuery<Ask> query) {
  const auto round = static_cast<benchmark::IterationCount>(poses.size());
  if (RemoteQuery* const remote = query.remote()) {
    const auto rounds = std::max<benchmark::IterationCount>(1, (state.max_iterations + round - 1) / round);
    while (state.KeepRunningBatch(round * rounds)) {
      const auto timed =
          remote->time_together<typename GuardedQuery<Ask>::Answer>(poses, static_cast<std::size_t>(rounds));
      query.count(poses, timed.failed);
      if (timed.failed.size() >= poses.size()) throw Error("no configuration has an answer in the timed loop");
      const double of_all = static_cast<double>(poses.size()) / static_cast<double>(poses.size() - timed.failed.size());
      state.SetIterationTime(1e-9 * timed.wall_ns * of_all);
      state.counters[k_processor_inside] = timed.cpu_ns * of_all / static_cast<double>(round * rounds);
    }
    return;
  }
  const CountedLoop counted;
  while (state.KeepRunningBatch(round)) {
    ask_all(poses.size(), [&](std::size_t i) { return query.ask_timed(poses[i]); });
  }
}

/// Asks with a clock around the query. @returns the examined answer and the wall time in ns
template <class Ask>
auto ask_with_clock(const Pose& pose, GuardedQuery<Ask>& query) {
  auto [answer, took_ns] = with_clock([&] { return query.ask_timed(pose); });
  query.examine(pose, answer);
  return std::pair(answer, query.remote() == nullptr ? took_ns : query.remote()->last_ns());
}

/// Times of k_latency_passes passes, and which poses have no answer in one of them.
template <class Ask>
std::pair<PassTimes, std::vector<bool>> time_latency_passes(const std::vector<Pose>& poses, GuardedQuery<Ask>& query) {
  std::vector<bool> failed(poses.size());
  if (RemoteQuery* const remote = query.remote()) {
    auto timed = remote->time_each<typename GuardedQuery<Ask>::Answer>(poses, k_latency_passes);
    query.count(poses, timed.failed);
    for (const protocol::Failed& each : timed.failed) failed[each.place] = true;
    return {{std::move(timed.once_ns), std::move(timed.least_ns)}, std::move(failed)};
  }
  PassTimes times = time_passes(
      poses.size(), k_latency_passes, [](std::size_t) {}, [&](std::size_t i) { return query.ask_timed(poses[i]); },
      [&](std::size_t i, auto& answer) {
        query.examine(poses[i], answer);
        if (!answer.ok()) failed[i] = true;
      });
  return {std::move(times), std::move(failed)};
}

/// Poses that fail in any pass are removed.
template <class Ask>
SingleTimes time_each(std::vector<Pose>& poses, GuardedQuery<Ask> query) {
  auto [times, failed] = time_latency_passes(poses, query);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (failed[i]) continue;
    poses[kept] = poses[i];
    times.once_ns[kept] = times.once_ns[i];
    times.least_ns[kept++] = times.least_ns[i];
  }
  poses.resize(kept);
  times.once_ns.resize(kept);
  times.least_ns.resize(kept);
  const auto place_of_largest = [](const std::vector<double>& ns) {
    return static_cast<std::size_t>(std::ranges::max_element(ns) - ns.begin());
  };
  return {latency(times.once_ns), latency(times.least_ns), place_of_largest(times.once_ns),
          place_of_largest(times.least_ns)};
}

/// One round on cold caches in the process of an isolated algorithm. @returns times without those that failed
template <class Ask>
std::vector<double> time_cold_there(benchmark::State& state, std::span<const Pose> poses, GuardedQuery<Ask>& query,
                                    RemoteQuery& remote) {
  const auto timed = remote.time_each<typename GuardedQuery<Ask>::Answer>(poses, 1, eviction_bytes());
  query.count(poses, timed.failed);
  std::vector<bool> failed(poses.size());
  for (const protocol::Failed& each : timed.failed) failed[each.place] = true;
  std::vector<double> times_ns;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (failed[i]) continue;
    state.SetIterationTime(1e-9 * timed.once_ns[i]);
    times_ns.push_back(timed.once_ns[i]);
  }
  return times_ns;
}

/// The timed loop of a row on cold caches: one round over all poses, with `evict` before each query; in the process of
/// an isolated algorithm a buffer of the same size. Times are set by hand: Google Benchmark's own clocks are system
/// calls, which take as long as a query when nothing is in the caches.
/// @returns times of single queries, without those that failed
template <class Ask, class Evict>
Latency time_cold(benchmark::State& state, std::span<const Pose> poses, GuardedQuery<Ask> query, Evict& evict) {
  std::vector<double> times_ns;
  const auto round = static_cast<benchmark::IterationCount>(poses.size());
  while (state.KeepRunningBatch(round)) {
    if (RemoteQuery* const remote = query.remote()) {
      times_ns = time_cold_there(state, poses, query, *remote);
      continue;
    }
    for (const Pose& pose : poses) {
      evict();
      const auto [answer, took_ns] = ask_with_clock(pose, query);
      state.SetIterationTime(1e-9 * took_ns);
      if (answer.ok()) times_ns.push_back(took_ns);
    }
  }
  return latency(times_ns);
}

/// The timed loop of a row that asks(i) for casts, contacts or depths at each of `count` places: whole rounds. Of a
/// process of its own the time is the one that it says (PlannedRow::manual_time).
template <class Ask>
void time_rounds(benchmark::State& state, std::size_t count, Query& query, const Ask& ask) {
  RemoteQuery* const remote = as_remote(query);
  while (state.KeepRunningBatch(static_cast<benchmark::IterationCount>(count))) {
    double inside_ns = 0.0;
    ask_all(count, [&](std::size_t i) {
      auto answer = ask(i);
      if (remote != nullptr) inside_ns += remote->last_ns();
      return answer;
    });
    if (remote != nullptr) state.SetIterationTime(1e-9 * inside_ns);
  }
}

/// Times of single queries of such a row, in k_latency_passes passes.
template <class Ask>
PassTimes time_singles(std::size_t count, Query& query, const Ask& ask) {
  RemoteQuery* const remote = as_remote(query);
  PassTimes inside{std::vector<double>(count), std::vector<double>(count)};
  std::size_t asked = 0;
  PassTimes outside = time_passes(
      count, k_latency_passes, [](std::size_t) {}, ask,
      [&](std::size_t i, const auto&) {
        if (remote == nullptr) return;
        const double ns = remote->last_ns();
        const bool is_first = asked++ < count;
        if (is_first) inside.once_ns[i] = ns;
        inside.least_ns[i] = is_first ? ns : std::min(inside.least_ns[i], ns);
      });
  return remote == nullptr ? outside : inside;
}

/// Seconds that ask(place) takes on average over the first places, until a tenth of `seconds` is over; 0 for no place.
template <class List, class Ask>
double seconds_of_one(const List& places, double seconds, const Ask& ask) {
  const auto start = std::chrono::steady_clock::now();
  const auto passed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  std::size_t asked = 0;
  for (const auto& place : places) {
    static_cast<void>(ask(place));
    ++asked;
    if (passed() > 0.1 * seconds) break;
  }
  return asked == 0 ? 0.0 : passed() / static_cast<double>(asked);
}

}  // namespace sixdof::bench
