#include <sixdof/geometry/motion.h>

#include <cmath>
#include <cstdint>

namespace sixdof {
namespace {

struct CosSin {
  double cosine, sine;
};

/// For |x| <= pi/4 and a little more, by Taylor series; the first term left out is below 1e-20.
CosSin near_zero(double x) {
  const double s = x * x;
  double cosine = 0.0, sine = 0.0;
  for (int k = 18; k >= 2; k -= 2) {
    cosine = (1.0 - cosine) * s / (k * (k - 1));
    sine = (1.0 - sine) * s / (k * (k + 1));
  }
  return {1.0 - cosine, x - x * sine};
}

/// Sums and products in a fixed order: std::sin has other bits where the processor fuses them.
CosSin cos_sin(double angle) {
  // pi/2 in three parts, the first two of 33 bits, so that their products with the number of quarters are exact.
  constexpr double k_high = 0x1.921fb544p+0, k_middle = 0x1.0b4611a6p-34, k_low = 0x1.3198a2e037073p-69;
  const double quarters = std::floor(angle * 0x1.45f306dc9c883p-1 + 0.5);
  const double rest = ((angle - quarters * k_high) - quarters * k_middle) - quarters * k_low;
  const CosSin u = near_zero(rest);
  switch (static_cast<std::int64_t>(quarters) & 3) {
    case 0:
      return u;
    case 1:
      return {-u.sine, u.cosine};
    case 2:
      return {-u.cosine, -u.sine};
    default:
      return {u.sine, -u.cosine};
  }
}

/// exp([axis] angle) by Rodrigues' formula. @param axis unit vector
Eigen::Matrix3d rotation_about(const Eigen::Vector3d& axis, double angle) {
  // 1 - cos = 2 sin^2 of half the angle, which is accurate for small angles.
  const CosSin half = cos_sin(0.5 * angle);
  const double sine = 2.0 * half.sine * half.cosine, versine = 2.0 * half.sine * half.sine;
  Eigen::Matrix3d K;
  K << 0.0, -axis.z(), axis.y(), axis.z(), 0.0, -axis.x(), -axis.y(), axis.x(), 0.0;
  Eigen::Matrix3d K2 = axis * axis.transpose();
  K2.diagonal().array() -= axis.squaredNorm();
  return Eigen::Matrix3d::Identity() + sine * K + versine * K2;
}

}  // namespace

Motion Motion::screw(const Pose& start, const Eigen::Vector3d& point, const Eigen::Vector3d& rotation, double advance) {
  return {start, advance * rotation.normalized(), rotation, start.inverse() * point};
}

Pose Motion::pose_at(double t) const {
  if (t == 0.0) return start;
  if (is_translation()) return {start.R, start.t + t * translation};
  const double angle = rotation.norm();
  const Eigen::Matrix3d turn = rotation_about(rotation / angle, t * angle);
  const Eigen::Vector3d arm = start.R * reference;  // from the mesh frame's origin to the reference point
  return {turn * start.R, (start.t + t * translation) + (arm - turn * arm)};
}

const char* Motion::why_invalid() const {
  const bool finite = start.R.allFinite() && start.t.allFinite() && translation.allFinite() && rotation.allFinite() &&
                      reference.allFinite();
  if (!finite) return "the motion is not finite";
  if (!(rotation.norm() <= k_most_angle)) return "the motion rotates by more than a million radians";
  return nullptr;
}

std::optional<Motion> Motion::inverse(double tolerance) const {
  const double angle = rotation.norm(), distance = translation.norm();
  if (rotation.cross(translation).norm() > tolerance * angle * distance) return {};
  const Eigen::Matrix3d R_BA = start.R.transpose();
  return Motion{start.inverse(), -(R_BA * translation), -(R_BA * rotation), start * reference};
}

}  // namespace sixdof
