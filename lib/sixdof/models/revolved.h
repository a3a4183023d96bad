#pragma once

#include <cstddef>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// Solid cylinder about the z axis, centred at the origin.
struct CylinderShape {
  double radius = 1.0;
  double height = 2.0;
};

/// Solid cone about the z axis: base disc in the plane z = 0 with its centre at the origin, apex at (0, 0, height).
struct ConeShape {
  double radius = 1.0;
  double height = 2.0;
};

/// Coarsest form of cylinder and cone: rings of six vertices.
constexpr std::size_t k_minimum_cylinder = 24;
constexpr std::size_t k_minimum_cone = 12;

/// Every vertex lies on the ideal surface; edges are about equally long. Exactly `triangles` triangles, or one more if
/// that is odd. @throws BadArgument if a length is not positive and finite or the count is out of range.
Mesh make_cylinder(const CylinderShape& shape, std::size_t triangles);
Mesh make_cone(const ConeShape& shape, std::size_t triangles);

}  // namespace sixdof
