#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include <sixdof/query/algorithm.h>

namespace sixdof::test {

/// Work of a response on a closed loop of translations and turns over (peak force x length of the path): 0 for forces
/// and torques that derive from one energy, as the steps get small. B's centre runs on a loop about `middle` (A's
/// frame) of about `radius` while B turns to and fro.
inline double loop_work(Query& query, const Mesh& b, const Eigen::Vector3d& middle, double radius, int steps) {
  const Eigen::Vector3d axis = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  const auto pose = [&](int step) {
    const double w = 2.0 * std::numbers::pi * step / steps;
    const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7 + 0.4 * std::sin(w), axis).toRotationMatrix();
    const Eigen::Vector3d place = middle + radius * Eigen::Vector3d(std::cos(w), 1.2 * std::sin(w), std::sin(2.0 * w));
    return Pose{R, place - R * b.center()};
  };
  // Trapezoids: their error falls with the square of the step. A step's turn is about one axis, in A's frame.
  double work = 0.0, length = 0.0, peak = 0.0;
  Response before = query.respond(pose(0)).value;
  for (int i = 1; i <= steps; ++i) {
    const Pose from = pose(i - 1), to = pose(i);
    const Response after = query.respond(to).value;
    const Eigen::AngleAxisd turn(to.R * from.R.transpose());
    const Eigen::Vector3d way = to * b.center() - from * b.center(), angle = turn.angle() * turn.axis();
    work += 0.5 * ((before.force + after.force).dot(way) + (before.torque + after.torque).dot(angle));
    length += way.norm();
    peak = std::max(peak, after.force.norm());
    before = after;
  }
  return peak > 0.0 ? std::abs(work) / (peak * length) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace sixdof::test
