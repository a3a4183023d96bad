#pragma once

#include <algorithm>
#include <tuple>

#include <sixdof/geometry/sides.h>
#include <sixdof/models/surface.h>

namespace sixdof {

/// 3 * triangle + corner, as Side::corner: the side from that corner to the next.
using HalfEdge = std::uint32_t;

inline HalfEdge next_in_triangle(HalfEdge h) { return h % 3 == 2 ? h - 2 : h + 1; }
inline HalfEdge previous_in_triangle(HalfEdge h) { return h % 3 == 0 ? h + 2 : h - 1; }

/// An edge by its end points, low < high, and one of its half-edges.
struct Edge {
  double length_squared;
  std::uint32_t low, high;
  HalfEdge half_edge;

  bool joins_same(const Edge& other) const { return low == other.low && high == other.high; }
};

/// The edge of a half-edge. From the lower number to the higher: the length has the same bits on both sides.
inline Edge edge_of(const Surface& surface, HalfEdge h) {
  const HalfEdge next = next_in_triangle(h);
  const auto [low, high] = std::minmax(surface.triangles[h / 3][h % 3], surface.triangles[next / 3][next % 3]);
  const Eigen::Vector3d along = surface.vertices[high] - surface.vertices[low];
  return {dot_in_order(along, along), low, high, h};
}

}  // namespace sixdof
