#pragma once

#include <string>

#include <Eigen/Core>

#include <sixdof/geometry/pose.h>

namespace sixdof {

/// A pose with the seven numbers that give it on a command line: pasting text() gives a pose with the same bits.
struct TypedPose {
  Eigen::Vector4d quaternion{1.0, 0.0, 0.0, 0.0};  ///< (w, x, y, z)
  Pose X_AB;                                       ///< Of these numbers, by Pose::from_quaternion().

  /// The typed pose nearest to another: its rotation differs by a few roundings.
  /// @throws BadArgument if a number is not finite
  static TypedPose of(const Pose& X_AB);

  /// "tx ty tz qw qx qy qz", each with as few digits as identify the double: what `sixdof query --pose` takes.
  std::string text() const;
};

}  // namespace sixdof
