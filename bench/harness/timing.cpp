#include "bench/harness/timing.h"

namespace sixdof::bench {

double clock_overhead_ns() {
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

}  // namespace sixdof::bench
