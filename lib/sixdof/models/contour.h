#pragma once

#include <cstdint>
#include <functional>

#include <sixdof/models/surface.h>

namespace sixdof {

/// A scalar field on the nodes of a cubic grid: node (i, j, k) lies at low + step * (i, j, k), 0 <= i, j, k <= cells.
struct GridField {
  std::uint32_t cells = 0;  ///< Along each axis; a multiple of 8.
  double low = 0.0;         ///< First coordinate along every axis.
  double step = 1.0;
  /// Value at a node; negative inside the solid. Must be positive on the grid's border.
  std::function<double(std::uint32_t i, std::uint32_t j, std::uint32_t k)> value;
  double steepest =
      1.0;  ///< Bound on the field's change per length, in units of value: blocks without zero are skipped.
};

/// The surface value = 0 by marching tetrahedra: each cell is cut into six tetrahedra along its diagonal, all cells
/// alike. Closed, manifold and facing outwards for any values, since a node counts as inside or outside and never as
/// both; vertices stay off the nodes by a twentieth of an edge. Triangles may be slim. Work and memory grow with the
/// surface.
Surface contour(const GridField& field);

/// Leaves only the component of the surface with the most triangles.
void keep_largest_component(Surface& surface);

}  // namespace sixdof
