#pragma once

#include <cmath>

#include <Eigen/Core>

namespace sixdof {

/// Sums in a fixed order: Eigen's reductions depend on the processor, which a model's content hash must not.
inline double dot_in_order(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.x() * b.x() + a.y() * b.y() + a.z() * b.z();
}

inline double norm_in_order(const Eigen::Vector3d& a) { return std::sqrt(dot_in_order(a, a)); }

}  // namespace sixdof
