#pragma once

#include <cstddef>

#include <Eigen/Core>

#include <sixdof/geometry/triangle_distance.h>

namespace sixdof::ray_cast {

/// Distance of two triangles while one moves along a line: many times faster than triangle_triangle_distance(), and as
/// exact but for edges that are nearly parallel and nearly touching (an error of 1e-32 L^2 / (distance angle^2) for
/// edges of length L). Internal: use ray_cast.h.
class MovingPair {
 public:
  /// @param b moves to b + t * direction
  MovingPair(const TriangleCorners& a, const TriangleCorners& b, const Eigen::Vector3d& direction);

  struct Sample {
    double distance;       ///< 0 where the triangles intersect.
    Eigen::Vector3d axis;  ///< Unit vector from A's closest point to B's; zero where the distance is.
    double slope;          ///< d distance / d t.
  };
  Sample at(double t) const;

 private:
  static constexpr std::size_t k_edges = 10;   // 3 x 3 pairs of edges, to an even number
  static constexpr std::size_t k_corners = 6;  // A's corners over B, B's over A

  TriangleCorners a_;
  TriangleCorners b_;
  Eigen::Vector3d direction_;

  // Pairs of edges, [axis][pair]: points p + s u of A, q + r v of B.
  double from_[3][k_edges];  // q - p at t = 0
  double u_[3][k_edges];
  double v_[3][k_edges];
  double uv_[k_edges];
  double uu_[k_edges];
  double vv_[k_edges];
  double per_uu_[k_edges];  // 1 / u^2
  double per_vv_[k_edges];  // 1 / v^2
  double per_nn_[k_edges];  // 1 / (u^2 v^2 - (u . v)^2); 0 for parallel edges
  // Corners over faces: b - a for the corner and the face's first corner.
  double over_[3][k_corners];
  double normal_[3][k_corners];  // unit
  double first_[3][k_corners];   // barycentric coordinates are these . (corner - the face's first corner)
  double second_[3][k_corners];
  bool thin_ = false;           // a triangle without a normal
  double blur_ = 0.0;           // heights over faces may be off by this
  double drift_[3][k_corners];  // of (corner - face) with t
};

}  // namespace sixdof::ray_cast
