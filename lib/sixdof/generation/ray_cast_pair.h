#pragma once

#include <cstddef>

#include <Eigen/Core>

#include <sixdof/generation/ray_cast_search.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/geometry/triangle_distance.h>

namespace sixdof::ray_cast {

/// Distance of two triangles while one of them is translated along a line. It agrees with triangle_triangle_distance()
/// but for pairs of edges that are nearly parallel and nearly touch: for edges of length L at an angle, their distance
/// is off by up to 1e-32 L^2 / (distance angle^2). Internal: use distance_generator.h.
class MovingPair {
 public:
  /// @param b is translated by t * direction
  /// @param direction unit vector
  MovingPair(const TriangleCorners& a, const TriangleCorners& b, const Eigen::Vector3d& direction);

  struct Distance {
    double value;          ///< 0 where the triangles intersect.
    Eigen::Vector3d axis;  ///< Unit vector from A's closest point to B's; zero where the distance is.
    double slope;          ///< d value / d t.
  };
  Distance distance_at(double t) const;

  static constexpr std::size_t k_edges = 10;   ///< 3 x 3 pairs of edges, padded to an even number.
  static constexpr std::size_t k_corners = 6;  ///< A's corners against B's face, then B's against A's.

  /// Edges and corners, in arrays for SIMD.
  struct Features {
    // Pairs of edges, [axis][pair]: points p + s u of A, q + r v of B, with s and r in 0 .. 1.
    double from[3][k_edges];  // q - p at t = 0
    double u[3][k_edges];
    double v[3][k_edges];
    double uv[k_edges];  // u . v
    double uu[k_edges];  // u . u
    double vv[k_edges];
    double per_uu[k_edges];  // 1 / (u . u); 0 if u is zero
    double per_vv[k_edges];
    double per_nn[k_edges];  // 1 / |u x v|^2; 0 for parallel edges
    // Corners against faces, [axis][corner].
    double offset[3][k_corners];    // corner - the face's first corner, at t = 0
    double velocity[3][k_corners];  // d offset / d t
    double normal[3][k_corners];    // the face's; unit vector
    double dual_1[3][k_corners];    // barycentric coordinates are dual . (corner - the face's first corner)
    double dual_2[3][k_corners];
  };

  /// At one translation.
  struct Separations {
    double w[3][k_edges];  // from A's closest point of each pair of edges to B's
    double squared[k_edges];
    double signed_distance[k_corners];  // of the corner from the face's plane
    double outside[k_corners];          // at most 0 where the corner's projection onto the plane lies in the face
  };

 private:
  TriangleCorners a_;
  TriangleCorners b_;
  Eigen::Vector3d direction_;
  Features features_;
  bool degenerate_ = false;   // one of the triangles has no normal
  double plane_error_ = 0.0;  // error of a corner's signed distance from a face's plane
};

/// Replaces the best hit by that of a pair of triangles if it is larger by more than a tie.
/// @return whether it did; if not, it may set best.separating_axis
bool try_update(Cast& cast, TrianglePair pair);

}  // namespace sixdof::ray_cast
