#pragma once

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

inline TriangleCorners corners_of(const Mesh& mesh, std::size_t i, const Pose& pose) {
  TriangleCorners t;
  for (std::size_t k = 0; k < 3; ++k) t[k] = pose * mesh.vertices()[mesh.triangles()[i][k]];
  return t;
}

inline TriangleCorners corners_of(const Mesh& mesh, std::size_t i) {
  TriangleCorners t;
  for (std::size_t k = 0; k < 3; ++k) t[k] = mesh.vertices()[mesh.triangles()[i][k]];
  return t;
}

/// All pairs, in the order of the documented tie rule.
inline SurfaceDistance brute_force(const Mesh& a, const Mesh& b, const Pose& X_AB) {
  SurfaceDistance best;
  best.distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.triangles().size(); ++i) {
    for (std::size_t j = 0; j < b.triangles().size(); ++j) {
      const ClosestPoints c = triangle_triangle_distance(corners_of(a, i), corners_of(b, j, X_AB));
      if (c.distance < best.distance) {
        best = {true, c.distance, c.on_a, c.on_b, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)};
      }
    }
  }
  return best;
}

inline Mesh turned_inside_out(const Mesh& mesh) {
  std::vector<Triangle> t = mesh.triangles();
  for (Triangle& x : t) std::swap(x[1], x[2]);
  return Mesh::build(mesh.vertices(), t);
}

}  // namespace sixdof::distance_truth
