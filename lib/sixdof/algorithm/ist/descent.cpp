#include <sixdof/algorithm/ist/descent.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace sixdof::ist {

PushSum steepest_descent(const PenetrationSum& sum) {
  if (!(sum.volume > 0.0)) return {};
  const Eigen::Vector3d centroid = sum.first / sum.volume;
  const double gyration = std::sqrt(std::max(0.0, sum.second / sum.volume - centroid.squaredNorm()));
  const double turn = (sum.moment - centroid.cross(sum.force)).norm();
  // A single pair has no extent, and no moment about itself but rounding.
  const double slope = std::hypot(sum.force.norm(), gyration > 0.0 ? turn / gyration : 0.0);
  if (!(slope > 0.0)) return {};
  const double scale = sum.volume / slope;
  return {scale * sum.force, scale * sum.moment};
}

}  // namespace sixdof::ist
