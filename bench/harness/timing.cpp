#include "bench/harness/timing.h"

#include <algorithm>

namespace sixdof::bench {

Latency latency_of(std::vector<std::int64_t> samples) {
  Latency latency;
  if (samples.empty()) return latency;
  std::sort(samples.begin(), samples.end());
  const std::size_t n = samples.size();
  // Nearest rank: the smallest sample that at least `permille` thousandths of all do not exceed.
  const auto rank = [&](std::size_t permille) { return samples[(permille * n + 999) / 1000 - 1]; };
  latency.p50_ns = rank(500);
  latency.p99_ns = rank(990);
  latency.p999_ns = rank(999);
  latency.max_ns = samples.back();
  const auto late = samples.end() - std::upper_bound(samples.begin(), samples.end(), k_deadline_ns);
  latency.over_1ms = static_cast<double>(late) / static_cast<double>(n);
  return latency;
}

double clock_overhead_ns() {
  constexpr std::size_t k_samples = 10'001;
  std::vector<std::int64_t> gaps(k_samples);
  for (std::int64_t& gap : gaps) {
    const auto start = Clock::now();
    gap = nanoseconds(Clock::now() - start);
  }
  std::nth_element(gaps.begin(), gaps.begin() + k_samples / 2, gaps.end());
  return static_cast<double>(gaps[k_samples / 2]);
}

}  // namespace sixdof::bench
