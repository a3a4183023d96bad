#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

/// Measured values with confidence intervals.

namespace sixdof::results {

/// A measured value with its 95 % interval.
struct Estimate {
  double value = 0.0;
  double low = 0.0, high = 0.0;

  /// A value without spread.
  static Estimate exactly(double value) { return {value, value, value}; }
};

/// Whether the intervals have a point in common.
inline bool overlap(const Estimate& a, const Estimate& b) { return a.low <= b.high && b.low <= a.high; }

/// Values up to this one are errors of rounding: they count as equal, and answers that differ by no more are the same.
inline constexpr double k_rounding = 1e-12;

/// Relative difference of the means of two runs of the same row on a machine that does other work. It is the half width
/// of the interval of a mean that was measured once, and the least half width of one that was measured in rounds.
inline constexpr double k_run_to_run = 0.10;

/// Repetitions from which an interval is estimated; fewer say too little about their spread.
inline constexpr std::size_t k_fewest_repetitions = 3;

/// The middle value, or the mean of the two in the middle. @param values at least one
double median(std::vector<double> values);

/// By linear interpolation between order statistics. @param values at least one @param share 0: least, 1: greatest
double quantile(std::vector<double> values, double share);

/// Two-sided 95 % quantile of Student's t: an interval's half width in standard errors.
double student_t95(double degrees_of_freedom);

/// Mean and variance (over n - 1) of the logarithms of values.
struct LogMoments {
  double mean = 0.0, variance = 0.0;
  double count = 0.0;
};
LogMoments log_moments(std::span<const double> values);

/// @param values at least one, above zero
double geometric_mean(std::span<const double> values);

/// The mean time of a row from that of each of its repetitions: the geometric mean with Student's interval of the
/// logarithms from k_fewest_repetitions on, the median within k_run_to_run of fewer.
/// @param times at least one, above zero
Estimate mean_of_repetitions(std::vector<double> times);

/// Median over rounds of timing with its interval by ranks (binomial, which is least to largest for up to 8 rounds), no
/// narrower than k_run_to_run to either side; zero for no rounds.
Estimate median_of_rounds(std::vector<double> times);

}  // namespace sixdof::results
