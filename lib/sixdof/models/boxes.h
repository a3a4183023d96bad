#pragma once

#include <cstddef>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// Block with edges along the axes, centred at the origin.
struct BoxShape {
  Eigen::Vector3d size{2.0, 1.6, 1.2};  ///< Lengths of the edges along x, y, z.
};

/// Ring of hollow box cells about the z axis, centred at the origin: each of the sectors of a regular polygon's ring is
/// a cell whose six walls are open windows between beams, joined to its two neighbours by common frames. All faces are
/// flat, all edges sharp; nothing is round but the plan. Genus: 4 * sectors + 1.
struct CircularBoxShape {
  double outer_radius = 1.0;  ///< Of the outer corners.
  double inner_radius = 0.5;  ///< Of the inner corners.
  double height = 0.5;        ///< Along z.
  double beam = 0.1;          ///< Thickness of beams along the radius and z.
  double frame_share = 0.25;  ///< Share of a sector that its frame takes of the circle.
  unsigned sectors = 12;
};

constexpr std::size_t k_minimum_box = 12;

/// Coarsest form of a circular box: 80 triangles a sector.
std::size_t minimum_triangles(const CircularBoxShape& shape);

/// Walls are cut into a grid of about square elements, with all vertices of a wall in one plane (exactly for walls
/// along the axes, else to rounding). Exactly `triangles` triangles, or one more if that is odd. The solid is the same
/// at every count. @throws BadArgument if a parameter or the count is out of range.
Mesh make_box(const BoxShape& shape, std::size_t triangles);
Mesh make_circular_box(const CircularBoxShape& shape, std::size_t triangles);

/// Volume of the solid: a sum of prisms, one per solid cell.
double volume_of(const CircularBoxShape& shape);

}  // namespace sixdof
