#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// Smallest angle of any triangle, in degrees.
inline double smallest_angle_deg(const Mesh& mesh) {
  double smallest = 180.0;
  for (const Triangle& t : mesh.triangles()) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d u = mesh.vertices()[t[(k + 1) % 3]] - mesh.vertices()[t[k]];
      const Eigen::Vector3d v = mesh.vertices()[t[(k + 2) % 3]] - mesh.vertices()[t[k]];
      const double angle = std::atan2(u.cross(v).norm(), u.dot(v)) * 180.0 / std::numbers::pi;
      smallest = std::min(smallest, angle);
    }
  }
  return smallest;
}

}  // namespace sixdof
