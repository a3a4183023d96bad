#pragma once

#include <cstddef>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// The part of a ball about the origin in which sin X cos Y + sin Y cos Z + sin Z cos X < 0, with X = 2 pi x / period
/// and Y, Z alike: one of the two labyrinths that a gyroid separates. Edges at the surface of the ball are rounded.
struct GyroidBallShape {
  double radius = 1.0;
  double period = 1.0;     ///< Of the gyroid, in radii.
  double rounding = 0.08;  ///< Of the edges, in radii: about twice the depth to which an edge is cut.
};

constexpr std::size_t k_minimum_gyroid_ball = 1000;

/// The largest connected component only. Vertices lie on the ideal surface to 1e-12 of the radius. Exactly `triangles`
/// triangles, or one more if that is odd. @throws BadArgument if a parameter or the count is out of range.
Mesh make_gyroid_ball(const GyroidBallShape& shape, std::size_t triangles);

}  // namespace sixdof
