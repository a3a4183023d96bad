#include <sixdof/algorithm/ist/steepest_descent.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace sixdof::ist {

Wrench steepest_descent(const PenetrationSum& sum) {
  if (!(sum.volume > 0.0)) return {};
  const Eigen::Vector3d centroid = sum.first_moment / sum.volume;
  const double gyration = std::sqrt(std::max(0.0, sum.second_moment / sum.volume - centroid.squaredNorm()));
  const double moment = (sum.moment - centroid.cross(sum.force)).norm();
  // A single pair has no radius of gyration; its moment about the centroid is rounding.
  const double norm = std::hypot(sum.force.norm(), gyration > 0.0 ? moment / gyration : 0.0);
  if (!(norm > 0.0)) return {};
  const double scale = sum.volume / norm;
  return {scale * sum.force, scale * sum.moment};
}

}  // namespace sixdof::ist
