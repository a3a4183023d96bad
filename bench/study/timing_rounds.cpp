#include "bench/study/timing_rounds.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <utility>

#include <benchmark/benchmark.h>

#include "bench/common/interrupt.h"
#include "bench/harness/timing.h"

namespace sixdof::study {
namespace {

double thread_ns() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

double wall_clock_ns() {
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Ranks, from 0, of the interval of the median of n values: between them it lies with a probability of at least 95 %
/// (for n < 6 with that of least to largest).
std::pair<std::size_t, std::size_t> ranks_of_median(std::size_t n) {
  std::size_t rank = 0;
  double below = 0.0, probability = std::pow(0.5, static_cast<double>(n));  // of no value below the median
  while (2 * (rank + 1) < n) {
    below += probability;
    probability *= static_cast<double>(n - rank) / static_cast<double>(rank + 1);
    if (2.0 * (below + probability) > 0.05) break;
    ++rank;
  }
  return {rank, n - 1 - rank};
}

}  // namespace

void TimingRounds::add(Query& query, bench::Question question, std::span<const Pose> poses) {
  bench::Failures ignored;
  bench::with_question(query, question, ignored, [&](auto guarded) {
    const double cpu_start = thread_ns(), wall_start = wall_clock_ns();
    double queries = 0.0;
    do {
      for (const Pose& pose : poses) {
        auto answer = guarded.ask_timed(pose);
        benchmark::DoNotOptimize(answer);
      }
      queries += static_cast<double>(poses.size());
      InterruptGuard::check();
    } while (wall_clock_ns() - wall_start < 1e9 * k_shortest_s);
    cpu_ns_.push_back((thread_ns() - cpu_start) / queries);
    wall_ns_.push_back((wall_clock_ns() - wall_start) / queries);
  });
}

Estimate TimingRounds::median(std::vector<double> values) {
  if (values.empty()) return {};
  std::ranges::sort(values);
  const std::size_t n = values.size();
  const double middle = n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
  const auto [low, high] = ranks_of_median(n);
  return {middle, std::min(values[low], (1.0 - k_least_spread) * middle),
          std::max(values[high], (1.0 + k_least_spread) * middle)};
}

SingleQueries time_single_queries(Query& query, bench::Question question, std::vector<Pose> poses) {
  SingleQueries result;
  bench::Failures ignored;
  bench::with_question(query, question, ignored, [&](auto guarded) {
    const bench::SingleTimes times = bench::time_each(poses, guarded);
    result = {times.once, times.least};
  });
  return result;
}

}  // namespace sixdof::study
