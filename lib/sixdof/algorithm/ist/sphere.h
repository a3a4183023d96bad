#pragma once

#include <numbers>
#include <span>

#include <Eigen/Core>

namespace sixdof::ist {

struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< In the mesh's frame and length unit.
  double radius = 0.0;

  double volume() const { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius; }
};

/// Volume of the intersection of two spheres of radii `r1`, `r2` whose centres are `d` apart:
/// pi (r1 + r2 - d)^2 (d^2 + 2 d (r1 + r2) - 3 (r1 - r2)^2) / (12 d) where their surfaces cross, the smaller sphere's
/// volume where it lies inside the other, 0 where they are apart. (Weisstein, "Sphere-Sphere Intersection", MathWorld.)
double overlap_volume(double r1, double r2, double d);

/// A bounding sphere of `spheres`, close to the smallest one. The centre moves towards the farthest point of all
/// spheres in shrinking steps (Badoiu and Clarkson 2003, there for points); the radius is then computed for that centre
/// and rounded up.
Sphere enclosing_sphere(std::span<const Sphere> spheres);

}  // namespace sixdof::ist
