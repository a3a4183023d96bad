#pragma once

#include <cstddef>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// Torus about the z axis, centred at the origin; its core circle lies in the plane z = 0.
struct TorusShape {
  double major_radius = 1.0;  ///< Of the core circle.
  double minor_radius = 0.4;  ///< Of the tube, less than major_radius.
};

/// Round tube along a knot on a torus about the z axis, centred at the origin: its core is
/// ((R + r cos 2 pi q t) cos 2 pi p t, (R + r cos 2 pi q t) sin 2 pi p t, r sin 2 pi q t), 0 <= t < 1, with R =
/// major_radius, r = minor_radius, p = revolutions, q = windings. The standard shape is a trefoil.
struct TorusKnotShape {
  double major_radius = 1.0;
  double minor_radius = 0.5;
  double tube_radius = 0.25;
  unsigned revolutions = 2;  ///< About the z axis; no common divisor with windings.
  unsigned windings = 3;     ///< About the torus's core circle.
};

/// Length of the knot's core, by the trapezium rule (exact to rounding for a periodic analytic curve).
double core_length(const TorusKnotShape& shape);

constexpr std::size_t k_minimum_torus = 60;
constexpr std::size_t k_minimum_torus_knot = 600;

/// Every vertex lies on the ideal surface. Exactly `triangles` triangles, or one more if that is odd.
/// @throws BadArgument if a parameter or the count is out of range, or if the tube of the knot intersects itself: its
/// radius must be less than the core's radius of curvature and than half the distance between strands, at 1024 points.
Mesh make_torus(const TorusShape& shape, std::size_t triangles);
Mesh make_torus_knot(const TorusKnotShape& shape, std::size_t triangles);

}  // namespace sixdof
