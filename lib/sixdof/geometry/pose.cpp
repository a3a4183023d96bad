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
  // Every entry is a ratio of two sums of the same products. So rotations that permute and flip axes, whose quaternions
  // contain sqrt(1/2), have entries of exactly 0 and 1, and parallel faces stay parallel.
  const double ww = w * w, xx = x * x, yy = y * y, zz = z * z;
  const double square = (ww + zz) + (xx + yy);
  Pose pose;
  pose.R << (ww + xx) - (yy + zz), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y),  //
      2.0 * (x * y + w * z), (ww + yy) - (xx + zz), 2.0 * (y * z - w * x),        //
      2.0 * (x * z - w * y), 2.0 * (y * z + w * x), (ww + zz) - (xx + yy);
  pose.R /= square;
  pose.t = t;
  return pose;
}

Eigen::Vector4d Pose::quaternion() const {
  const Eigen::Quaterniond q(R);
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  return sign * Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
}

}  // namespace sixdof
