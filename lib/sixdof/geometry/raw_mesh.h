#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

inline bool is_collapsed(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// Vertices and triangles before Mesh::build() checks and welds them: of a file, under repair, under construction.
struct RawMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;

  /// Adds a vertex. @return its number
  std::uint32_t add(const Eigen::Vector3d& p) {
    vertices.push_back(p);
    return static_cast<std::uint32_t>(vertices.size() - 1);
  }
  Eigen::Vector3d middle(const Triangle& t) const { return (vertices[t[0]] + vertices[t[1]] + vertices[t[2]]) / 3.0; }
  /// Twice the area times the normal.
  Eigen::Vector3d normal(const Triangle& t) const {
    return (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]);
  }
  /// Signed volume of the tetrahedron of a triangle and a point.
  double tetrahedron(const Triangle& t, const Eigen::Vector3d& origin) const {
    const auto corner = [&](std::size_t k) -> Eigen::Vector3d { return vertices[t[k]] - origin; };
    return corner(0).dot(corner(1).cross(corner(2))) / 6.0;
  }
};

}  // namespace sixdof
