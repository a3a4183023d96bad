#pragma once

#include <sixdof/geometry/pose.h>

namespace sixdof {

/// Whether R is a rotation up to rounding: R^T R deviates from the identity by 1e-9 at most.
inline bool is_rotation(const Eigen::Matrix3d& R) {
  constexpr double k_tolerance = 1e-9;
  return (R.transpose() * R).isIdentity(k_tolerance) && R.determinant() > 0.0;
}

}  // namespace sixdof
