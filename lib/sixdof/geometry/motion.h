#pragma once

#include <optional>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>

namespace sixdof {

/// A motion of B from t = 0 to t = 1, t without a unit. B's reference point moves on a straight line at constant speed,
/// and B rotates about it at constant angular velocity:
///
///     p(t) = exp(t [rotation]) R_0 (p - reference) + X_0 * reference + t translation
///
/// for a point p of B's mesh frame, where X_0 = (R_0, t_0) is the start. All vectors but `reference` are in A's frame.
/// Everything holds for a matrix R_0 that is not quite a rotation, too.
struct Motion {
  /// Largest angle (radians) for which poses are computed to k_pose_error.
  static constexpr double k_most_angle = 1e6;
  /// See pose_error(): some thirty roundings.
  static constexpr double k_pose_error = 4e-15;

  Pose start;                                             ///< X_AB at t = 0.
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< Of the reference point (length).
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< Axis times angle (radians), which may exceed pi.
  Eigen::Vector3d reference = Eigen::Vector3d::Zero();    ///< In B's mesh frame; by convention the centre of B's box.

  /// With the centre of B's box as the reference point.
  static Motion of(const Mesh& b, const Pose& start, const Eigen::Vector3d& translation,
                   const Eigen::Vector3d& rotation = Eigen::Vector3d::Zero()) {
    return {start, translation, rotation, b.center()};
  }

  /// A screw: a rotation about an axis while B moves along it.
  /// @param point of the axis, in A's frame
  /// @param rotation axis times angle (radians), not zero
  /// @param advance along the axis (length)
  static Motion screw(const Pose& start, const Eigen::Vector3d& point, const Eigen::Vector3d& rotation, double advance);

  /// X_AB at a time, usually from 0 to 1; exactly `start` at 0. The same bits on every instruction set.
  Pose pose_at(double t) const;

  /// Whether B does not rotate.
  bool is_translation() const { return rotation.isZero(0.0); }

  /// By how much a point of B that pose_at(t) moves may be off, with t rounded to a double from 0 to 1.
  /// @param reach largest distance of such a point from B's mesh origin
  double pose_error(double reach) const {
    const double arm = reach + reference.norm();
    return k_pose_error * (start.t.norm() + 2.0 * arm + translation.norm() + rotation.norm() * arm);
  }

  /// Why no pose can be computed: a NaN, an infinity, or an angle above k_most_angle. Null if nothing is wrong.
  const char* why_invalid() const;

  /// Length of the path of the reference point, plus angle times `radius`: how far points of B move at most.
  double length(double radius) const { return translation.norm() + rotation.norm() * radius; }

  /// The motion of A in B's frame while B stands still. Only translations, rotations and screws have one of this form:
  /// those whose translation is zero or along the axis, up to `tolerance` times its length. None for others.
  std::optional<Motion> inverse(double tolerance = 1e-15) const;
};

}  // namespace sixdof
