#pragma once

#include <cmath>

namespace sixdof {

/// A sum that keeps what rounding drops, so that a million terms lose no digits (Neumaier 1974).
class CompensatedSum {
 public:
  void operator+=(double x) {
    const double t = sum_ + x;
    rest_ += std::abs(sum_) >= std::abs(x) ? (sum_ - t) + x : (x - t) + sum_;
    sum_ = t;
  }
  double value() const { return sum_ + rest_; }

 private:
  double sum_ = 0.0, rest_ = 0.0;
};

}  // namespace sixdof
