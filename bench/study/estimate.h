#pragma once

namespace sixdof::study {

/// A measured value with its 95 % interval.
struct Estimate {
  double value = 0.0;
  double low = 0.0, high = 0.0;

  /// A value without spread.
  static Estimate exactly(double value) { return {value, value, value}; }
};

/// Whether the intervals have a point in common.
inline bool overlap(const Estimate& a, const Estimate& b) { return a.low <= b.high && b.low <= a.high; }

}  // namespace sixdof::study
