#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sixdof/results/row.h>

/// Which algorithm, with which parameters, keeps a deadline with the smallest error.

namespace sixdof::results {

struct Candidate {
  std::size_t place = 0;      ///< Among the points.
  double tail_ns = 0.0;       ///< The percentile of Choice::tail, of the least of three times of every query.
  double tail_once_ns = 0.0;  ///< The same of one pass, which other work on the machine may interrupt.
  Estimate error;
  bool keeps_deadline = false;
};

struct Choice {
  std::string tail;                 ///< "p99.9", "p99" or "max": the highest that all points have.
  std::optional<Candidate> best;    ///< The smallest error of those that keep the deadline; empty if none does.
  std::optional<Candidate> second;  ///< The next one of another algorithm.
  /// The points without a fault that would have a smaller error than the best, or all if there is no best, but miss
  /// the deadline.
  std::vector<Candidate> too_slow;
};

/// @param points rows of `sixdof precision`; those with a fault, without times of single queries or without the error
/// are left out
/// @param error the metric that is to be small
Choice choose(std::span<const Row> points, const std::string& error, double deadline_ns);

}  // namespace sixdof::results
