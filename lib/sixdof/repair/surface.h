#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/sides.h>

/// What the steps of a repair share.
namespace sixdof::repairing {

/// The surface under repair. Vertices keep their numbers; some may be in no triangle.
struct Surface {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;

  Eigen::Vector3d middle(const Triangle& t) const { return (vertices[t[0]] + vertices[t[1]] + vertices[t[2]]) / 3.0; }
  /// Twice the area times the normal.
  Eigen::Vector3d normal(const Triangle& t) const {
    return (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]);
  }
};

/// The start and end of a side in the direction of its triangle.
inline std::uint32_t start_of(const Side& s) { return s.forward ? s.low : s.high; }
inline std::uint32_t end_of(const Side& s) { return s.forward ? s.high : s.low; }
/// The corner opposite a side.
inline std::uint32_t apex_of(const Side& s, const std::vector<Triangle>& triangles) {
  return triangles[s.triangle()][(s.corner + 2 - 3 * s.triangle()) % 3];
}

/// The sides of edges with one triangle, in the order of sorted_sides().
inline std::vector<Side> border_sides(std::span<const Side> sorted) {
  std::vector<Side> border;
  for_each_edge(sorted, [&](std::span<const Side> edge) {
    if (edge.size() == 1) border.push_back(edge[0]);
  });
  return border;
}

inline bool is_collapsed(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// Distance within which positions cannot be told apart: a few roundings of the largest coordinate.
inline double rounding_at(const Eigen::Vector3d& p) {
  constexpr double k_roundings = 4.0 * 0x1p-53;
  return k_roundings * p.lpNorm<Eigen::Infinity>();
}

}  // namespace sixdof::repairing
