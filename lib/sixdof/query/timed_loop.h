#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <utility>
#include <vector>

/// The timed loops, used by the rows of sixdof-bench and by the process of an isolated algorithm (process/serve.h).

namespace sixdof {

/// Passes over the poses that time single queries. Each visits all poses, since the same pose twice in a row is the
/// best case of a warm start.
inline constexpr int k_latency_passes = 3;

/// Keeps the compiler from leaving out the computation of `value`.
template <class T>
void keep(T& value) {
  asm volatile("" : "+m"(value) : : "memory");
}

/// Processor time of all threads of this process in ns.
inline double processor_ns() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

/// Calls ask(i) for i < count, in order, without clocks.
template <class Ask>
void ask_all(std::size_t count, Ask&& ask) {
  for (std::size_t i = 0; i < count; ++i) {
    auto answer = ask(i);
    keep(answer);
  }
}

/// Calls ask() with a clock around it. @returns its answer and the wall time in ns
template <class Ask>
auto with_clock(Ask&& ask) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  auto answer = ask();
  keep(answer);
  const auto stop = Clock::now();
  return std::pair(std::move(answer), std::chrono::duration<double, std::nano>(stop - start).count());
}

/// Times of single queries in ns, by wall clock; one entry for each pose.
struct PassTimes {
  std::vector<double> once_ns;   ///< Of the first pass.
  std::vector<double> least_ns;  ///< Of the least of all passes.
};

/// Passes over `count` poses with a clock around each query. before(i) and after(i, answer) are outside of the clock.
template <class Before, class Ask, class After>
PassTimes time_passes(std::size_t count, int passes, Before&& before, Ask&& ask, After&& after) {
  PassTimes times{std::vector<double>(count), std::vector<double>(count)};
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t i = 0; i < count; ++i) {
      before(i);
      auto [answer, took_ns] = with_clock([&] { return ask(i); });
      if (pass == 0) times.once_ns[i] = took_ns;
      times.least_ns[i] = pass == 0 ? took_ns : std::min(times.least_ns[i], took_ns);
      after(i, answer);
    }
  }
  return times;
}

}  // namespace sixdof
