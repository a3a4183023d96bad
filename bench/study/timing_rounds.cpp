#include "bench/study/timing_rounds.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <sixdof/base/error.h>
#include <sixdof/query/timed_loop.h>
#include "bench/common/interrupt.h"
#include "bench/harness/timing.h"

namespace sixdof::study {
namespace {

double wall_clock_ns() {
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Mean processor and wall time of a query in its own process, in ns. Passes over the poses go on for k_shortest_s.
template <class Answer>
std::pair<double, double> time_there(RemoteQuery& remote, std::span<const Pose> poses) {
  double cpu_ns = 0.0, wall_ns = 0.0, queries = 0.0;
  for (std::size_t passes = 1; wall_ns < 1e9 * TimingRounds::k_shortest_s;) {
    const auto timed = remote.time_together<Answer>(poses, passes);
    const std::size_t answered = poses.size() - std::min(poses.size(), timed.failed.size());
    if (answered == 0) throw Error("no configuration has an answer in the timed loop");
    cpu_ns += timed.cpu_ns;
    wall_ns += timed.wall_ns;
    queries += static_cast<double>(passes * answered);
    const double left = 1e9 * TimingRounds::k_shortest_s / std::max(1.0, timed.wall_ns / static_cast<double>(passes));
    passes = static_cast<std::size_t>(left) + 1;
    InterruptGuard::check();
  }
  return {cpu_ns / queries, wall_ns / queries};
}

}  // namespace

void TimingRounds::add(Query& query, bench::QueryKind question, std::span<const Pose> poses) {
  bench::Failures ignored;
  bench::with_query_kind(query, question, ignored, [&](auto guarded) {
    if (RemoteQuery* const remote = guarded.remote()) {
      const auto [cpu_ns, wall_ns] = time_there<typename decltype(guarded)::Answer>(*remote, poses);
      cpu_ns_.push_back(cpu_ns);
      wall_ns_.push_back(wall_ns);
      return;
    }
    const double cpu_start = processor_ns(), wall_start = wall_clock_ns();
    double queries = 0.0;
    do {
      ask_all(poses.size(), [&](std::size_t i) { return guarded.ask_timed(poses[i]); });
      queries += static_cast<double>(poses.size());
      InterruptGuard::check();
    } while (wall_clock_ns() - wall_start < 1e9 * k_shortest_s);
    cpu_ns_.push_back((processor_ns() - cpu_start) / queries);
    wall_ns_.push_back((wall_clock_ns() - wall_start) / queries);
  });
}

std::size_t late_waits(std::size_t count, double wait_ns, double deadline_ns) {
  std::size_t late = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double start = wall_clock_ns();
    double took = 0.0;
    while ((took = wall_clock_ns() - start) < wait_ns) {
    }
    late += took > deadline_ns;
  }
  return late;
}

SingleQueries time_single_queries(Query& query, bench::QueryKind question, const TimedPoses& timed,
                                  double deadline_ns) {
  SingleQueries result;
  bench::Failures failures;
  bench::with_query_kind(query, question, failures, [&](auto guarded) {
    const auto [times, failed] = bench::time_latency_passes(timed.poses, guarded);
    std::vector<double> once_ns, least_ns;
    for (std::size_t i = 0; i < timed.poses.size(); ++i) {
      if (failed[i] || !timed.counts(i)) continue;
      once_ns.push_back(times.once_ns[i]);
      least_ns.push_back(times.least_ns[i]);
    }
    const auto late = std::ranges::count_if(once_ns, [&](double ns) { return ns > deadline_ns; });
    result = {.once = latency(once_ns),
              .least = latency(least_ns),
              .timed = once_ns.size(),
              .late = static_cast<std::size_t>(late),
              .failed = failures.count(),
              .first_failure = failures.first()};
  });
  if (result.once.p50 < deadline_ns && std::isfinite(deadline_ns)) {
    result.idle_late = late_waits(result.timed, result.once.p50, deadline_ns);
  }
  return result;
}

}  // namespace sixdof::study
