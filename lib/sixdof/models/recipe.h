#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// A model made by this library: closed, manifold, facing outwards, at any triangle count in its range, the same bits
/// on every machine.
struct Recipe {
  std::string_view name;     ///< a-z and '-'.
  std::string_view summary;  ///< Shape, size in the model's length unit, and frame.
  std::size_t minimum;       ///< Fewest triangles.
  unsigned genus;            ///< Number of handles.
  /// A mesh of `triangles`, or one more if that is odd. @throws BadArgument below `minimum`
  Mesh (*make)(std::size_t triangles);
};

/// All recipes.
std::span<const Recipe> recipes();

/// The same with other parameters, which `summary` states, for a collection of many shapes: `plate-10k`,
/// `gyroid-ball-fine-50k`.
std::span<const Recipe> recipe_variants();

// The shapes of the recipes in any size. Each make_... gives exactly `triangles` triangles, or one more if that is odd.
// @throws BadArgument if a parameter or the count is out of range.

/// Ball centred at the origin.
struct SphereShape {
  double radius = 1.0;  ///< Length.
};

/// Ball centred at the origin whose radius depends on the unit direction (x, y, z):
/// radius * (1 + amplitude * cos(2 pi w x) cos(2 pi w y) cos(2 pi w z)), w = waves.
struct BumpySphereShape {
  double radius = 1.0;      ///< Mean (length).
  double amplitude = 0.12;  ///< Of the bumps, in radii, 0 to 0.5.
  double waves = 1.5;       ///< Per radius, 0 to 20.
};

/// Geodesic spheres: every vertex lies on the ideal surface; edges span about equal angles.
Mesh make_sphere(const SphereShape& shape, std::size_t triangles);
/// Likewise.
Mesh make_bumpy_sphere(const BumpySphereShape& shape, std::size_t triangles);
constexpr std::size_t k_minimum_sphere = 20;  ///< An icosahedron.

/// Box with edges along the axes, centred at the origin.
struct BoxShape {
  Eigen::Vector3d size{2.0, 1.6, 1.2};  ///< Lengths of the edges along x, y, z.
};

/// Ring of hollow box cells about the z axis, centred at the origin. The ring is that of a regular polygon; each of its
/// sectors is a cell of beams with six open windows, and shares a frame with each neighbour. All faces are flat, all
/// edges sharp. Genus: 4 * sectors + 1.
struct CircularBoxShape {
  double outer_radius = 1.0;     ///< Of the outer corners.
  double inner_radius = 0.5;     ///< Of the inner corners.
  double height = 0.5;           ///< Along z.
  double beam = 0.1;             ///< Thickness of beams along the radius and z.
  double frame_fraction = 0.25;  ///< Of a sector's angle: the part of its frame.
  unsigned sectors = 12;         ///< Cells of the ring.
};

/// Walls are divided into a grid of about square elements. All vertices of a wall lie in one plane: exactly for walls
/// along the axes, else to rounding. The solid is the same at every count.
Mesh make_box(const BoxShape& shape, std::size_t triangles);
/// Likewise.
Mesh make_circular_box(const CircularBoxShape& shape, std::size_t triangles);
constexpr std::size_t k_minimum_box = 12;  ///< Two on each side.
/// Fewest triangles of such a ring.
constexpr std::size_t minimum_triangles(const CircularBoxShape& shape) { return std::size_t{80} * shape.sectors; }

/// Solid cylinder about the z axis, centred at the origin.
struct CylinderShape {
  double radius = 1.0;  ///< Length.
  double height = 2.0;  ///< Along z (length).
};

/// Solid cone about the z axis: base disc in the plane z = 0 with its centre at the origin, apex at (0, 0, height).
struct ConeShape {
  double radius = 1.0;  ///< Length.
  double height = 2.0;  ///< Along z (length).
};

/// Every vertex lies on the ideal surface; edges are about equally long.
Mesh make_cylinder(const CylinderShape& shape, std::size_t triangles);
/// Likewise, the apex too.
Mesh make_cone(const ConeShape& shape, std::size_t triangles);
constexpr std::size_t k_minimum_cylinder = 24;  ///< Rings of six vertices.
constexpr std::size_t k_minimum_cone = 12;      ///< A base of six vertices.

/// Torus about the z axis, centred at the origin; its core circle lies in the plane z = 0.
struct TorusShape {
  double major_radius = 1.0;  ///< Of the core circle.
  double minor_radius = 0.4;  ///< Of the tube, less than major_radius.
};

/// Round tube along a knot on a torus about the z axis, centred at the origin: its core is
/// ((R + r cos 2 pi q t) cos 2 pi p t, (R + r cos 2 pi q t) sin 2 pi p t, r sin 2 pi q t), 0 <= t < 1, with R =
/// major_radius, r = minor_radius, p = revolutions, q = windings. The standard shape is a trefoil. The tube must not
/// meet itself: its radius is less than the core's radius of curvature and than half the distance between strands, at
/// 1024 points.
struct TorusKnotShape {
  double major_radius = 1.0;  ///< R (length).
  double minor_radius = 0.5;  ///< r (length).
  double tube_radius = 0.25;  ///< Of the tube (length).
  unsigned revolutions = 2;   ///< About the z axis; no common divisor with windings.
  unsigned windings = 3;      ///< About the torus's core circle.
};

/// Every vertex lies on the ideal surface.
Mesh make_torus(const TorusShape& shape, std::size_t triangles);
/// Likewise.
Mesh make_torus_knot(const TorusKnotShape& shape, std::size_t triangles);
constexpr std::size_t k_minimum_torus = 60;        ///< Fewest triangles of a torus.
constexpr std::size_t k_minimum_torus_knot = 600;  ///< And of a knot.

/// The part of a ball about the origin in which sin X cos Y + sin Y cos Z + sin Z cos X < 0, with X = 2 pi x / period
/// and Y, Z alike: one of the two labyrinths that a gyroid separates. Edges at the surface of the ball are rounded.
struct GyroidBallShape {
  double radius = 1.0;     ///< Of the ball (length).
  double period = 1.0;     ///< Of the gyroid, in radii.
  double rounding = 0.08;  ///< Of the edges, in radii: about twice the depth to which an edge is cut.
};

/// The largest connected component only. Vertices lie on the ideal surface to 1e-12 of the radius.
Mesh make_gyroid_ball(const GyroidBallShape& shape, std::size_t triangles);
constexpr std::size_t k_minimum_gyroid_ball = 1000;  ///< Fewest triangles.

}  // namespace sixdof
