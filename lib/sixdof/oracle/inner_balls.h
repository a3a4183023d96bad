#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>

/// A few balls inside of a solid, to guess common points of two solids. Internal: use penetration.h.
namespace sixdof::detail {

/// Balls inside of a solid, as arrays over the balls, the largest first.
struct InnerBalls {
  std::vector<double> x, y, z;          ///< Centres.
  std::vector<double> radius;           ///< The distance of the centre from the surface.
  std::vector<std::uint32_t> triangle;  ///< Where the ball touches it: an index into Mesh::triangles().

  std::size_t size() const { return radius.size(); }
  Eigen::Vector3d center(std::size_t i) const { return {x[i], y[i], z[i]}; }
  /// The same balls in another frame.
  InnerBalls moved(const Pose& X) const;

  /// Triangles from which balls are grown, and balls that are kept, at most.
  static constexpr std::size_t k_samples = 256, k_most = 64;
};

/// Balls that touch the surface at the middles of triangles spread over it, and elsewhere: centres on the medial axis
/// up to a thousandth of the radius. Source: J. Ma, S. W. Bae and S. Choi, "3D medial axis point approximation using
/// nearest neighbors and the normal field", 2012. Balls with centres close to that of a larger one are dropped.
/// @param mesh a solid; `tree` is its tree
InnerBalls find_inner_balls(const Mesh& mesh, const Tree& tree);

/// Two balls and a point that lies deep in both, as far as they tell.
struct BallPair {
  std::size_t a = 0, b = 0;
  double overlap = 0.0;  ///< Sum of the radii less the distance of the centres; negative where all balls are apart.
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
};

/// The pair of balls that overlap most after a translation of B's. Neither set is empty.
/// @param b in A's frame before the translation
BallPair deepest_pair(const InnerBalls& a, const InnerBalls& b, const Eigen::Vector3d& translation);

}  // namespace sixdof::detail
