#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace sixdof::stability {

/// A case as a point of the unit cube: a random point is a sample, a moved point is a step of a search.
using Genes = std::array<double, 24>;

/// Reads quantities from genes, one gene each, in the order of the calls. The first gene is the family's sweep.
class Draw {
 public:
  explicit Draw(const Genes& genes) : genes_(genes) {}

  double unit() { return genes_[used_++ % genes_.size()]; }
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  double logarithmic(double low, double high) { return low * std::pow(high / low, unit()); }
  /// -high .. -low, 0, low .. high.
  double signed_logarithmic(double low, double high) {
    const double x = 2.0 * unit() - 1.0;
    constexpr double k_zero = 0.1;
    if (std::abs(x) < k_zero) return 0.0;
    return std::copysign(low * std::pow(high / low, (std::abs(x) - k_zero) / (1.0 - k_zero)), x);
  }
  std::size_t pick(std::size_t count) {
    const auto i = static_cast<std::size_t>(unit() * static_cast<double>(count));
    return i < count ? i : count - 1;
  }

  Eigen::Vector3d direction() {
    const double z = uniform(-1.0, 1.0), angle = uniform(0.0, 2.0 * std::numbers::pi), r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

  /// Uniform: K. Shoemake, "Uniform random rotations", Graphics Gems III (1992).
  Eigen::Quaterniond rotation() {
    const double u = unit(), v = uniform(0.0, 2.0 * std::numbers::pi), w = uniform(0.0, 2.0 * std::numbers::pi);
    const double p = std::sqrt(1.0 - u), q = std::sqrt(u);
    return {q * std::cos(w), p * std::sin(v), p * std::cos(v), q * std::sin(w)};
  }

 private:
  const Genes& genes_;
  std::size_t used_ = 0;
};

}  // namespace sixdof::stability
