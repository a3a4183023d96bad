#include <sixdof/measure/direction.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace sixdof {

double angle_degrees(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  // Without this the squares of tiny or huge vectors would underflow or overflow.
  const Eigen::Vector3d u = a.stableNormalized();
  const Eigen::Vector3d v = b.stableNormalized();
  return std::atan2(u.cross(v).norm(), u.dot(v)) * (180.0 / std::numbers::pi);
}

DirectionError direction_error(Vectors ideal, Vectors measured) {
  check_same_length(ideal, measured);
  const double ideal_zero = k_zero_fraction * peak(ideal);
  const double measured_zero = k_zero_fraction * peak(measured);
  DirectionError error;
  double sum = 0.0;
  for (std::size_t k = 0; k < ideal.size(); ++k) {
    const bool ideal_acts = ideal[k].norm() > ideal_zero;
    const bool measured_acts = measured[k].norm() > measured_zero;
    if (ideal_acts && measured_acts) {
      const double angle = angle_degrees(ideal[k], measured[k]);
      sum += angle;
      error.largest_degrees = std::max(error.largest_degrees, angle);
      ++error.compared;
    } else if (ideal_acts) {
      ++error.misses;
    } else if (measured_acts) {
      ++error.false_contacts;
    } else {
      ++error.skipped;
    }
  }
  if (error.compared > 0) error.gamma_degrees = sum / static_cast<double>(error.compared);
  return error;
}

}  // namespace sixdof
