#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/study/precision.h"

/// Which algorithm, with which parameters, keeps a deadline on a pair with the smallest error.

namespace sixdof::study {

/// What the study measured of one point, as a recommendation needs it.
struct Candidate {
  const PrecisionPoint* point = nullptr;
  double tail_ns = 0.0;       ///< The percentile of Recommendation::tail, of the least of three times of every query.
  double tail_once_ns = 0.0;  ///< The same of one pass, which other work on the machine may interrupt.
  Estimate error;
  bool keeps_deadline = false;
};

struct Recommendation {
  std::string tail;                 ///< "p99.9", "p99" or "max": the highest that the sample has enough queries for.
  std::optional<Candidate> best;    ///< The smallest error of those that keep the deadline; empty if none does.
  std::optional<Candidate> second;  ///< The next one of another algorithm.
  /// The points without a fault that would have a smaller error than the best, or all if there is no best, but miss
  /// the deadline.
  std::vector<Candidate> too_slow;
};

/// @param study was run with PrecisionPlan::single_queries; its plan's error is the metric
Recommendation recommend(const PrecisionStudy& study, double deadline_s);

}  // namespace sixdof::study
