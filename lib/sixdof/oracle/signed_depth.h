#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/tree.h>

/// Exact signed distance of points to a solid's surface. Internal: outside of the library use depth_integral.h.
namespace sixdof::detail {

/// A point with its signed distance to A's surface; everything in A's frame.
struct DepthNode {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_surface = Eigen::Vector3d::Zero();  ///< From p to the nearest point of the surface.
  double s = 0.0;                                        ///< Signed distance, negative inside (length).
  std::uint32_t triangle = 0;                            ///< Of the nearest point: an index into Mesh::triangles().
};

/// Measures depths against one mesh; one object per thread. Where a search starts changes its time, never its answer.
class SignedDepth {
 public:
  /// Both outlive it; `tree` is that of `a`.
  SignedDepth(const Mesh& a, const Tree& tree) : a_(&a), tree_(&tree) {}

  /// @param triangle any triangle of the mesh, best one close to p
  DepthNode at(const Eigen::Vector3d& p, std::uint32_t triangle);

  /// The same near a node that is known: its sign is taken over if no surface can be between.
  DepthNode at(const Eigen::Vector3d& p, const DepthNode& known);

  /// Whether the surface is nowhere within `radius` of p, and p is outside.
  bool is_outside(const Eigen::Vector3d& p, double radius);

 private:
  /// With an unsigned distance in `s`.
  DepthNode nearest(const Eigen::Vector3d& p, std::uint32_t triangle) const;
  bool is_inside(const Eigen::Vector3d& p);

  const Mesh* a_;
  const Tree* tree_;
  std::vector<std::uint32_t> scratch_;
};

}  // namespace sixdof::detail
