#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace sixdof {

/// One cycle of a haptic loop at 1 kHz. A query that takes longer misses it.
inline constexpr double k_haptic_deadline_ns = 1e6;

/// Fewest times for a p99: at least two times lie above the percentile. So it is neither the maximum nor
/// a single query that other work on the machine interrupted.
inline constexpr std::size_t k_fewest_for_p99 = 200;
/// Likewise for a p999.
inline constexpr std::size_t k_fewest_for_p999 = 2000;

/// Distribution of the times of single queries, in ns.
struct Latency {
  double mean = 0.0;           ///< Arithmetic mean.
  double p10 = 0.0;            ///< 10th percentile.
  double p25 = 0.0;            ///< 25th percentile.
  double p50 = 0.0;            ///< Median.
  double p75 = 0.0;            ///< 75th percentile.
  double p90 = 0.0;            ///< 90th percentile.
  std::optional<double> p99;   ///< Empty for fewer than k_fewest_for_p99 times.
  std::optional<double> p999;  ///< Empty for fewer than k_fewest_for_p999 times.
  double max = 0.0;            ///< Longest time.
  double over_deadline = 0.0;  ///< Fraction of the times above k_haptic_deadline_ns, 0..1.
};

/// Quantiles by the nearest-rank rule: p99 is the smallest recorded time that at least 99 % of the times do not exceed,
/// so it is always a time that occurred. All zero for no times.
/// @throws BadArgument if a time is not finite
Latency latency(std::span<const double> times_ns);

}  // namespace sixdof
