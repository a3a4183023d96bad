#pragma once

#include <cstddef>

#include <Eigen/Core>

#include <sixdof/geometry/tree.h>
#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/oracle/ray_cast_search.h>

namespace sixdof::ray_cast {

/// Distance of two triangles while one of them is translated along a line. It agrees with triangle_triangle_distance()
/// but for triangles that nearly touch and whose edges are nearly parallel: for edges of length L at an angle, of one
/// triangle or of both, their distance is off by up to 1e-32 L^2 / (distance angle^2). Internal: use
/// generation/distance_generator.h or translation_cast.h.
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

  /// Eight pairs of an edge or a face of each. From a point of A's to one of B's w = from + t direction + r v - s u,
  /// with s and r in 0 .. 1 and s + r <= most. [axis][pair]
  struct alignas(64) Features {
    static constexpr std::size_t k_count = 8;
    double from[3][k_count], u[3][k_count], v[3][k_count];
    double most[k_count];
  };

 private:
  TriangleCorners a_, b_;
  Eigen::Vector3d direction_;
  Features features_[2];     // 3 x 3 pairs of edges, each corner with the other triangle's face; the last one repeats
  bool degenerate_ = false;  // one of the triangles has no normal
};

/// Replaces the best hit by that of a pair of triangles if it is larger by more than a tie.
/// @return whether it did; if not, it may set best.separating_axis
bool try_update(Cast& cast, TrianglePair pair);

}  // namespace sixdof::ray_cast
