#pragma once

#include <cmath>

#include <Eigen/Core>

namespace sixdof {

/// Sums in a fixed order. Eigen's own reductions may sum in another order on another processor, and a model's content
/// hash must not depend on that.
inline double dot_in_order(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.x() * b.x() + a.y() * b.y() + a.z() * b.z();
}

inline double norm_in_order(const Eigen::Vector3d& a) { return std::sqrt(dot_in_order(a, a)); }

}  // namespace sixdof
