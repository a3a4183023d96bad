#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <sixdof/measure/direction.h>
#include <sixdof/measure/magnitude.h>
#include <sixdof/query/algorithm.h>
#include "bench/harness/judge.h"

/// Responses compared with the exact ones.

namespace sixdof::bench {

/// Directions and magnitudes of forces or torques against those of the exact responses.
struct VectorError {
  DirectionError direction;
  std::optional<MagnitudeError> magnitude;
};

/// A series of forces or torques with the exact ones.
class VectorSeries {
 public:
  std::vector<Eigen::Vector3d> exact, measured;
  std::vector<double> exact_magnitudes, magnitudes;

  /// @param scale of `vector`: its true length is |vector| / scale
  void add(const Eigen::Vector3d& exact_vector, const Eigen::Vector3d& vector, double scale) {
    exact.push_back(exact_vector);
    measured.push_back(vector);
    exact_magnitudes.push_back(exact_vector.norm());
    magnitudes.push_back(std::min(vector.stableNorm() / scale, k_largest_error));
  }
  VectorError error() const {
    return {direction_error(exact, measured), magnitude_error(exact_magnitudes, magnitudes)};
  }
  /// Place of the largest angle of this series; empty where all angles are 0.
  std::optional<std::size_t> largest_angle(const DirectionError& error) const {
    const auto angle = [&](std::size_t k) { return angle_degrees(exact[k], measured[k]); };
    return largest([&](std::size_t k) { return angle(k) <= error.largest_degrees ? angle(k) : 0.0; });
  }
  /// Place of the largest difference of a magnitude from `gain` times the exact one; empty where there is none.
  std::optional<std::size_t> largest_difference(double gain) const {
    return largest([&](std::size_t k) { return std::abs(magnitudes[k] - gain * exact_magnitudes[k]); });
  }

 private:
  template <class Value>
  std::optional<std::size_t> largest(Value value) const {
    std::optional<std::size_t> place;
    for (std::size_t k = 0; k < exact.size(); ++k) {
      if (value(k) > (place ? value(*place) : 0.0)) place = k;
    }
    return place;
  }
};

/// The same wrench about another point, times `scale`, which is less than 1 where moving the torque might overflow.
struct ScaledResponse {
  Response response;
  double scale = 1.0;
};

inline ScaledResponse scaled_about(Response response, const Eigen::Vector3d& point) {
  constexpr double k_large = 1e100;
  const double largest = std::max(response.force.cwiseAbs().maxCoeff(), response.torque.cwiseAbs().maxCoeff());
  const double scale = largest > k_large ? 1.0 / largest : 1.0;
  response.force *= scale;
  response.torque *= scale;
  return {response.about(point), scale};
}

}  // namespace sixdof::bench
