#pragma once

#include <cstdint>
#include <limits>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/signed_depth.h>

/// Points that lie deep inside two bodies at once. Internal: outside of the library use penetration.h.
namespace sixdof::detail {

/// A point with its signed distances to both surfaces.
struct CommonPoint {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< In A's frame.
  DepthNode a;                                  ///< Of p, in A's frame.
  DepthNode b;                                  ///< Of the same point, in B's frame.

  /// How deep p lies inside both bodies: the smaller of both depths, negative outside (length).
  double depth() const { return -std::max(a.s, b.s); }
};

/// Searches for points of the intersection of A and B; one object per thread. Where a search of a nearest point starts
/// changes its time, never its answer, so every result depends on the arguments alone.
class CommonPointSearch {
 public:
  /// All outlive it; both meshes are solids.
  CommonPointSearch(const Mesh& a, const Tree& tree_a, const Mesh& b, const Tree& tree_b)
      : in_a_(a, tree_a), in_b_(b, tree_b), mesh_a_(a), mesh_b_(b) {}

  /// @param triangle_a, triangle_b triangles of the meshes, best close to p
  CommonPoint at(const Eigen::Vector3d& p, const Pose& X_AB, std::uint32_t triangle_a, std::uint32_t triangle_b);
  /// The same near a known point.
  CommonPoint at(const Eigen::Vector3d& p, const Pose& X_AB, const CommonPoint& near);

  /// How an ascent ends.
  struct Effort {
    double gain =
        0.2;  ///< At a point in both bodies whose depth can grow by no more than this part of it, by the model.
    double enough = std::numeric_limits<double>::infinity();  ///< At this depth (length).
    int most = 12;                                            ///< After so many points.
  };

  /// Climbs from a known point towards a local maximum of depth(): each signed distance is 1-Lipschitz, with the
  /// direction away from the nearest point of the surface as its gradient. A proximal bundle method: the next point
  /// maximizes the smallest of up to k_planes linear bounds less |x|^2 / (2 tau). Source: J. F. Bonnans et al.,
  /// "Numerical Optimization" (2006), chapter 10.
  /// @param start of this pose
  /// @param tau length of the first step, at most
  CommonPoint ascend(const CommonPoint& start, const Pose& X_AB, double tau, const Effort& effort);

  /// Points measured so far.
  std::uint64_t measurements() const { return measurements_; }

 private:
  SignedDepth in_a_, in_b_;
  const Mesh& mesh_a_;
  const Mesh& mesh_b_;
  std::uint64_t measurements_ = 0;
};

}  // namespace sixdof::detail
