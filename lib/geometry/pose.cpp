#include <sixdof/geometry/pose.h>

#include <cmath>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {

Pose Pose::from_quaternion(double w, double x, double y, double z, const Eigen::Vector3d& t) {
  if (!t.allFinite() || !std::isfinite(w) || !std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) {
    throw BadArgument("pose: every number must be finite");
  }
  const double norm = std::hypot(std::hypot(w, x), std::hypot(y, z));
  if (std::abs(norm - 1.0) > k_unit_norm_tolerance) {
    throw BadArgument(fmt::format("pose: quaternion ({}, {}, {}, {}) has norm {}, not 1", w, x, y, z, norm));
  }
  return {Eigen::Quaterniond(w / norm, x / norm, y / norm, z / norm).toRotationMatrix(), t};
}

Eigen::Vector4d Pose::quaternion() const {
  const Eigen::Quaterniond q(R);
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  return sign * Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
}

}  // namespace sixdof
