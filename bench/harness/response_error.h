#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <sixdof/measure/direction.h>
#include <sixdof/measure/magnitude.h>
#include <sixdof/query/algorithm.h>
#include "bench/harness/check.h"

/// Responses compared with the exact ones.

namespace sixdof::bench {

/// Directions and magnitudes of forces or torques against those of the exact responses.
struct VectorError {
  DirectionError direction;
  std::optional<MagnitudeError> magnitude;
};

/// A series of forces or torques with the exact ones.
struct VectorSeries {
  std::vector<Eigen::Vector3d> exact, measured;
  std::vector<double> exact_magnitudes, magnitudes;

  /// @param scale of `vector`: its true length is |vector| / scale
  void add(const Eigen::Vector3d& exact_vector, const Eigen::Vector3d& vector, double scale) {
    exact.push_back(exact_vector);
    measured.push_back(vector);
    exact_magnitudes.push_back(exact_vector.norm());
    magnitudes.push_back(std::min(vector.stableNorm() / scale, Errors::k_largest));
  }
  VectorError error() const {
    return {direction_error(exact, measured), magnitude_error(exact_magnitudes, magnitudes)};
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
