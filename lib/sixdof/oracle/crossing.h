#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include <sixdof/geometry/predicates.h>

namespace sixdof {

/// A triangle whose corners are turned so that the first has the mesh's lowest vertex index. Sides: 0 from corner 0 to
/// 1, 1 from corner 1 to 2, 2 from corner 2 to 0.
struct OrderedTriangle {
  std::array<Eigen::Vector3d, 3> corner;
  bool rises = true;  ///< Corner 1 has a lower index than corner 2.

  /// Corner of lower index of a side: where its crossings slide to (see Solid).
  int low(int side) const { return side == 1 && !rises ? 2 : side == 1 ? 1 : 0; }
  int high(int side) const { return side == 0 ? 1 : side == 2 ? 2 : rises ? 2 : 1; }
};

/// The segment in which a triangle of A and a moved triangle of B meet. Its direction start -> end is that of
/// (normal of A's triangle) x (normal of B's triangle): on A's triangle the part inside B lies to the left of it, on
/// B's triangle the part inside A to the right.
struct Segment {
  Eigen::Vector3d start, end;
  /// Which side pierces the other triangle at that end: 0, 1, 2 for A's triangle, 3, 4, 5 for B's.
  int start_side = 0, end_side = 0;
};

/// Decides exactly, for B translated by the infinitesimal e of predicates.h, whether and how the triangles meet.
/// Corners of `b` are in A's frame.
std::optional<Segment> cross(const OrderedTriangle& a, const OrderedTriangle& b);

/// Does the segment from `p` to `q` pierce the triangle, and how: +1 against the triangle's normal (into the body), -1
/// along it, 0 not at all. For an edge of A and a moved triangle of B.
int pierce_moved_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                          const std::array<Eigen::Vector3d, 3>& triangle);

/// The same for a moved edge of B and a triangle of A.
int moved_edge_pierces(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                       const std::array<Eigen::Vector3d, 3>& triangle);

}  // namespace sixdof
