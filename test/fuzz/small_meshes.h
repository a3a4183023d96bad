#pragma once

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

#include "../configuration/shapes.h"

namespace sixdof::fuzz {

/// A solid of four triangles without symmetry.
inline Mesh tetrahedron(double height = 0.9) { return test::tetrahedron_mesh(Eigen::Vector3d::Zero(), height); }

/// A solid of twelve triangles with a corner at the origin.
inline Mesh box() {
  const Eigen::Vector3d half(0.5, 0.4, 0.3);
  return test::boxes_mesh({{half, half}}, "box");
}

}  // namespace sixdof::fuzz
