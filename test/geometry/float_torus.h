#pragma once

#include "mesh_files.h"
#include "scene_files.h"

namespace sixdof::testing_support {

/// The torus with coordinates that a float can hold.
inline const Mesh& float_torus() {
  static const Mesh mesh = [] {
    const Mesh exact = bumpy_torus(9, 6, 0.73, 99);
    std::vector<Eigen::Vector3d> vertices;
    for (const auto& p : exact.vertices()) vertices.emplace_back(as_float(p.x()), as_float(p.y()), as_float(p.z()));
    return Mesh::build(std::move(vertices), exact.triangles());
  }();
  return mesh;
}

}  // namespace sixdof::testing_support
