#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include <sixdof/models/surface.h>

namespace sixdof {

/// A block of cells, some of which are solid; it may be bent and closed to a ring. Along each axis cell i is divided
/// into steps[axis][i] steps, in which the walls between solid and empty cells are tessellated.
struct Lattice {
  using Node = std::array<std::uint32_t, 3>;  ///< Cell numbers, or steps from the start along each axis.

  std::array<std::vector<std::uint32_t>, 3> steps;
  bool ring = false;  ///< Along axis 1 the last cell is followed by the first.
  std::function<bool(const Node& cell)> solid;
  /// Position of a node; axes 0, 1, 2 are right-handed. A wall is flat if the positions of its nodes are coplanar.
  std::function<Eigen::Vector3d(const Node& node)> position;
};

/// Of surface_of().
std::size_t count_triangles(const Lattice& lattice);

/// The surface between solid and empty cells, facing the empty ones: two triangles per wall element, divided along its
/// shorter diagonal. It is manifold unless two solid cells touch in an edge or corner only.
Surface surface_of(const Lattice& lattice);

}  // namespace sixdof
