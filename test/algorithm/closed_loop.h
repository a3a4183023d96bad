#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include <sixdof/query/algorithm.h>

namespace sixdof::test {

/// Work of a response on a closed loop of translations and rotations, over (peak force x length of the path). With
/// smaller steps it converges to 0 for forces and torques that derive from one energy. B's centre moves on a loop of
/// about `radius` around `middle` (A's frame) while B rotates back and forth.
inline double loop_work(Query& query, const Mesh& b, const Eigen::Vector3d& middle, double radius, int steps) {
  const Eigen::Vector3d axis = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  const auto pose = [&](int step) {
    const double w = 2.0 * std::numbers::pi * step / steps;
    const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7 + 0.4 * std::sin(w), axis).toRotationMatrix();
    const Eigen::Vector3d center = middle + radius * Eigen::Vector3d(std::cos(w), 1.2 * std::sin(w), std::sin(2.0 * w));
    return Pose{R, center - R * b.center()};
  };
  // Trapezoidal rule. A step is a translation of B's centre and a rotation about one axis, in A's frame.
  double work = 0.0, length = 0.0, peak = 0.0;
  Response before = query.respond(pose(0)).value;
  for (int i = 1; i <= steps; ++i) {
    const Pose from = pose(i - 1), to = pose(i);
    const Response after = query.respond(to).value;
    const Eigen::AngleAxisd rotation(to.R * from.R.transpose());
    const Eigen::Vector3d translation = to * b.center() - from * b.center(), angle = rotation.angle() * rotation.axis();
    work += 0.5 * ((before.force + after.force).dot(translation) + (before.torque + after.torque).dot(angle));
    length += translation.norm();
    peak = std::max(peak, after.force.norm());
    before = after;
  }
  return peak > 0.0 ? std::abs(work) / (peak * length) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace sixdof::test
