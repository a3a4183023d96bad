#pragma once

#include <span>

namespace sixdof {

/// One cycle of a haptic loop at 1 kHz. A query that takes longer misses it.
inline constexpr double k_haptic_deadline_ns = 1e6;

/// Distribution of the times of single queries, in ns.
struct Latency {
  double mean = 0.0;
  double p50 = 0.0;
  double p99 = 0.0;
  double p999 = 0.0;
  double max = 0.0;
  double over_deadline = 0.0;  ///< Fraction of the times above k_haptic_deadline_ns, 0..1.
};

/// Quantiles by the nearest-rank rule: p99 is the smallest recorded time that at least 99 % of the times do not exceed,
/// so it is always a time that occurred; p999 of fewer than a thousand times is their maximum. All zero for no times.
/// @throws BadArgument if a time is not finite
Latency latency(std::span<const double> times_ns);

}  // namespace sixdof
