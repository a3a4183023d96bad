#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace sixdof {

/// A rigid motion p -> R p + t. `X_AB` maps points of B's mesh frame to A's mesh frame, in the meshes' length unit.
struct Pose {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  ///< A rotation matrix; not checked.
  Eigen::Vector3d t = Eigen::Vector3d::Zero();      ///< Length.

  /// Largest difference of a quaternion's norm from 1: the rounding of components printed with seven digits.
  static constexpr double k_unit_norm_tolerance = 1e-6;

  /// From a unit quaternion (w, x, y, z), normalised here, and a translation. The matrices of rotations by multiples of
  /// 90 degrees about the axes have entries of exactly 0, 1 and -1.
  /// @throws BadArgument if a value is not finite or the norm differs from 1 by more than k_unit_norm_tolerance.
  static Pose from_quaternion(double w, double x, double y, double z, const Eigen::Vector3d& t);

  /// R p + t: a point of B's frame in A's frame.
  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return R * p + t; }

  /// Composition: (X_AB * X_BC) maps C to A.
  Pose operator*(const Pose& next) const { return {R * next.R, R * next.t + t}; }

  /// X_BA of an X_AB.
  Pose inverse() const { return {R.transpose(), -(R.transpose() * t)}; }

  /// Unit quaternion (w, x, y, z) with w >= 0.
  Eigen::Vector4d quaternion() const;
};

}  // namespace sixdof
