#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/oracle/distance.h>

/// Distances by brute force, shared by the tests of the distance oracle.
namespace sixdof::distance_truth {

inline TriangleCorners corners_of(const Mesh& mesh, std::size_t i) {
  TriangleCorners t;
  for (std::size_t k = 0; k < 3; ++k) t[k] = mesh.vertices()[mesh.triangles()[i][k]];
  return t;
}

inline TriangleCorners corners_of(const Mesh& mesh, std::size_t i, const Pose& pose) {
  TriangleCorners t = corners_of(mesh, i);
  for (Eigen::Vector3d& corner : t) corner = pose * corner;
  return t;
}

/// The closest pair of all; ties as documented in distance.h.
inline Separation brute_force(const Mesh& a, const Mesh& b, const Pose& X_AB, double tie_width = 0.0) {
  double smallest = std::numeric_limits<double>::infinity();
  std::vector<Separation> close;
  for (std::size_t i = 0; i < a.triangles().size(); ++i) {
    for (std::size_t j = 0; j < b.triangles().size(); ++j) {
      const ClosestPoints c = triangle_triangle_distance(corners_of(a, i), corners_of(b, j, X_AB));
      if (c.distance > smallest + tie_width) continue;
      smallest = std::min(smallest, c.distance);
      close.push_back({c.distance, true, c.on_a, c.on_b, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)});
    }
  }
  return *std::find_if(close.begin(), close.end(),
                       [&](const Separation& x) { return x.distance <= smallest + tie_width; });
}

}  // namespace sixdof::distance_truth
