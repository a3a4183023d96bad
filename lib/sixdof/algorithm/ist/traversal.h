#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <sixdof/algorithm/ist/hierarchy.h>
#include <sixdof/geometry/pose.h>

namespace sixdof::ist {

/// Force on B of two overlapping leaf spheres, s of A and t of B. V is the volume of their overlap.
enum class PairForce {
  /// V (n_s - n_t) / 2, n the axes of the spheres' normal cones, through the centre of mass of the overlap (Weller and
  /// Zachmann 2009). A's axis leads t out of A, and B's axis leads s out of B. If one sphere has no axis, V times
  /// that of the other one; if neither has, V along the line of centres.
  cones,
  volume,    ///< V along the line of their centres.
  gradient,  ///< Along the line of centres; the area of the disc bounded by the circle in which the spheres meet, which
             ///< is minus the derivative of the volume by the distance of the centres: the sum is minus the gradient of
             ///< the summed volume.
};

/// Maps the coordinates of B's nodes to those of A's nodes: p -> rotation p + translation, in single precision and in
/// units of the radius of A's bound.
struct NodeTransform {
  Eigen::Matrix3f rotation;  ///< Times `ratio`.
  Eigen::Vector3f translation;
  float ratio = 1.0f;  ///< Radius of B's bound over that of A's.
  float slack = 0.0f;  ///< Bound on the rounding errors of a distance of two centres less a sum of two radii, see of().
  bool apart = false;  ///< The trees' bounds are disjoint; nothing else is set.

  static NodeTransform of(const SphereTree& a, const SphereTree& b, const Pose& X_AB);
};

/// Pairs of indices into two trees. The arrays grow and never shrink; their users keep the number of pairs.
struct PairList {
  std::vector<std::int32_t> a, b;

  void make_room(std::size_t pairs) {
    if (pairs <= a.size()) return;
    const std::size_t size = std::max(pairs, 2 * a.size());
    a.resize(size);
    b.resize(size);
  }
};

/// Memory that traversals reuse.
struct TraversalScratch {
  PairList node_pairs, leaf_pairs;
};

struct TraversalCount {
  std::uint64_t sphere_tests = 0;  ///< Pairs of balls tested: of inner nodes and of leaves, empty slots included.
  std::uint64_t leaf_pairs = 0;    ///< Pairs of leaf spheres that overlap.
};

/// Sums over pairs of overlapping leaf spheres. Vectors are in A's frame; the force acts on B, with unit stiffness.
struct PenetrationSum {
  double volume = 0.0;                               ///< Of the pairs' overlaps (length^3).
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< Of the pairs' forces.
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< Of the pairs' moments about the point `about`.
  /// Of V (p - about) and V |p - about|^2, where V is the volume and p the middle of a pair's overlap. Only with
  /// PairForce::gradient.
  Eigen::Vector3d first_moment = Eigen::Vector3d::Zero();
  double second_moment = 0.0;
  TraversalCount count;
};

struct SphereContact {
  bool any = false;  ///< Two leaf spheres overlap.
  TraversalCount count;
};

struct SphereSeparation {
  /// Smallest gap between two leaf spheres; where spheres overlap, some negative gap.
  double distance = 0.0;
  std::int32_t leaf_a = 0, leaf_b = 0;
  TraversalCount count;
};

/// Sums over all pairs of overlapping leaf spheres.
/// @param about reference point of the moments, in A's frame
PenetrationSum penetration(const SphereTree& a, const SphereTree& b, const Pose& X_AB, PairForce law,
                           const Eigen::Vector3d& about, TraversalScratch& scratch);

/// Estimate of the same sums within a budget of sphere tests (time-critical variant, Weller and Zachmann 2009). Pairs
/// of nodes are expanded in the order of their expected overlap, and those beyond the budget are added with it: the
/// overlap volume of two balls times the density of the leaves in both, with a force along the line of centres. That is
/// so with PairForce::cones, too: balls have no axis.
PenetrationSum penetration_within_budget(const SphereTree& a, const SphereTree& b, const Pose& X_AB, PairForce law,
                                         const Eigen::Vector3d& about, std::uint64_t budget);

/// Stops at the first two leaf spheres that overlap.
SphereContact overlaps(const SphereTree& a, const SphereTree& b, const Pose& X_AB, TraversalScratch& scratch);

/// Smallest gap of two leaf spheres, by branch and bound.
SphereSeparation separation(const SphereTree& a, const SphereTree& b, const Pose& X_AB);

/// Force and moment on B, in the frame and about the point of the sum they come from.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
};

/// A wrench with the overlap volume V as magnitude and the direction in which V decreases fastest: V g / |g| for the
/// wrench g of `sum`, a sum of PairForce::gradient.
///
/// |g|^2 = |f|^2 + |m|^2 / l^2, with m the moment about the overlap's centroid and l its radius of gyration about it.
/// So the result does not depend on the reference point, on which body is called A, or on the unit of length. If m = 0,
/// |force| = V; if f = 0, |moment| = V l. Zero where the gradient vanishes. It derives from no potential.
Wrench steepest_descent(const PenetrationSum& sum);

}  // namespace sixdof::ist
