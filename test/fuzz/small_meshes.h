#pragma once

#include <sixdof/geometry/mesh.h>

namespace sixdof::fuzz {

/// A solid of four triangles without symmetry.
inline Mesh tetrahedron(double scale) {
  return Mesh::build({{0.0, 0.0, 0.0}, {1.0 * scale, 0.1, 0.0}, {-0.2, 1.3 * scale, 0.3}, {0.1, -0.3, 0.9 * scale}},
                     {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, "tetrahedron");
}

/// A solid of twelve triangles, [0, 1]^3 stretched.
inline Mesh box(double x, double y, double z) {
  return Mesh::build({{0, 0, 0}, {x, 0, 0}, {0, y, 0}, {x, y, 0}, {0, 0, z}, {x, 0, z}, {0, y, z}, {x, y, z}},
                     {{0, 2, 3},
                      {0, 3, 1},
                      {4, 5, 7},
                      {4, 7, 6},
                      {0, 1, 5},
                      {0, 5, 4},
                      {2, 6, 7},
                      {2, 7, 3},
                      {0, 4, 6},
                      {0, 6, 2},
                      {1, 3, 7},
                      {1, 7, 5}},
                     "box");
}

}  // namespace sixdof::fuzz
