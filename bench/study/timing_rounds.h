#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <sixdof/geometry/pose.h>
#include <sixdof/measure/latency.h>
#include <sixdof/query/algorithm.h>
#include <sixdof/results/estimate.h>
#include "bench/harness/query_kind.h"
#include "bench/study/study_sample.h"

namespace sixdof::study {

/// Times of one point of a study. Its rounds lie minutes apart, with rounds of other points between them, so that slow
/// changes of the machine's speed affect all points alike.
class TimingRounds {
 public:
  /// Asks all poses, which have an answer, as often as k_shortest_s needs, in a loop without clocks. @throws
  /// Interrupted
  void add(Query& query, bench::QueryKind question, std::span<const Pose> poses);

  std::size_t count() const { return cpu_ns_.size(); }

  /// The mean time of a query in ns (results::median_of_rounds).
  results::Estimate cpu_ns() const { return results::median_of_rounds(cpu_ns_); }
  results::Estimate wall_ns() const { return results::median_of_rounds(wall_ns_); }

  static constexpr double k_shortest_s = 0.02;

 private:
  std::vector<double> cpu_ns_, wall_ns_;
};

/// How many of `count` waits of wait_ns, in a loop that does nothing else, took longer than the deadline: other work on
/// the machine interrupted them.
std::size_t late_waits(std::size_t count, double wait_ns, double deadline_ns);

/// Times of single queries that count: of one pass, and of the least of three (bench/harness/timing.h).
struct SingleQueries {
  Latency once, least;
  std::size_t timed = 0;      ///< Queries whose times count,
  std::size_t late = 0;       ///< those over the deadline in the first pass,
  std::size_t idle_late = 0;  ///< and how many waits of their median time, as many, took longer than the deadline.
  std::size_t failed = 0;     ///< Poses, counted or not, without an answer in one of the passes.
  std::string first_failure;
};
SingleQueries time_single_queries(Query& query, bench::QueryKind question, const TimedPoses& timed, double deadline_ns);

}  // namespace sixdof::study
