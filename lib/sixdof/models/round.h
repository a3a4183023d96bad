#pragma once

#include <cstddef>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// Ball centred at the origin.
struct SphereShape {
  double radius = 1.0;
};

/// Ball centred at the origin whose radius depends on the unit direction (x, y, z):
/// radius * (1 + amplitude * cos(2 pi w x) cos(2 pi w y) cos(2 pi w z)), w = waves.
struct BumpySphereShape {
  double radius = 1.0;
  double amplitude = 0.12;  ///< Of the bumps, in radii, 0 to 0.5.
  double waves = 1.5;       ///< Per radius, 0 to 20.
};

/// Distance from the origin to the ideal surface in the direction of the unit vector `direction`.
double bumpy_radius(const BumpySphereShape& shape, const Eigen::Vector3d& direction);

/// An icosahedron.
constexpr std::size_t k_minimum_sphere = 20;

/// Geodesic spheres: every vertex lies on the ideal surface; edges span about equal angles. Exactly `triangles`
/// triangles, or one more if that is odd. @throws BadArgument if a parameter or the count is out of range.
Mesh make_sphere(const SphereShape& shape, std::size_t triangles);
Mesh make_bumpy_sphere(const BumpySphereShape& shape, std::size_t triangles);

}  // namespace sixdof
