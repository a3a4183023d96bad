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
  double lipschitz = 1.0;  ///< Bound on the change of the value per length: blocks without a zero are skipped by it.
};

/// The surface value = 0 by marching tetrahedra: each cell is divided into six tetrahedra about its diagonal. Closed,
/// manifold and facing outwards for any values, since each node is either inside or outside; vertices are at least 1/20
/// of an edge away from the nodes. Triangles may be slim. Cost and memory grow with the area of the surface.
Surface contour(const GridField& field);

/// Keeps the component of the surface with the most triangles only.
void keep_largest_component(Surface& surface);

}  // namespace sixdof
