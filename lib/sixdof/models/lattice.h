#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include <sixdof/models/surface.h>

namespace sixdof {

/// A block of cells of which some are solid, like bricks, but possibly bent and closed to a ring. Along each axis cell
/// i is cut into steps[axis][i] steps, so that the walls can be tessellated as finely as wanted and still meet exactly.
struct Lattice {
  using Node = std::array<std::uint32_t, 3>;  ///< Cell numbers, or steps from the start along each axis.

  std::array<std::vector<std::uint32_t>, 3> steps;
  bool ring = false;  ///< Axis 1 closes: its last cell is followed by its first.
  std::function<bool(const Node& cell)> solid;
  /// Place of a node; axes 0, 1, 2 right-handed. Nodes of one wall must come out coplanar if walls are to be flat.
  std::function<Eigen::Vector3d(const Node& node)> position;
};

/// Number of triangles of the lattice's surface.
std::size_t count_triangles(const Lattice& lattice);

/// The surface between solid and empty cells, facing the empty ones. Two triangles per wall element, cut along its
/// shorter diagonal. It is manifold unless two solid cells touch in an edge or corner alone.
Surface surface_of(const Lattice& lattice);

}  // namespace sixdof
