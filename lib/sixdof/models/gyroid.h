#pragma once

#include <cstddef>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// One of the two labyrinths that a gyroid, sin X cos Y + sin Y cos Z + sin Z cos X = 0 with X = 2 pi x / period,
/// separates, as far as it lies in a ball of the given radius about the origin. Edges where the ball cuts it are
/// rounded.
struct GyroidBallShape {
  double radius = 1.0;
  double period = 1.0;     ///< Of the gyroid, in radii.
  double rounding = 0.08;  ///< Of the edges, in radii: how far the solid draws back there is half of it.
};

/// The field whose zeros are the surface of the shape with radius 1; negative inside.
double gyroid_field(const GyroidBallShape& shape, const Eigen::Vector3d& p);

constexpr std::size_t k_minimum_gyroid_ball = 1000;

/// Vertices lie on the ideal surface to 1e-12 of the radius. The largest connected piece only. Exactly `triangles`
/// triangles, or one more if that is odd. @throws BadArgument if a parameter or the count is out of range.
Mesh make_gyroid_ball(const GyroidBallShape& shape, std::size_t triangles);

}  // namespace sixdof
