#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <sixdof/geometry/pose.h>
#include <sixdof/measure/latency.h>
#include <sixdof/query/algorithm.h>
#include "bench/harness/query_kind.h"
#include "bench/study/estimate.h"
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

  /// Median over the rounds of the mean time of a query, in ns, with its 95 % interval by ranks: that of the binomial
  /// distribution, which is least to largest for up to 8 rounds. At least k_least_spread wide to either side, since
  /// two runs on a machine that does other work differ by that much.
  Estimate cpu_ns() const { return median(cpu_ns_); }
  Estimate wall_ns() const { return median(wall_ns_); }

  static constexpr double k_shortest_s = 0.02;
  static constexpr double k_least_spread = 0.1;

 private:
  static Estimate median(std::vector<double> values);

  std::vector<double> cpu_ns_, wall_ns_;
};

/// Times of single queries that count: of one pass, and of the least of three (bench/harness/timing.h).
struct SingleQueries {
  Latency once, least;
  std::size_t failed = 0;  ///< Poses, counted or not, without an answer in one of the passes.
  std::string first_failure;
};
SingleQueries time_single_queries(Query& query, bench::QueryKind question, const TimedPoses& timed);

}  // namespace sixdof::study
