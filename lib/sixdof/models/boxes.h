#pragma once

#include <cstddef>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

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
  unsigned sectors = 12;
};

constexpr std::size_t k_minimum_box = 12;

/// Of the coarsest circular box: 80 per sector.
std::size_t minimum_triangles(const CircularBoxShape& shape);

/// Walls are divided into a grid of about square elements. All vertices of a wall lie in one plane: exactly for walls
/// along the axes, else to rounding. The solid is the same at every count. Exactly `triangles` triangles, or one more
/// if that is odd. @throws BadArgument if a parameter or the count is out of range.
Mesh make_box(const BoxShape& shape, std::size_t triangles);
Mesh make_circular_box(const CircularBoxShape& shape, std::size_t triangles);

}  // namespace sixdof
