#pragma once

#include <cmath>

namespace sixdof {

/// A sum whose rounding error does not grow with the number of terms. Source: A. Neumaier, Zeitschrift für Angewandte
/// Mathematik und Mechanik 54 (1974).
class CompensatedSum {
 public:
  void operator+=(double x) {
    const double t = sum_ + x;
    compensation_ += std::abs(sum_) >= std::abs(x) ? (sum_ - t) + x : (x - t) + sum_;
    sum_ = t;
  }
  double value() const { return sum_ + compensation_; }

 private:
  double sum_ = 0.0, compensation_ = 0.0;
};

}  // namespace sixdof
