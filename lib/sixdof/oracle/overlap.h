#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/pose.h>
#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/crossing.h>
#include <sixdof/oracle/solid.h>

namespace sixdof {

/// What two solid bodies have in common at a pose. All vectors are in A's frame.
///
/// Where a mesh overlaps itself a point counts as often as the meshes wind around it: volume is the integral of the
/// product of both winding numbers.
struct Overlap {
  /// Volume of the intersection (length^3). Rounding may leave a trace of either sign where bodies only touch.
  double volume = 0.0;
  /// Integral of B's outward normal over the part of B's surface inside A (length^2): the gradient of volume with
  /// respect to translating B. The force of the volume law is its negative.
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  /// Integral of (p - reference) x (B's outward normal) over the same part (length^3): the gradient of volume with
  /// respect to rotating B about `reference`. The torque of the volume law is its negative.
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  Eigen::Vector3d reference = Eigen::Vector3d::Zero();
  /// Centre of mass of the intersection (length); NaN where volume is not positive.
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  std::size_t crossings = 0;  ///< Pairs of triangles that meet: the segments of the curve in which the surfaces meet.
};

/// Exact overlap of two solids at a pose, without building the intersection, at a cost that follows the length of the
/// curve in which the surfaces meet.
///
/// Every decision is exact (predicates.h) for B's vertices rounded to doubles in A's frame, so equal faces, shared
/// vertices and slivers are no special cases; what is left is the rounding of the integrals. Error of volume: a small
/// multiple of 1e-16 * (size + distance of the bodies from the origin of A's frame) * (area of the triangles that are
/// cut), whatever the volume.
///
/// Method: area and moment are integrals along the curve (Stokes). Volume and first moment are fluxes through the parts
/// of both surfaces that the curve bounds, by the potentials of Solid. Per segment of the curve each of the two
/// triangles adds the flux of the triangle (lowest corner, start, end); a segment that ends on the side opposite the
/// lowest corner adds a potential and the flux of the triangle (lowest corner, middle corner, end). Crossings neither
/// know nor need their neighbours.
///
/// Cost: with the curve, not the surface. A bumpy torus on itself at 10 % of its volume, 1e3, 1e4, 1e5, 1e6 triangles:
/// 145, 453, 1436, 4537 crossings and 0.04, 0.17, 0.74, 3.2 ms of processor time (overlap_benchmark
/// --benchmark_filter=by:exact/.*/volume:10, in test/reference, AMD EPYC). At 1e5, by perf: 35 % finding candidates in
/// the trees, 30 % crossing points, 26 % sums over crossings.
///
/// One thread at a time; any number of objects may share the solids. No allocation once the scratch has grown.
class OverlapQuery {
 public:
  /// Both solids outlive this object.
  OverlapQuery(const Solid& a, const Solid& b) : a_(&a), b_(&b) {}

  /// @param reference the point (A's frame) about which the moment is taken.
  /// @throws BadArgument if the pose is not finite.
  Overlap evaluate(const Pose& X_AB, const Eigen::Vector3d& reference);

  /// The same bits from the pairs of triangles that may meet, in the order of find_candidates() and any more of them.
  Overlap evaluate(const Pose& X_AB, const Eigen::Vector3d& reference, std::span<const CandidatePair> pairs);

  /// About the centre of B's bounding box.
  Overlap evaluate(const Pose& X_AB) { return evaluate(X_AB, X_AB * b_->mesh().center()); }

  std::size_t bytes() const;

 private:
  int winding_of_b(const Pose& X_AB, const Eigen::Vector3d& p_A);
  int winding_of_a(const Pose& X_AB, const Eigen::Vector3d& p_B);

  const Solid* a_;
  const Solid* b_;
  std::vector<CandidatePair> pairs_;
  std::vector<std::uint32_t> triangles_;
};

}  // namespace sixdof
