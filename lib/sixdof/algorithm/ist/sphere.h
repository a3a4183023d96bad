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

/// Volume common to two balls of radii `r1`, `r2` whose centres are `d` apart:
/// pi (r1 + r2 - d)^2 (d^2 + 2 d (r1 + r2) - 3 (r1 - r2)^2) / (12 d) where they cross, the smaller ball's volume where
/// it lies inside the other, 0 where they are apart. (Weisstein, "Sphere-Sphere Intersection", MathWorld.)
double overlap_volume(double r1, double r2, double d);

/// -d/dd of overlap_volume: the area of the disc that the two spheres' intersection circle bounds; 0 where they do not
/// cross.
double overlap_disc_area(double r1, double r2, double d);

/// A ball that contains all `spheres`, close to the smallest one: the centre steps towards the farthest point of all
/// spheres with shrinking steps (Badoiu and Clarkson 2003, there for points); the radius is then taken exactly, rounded
/// up.
Sphere enclosing_sphere(std::span<const Sphere> spheres);

}  // namespace sixdof::ist
