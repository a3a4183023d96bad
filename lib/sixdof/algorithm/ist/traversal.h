#pragma once

#include <cstdint>

#include <sixdof/algorithm/ist/hierarchy.h>
#include <sixdof/algorithm/ist/node_pair.h>
#include <sixdof/geometry/pose.h>

namespace sixdof::ist {

/// Magnitude of the force between two overlapping leaf spheres; it always acts along the line of their centres.
enum class PairForce {
  volume,    ///< The overlap's volume (Weller and Zachmann 2009).
  gradient,  ///< The overlap's disc area, i.e. minus the derivative of the volume: the sum is -grad of the summed
             ///< volume.
};

/// Memory that a traversal reuses from query to query.
struct TraversalScratch {
  PairList waiting;  ///< Pairs of nodes to be opened.
  PairList leaves;   ///< Pairs of leaves that may overlap.
};

struct TraversalCount {
  std::uint64_t sphere_tests = 0;  ///< Pairs of balls tested, inner and leaf.
  std::uint64_t leaf_pairs = 0;    ///< Overlapping pairs of leaf spheres summed.
};

/// Sums over pairs of leaf spheres, or their estimate where a budget ran out. Vectors in A's frame, acting on B.
struct PenetrationSum {
  double volume = 0.0;                               ///< Sum of the pairwise overlap volumes.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< Sum of the pair forces, unit stiffness.
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< Their moment about the point `about`.
  /// Sums of V (p - about) and of V |p - about|^2, p the middle of a pair's overlap and V its volume: where the overlap
  /// is, and how far it spreads. Of PairForce::gradient only.
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  double second = 0.0;
  bool complete = true;  ///< False if a budget cut the traversal short.
  TraversalCount count;
};

struct SphereContact {
  bool any = false;  ///< Two leaf spheres overlap.
  TraversalCount count;
};

struct SphereSeparation {
  /// Smallest gap between two leaf spheres; negative where they overlap (then any overlap found).
  double distance = 0.0;
  std::int32_t leaf_a = 0, leaf_b = 0;
  TraversalCount count;
};

/// Penetration volume, force, and moment about `about` (A's frame). Complete and exact for the two sphere sets.
PenetrationSum penetration(const SphereTree& a, const SphereTree& b, const Pose& X_AB, PairForce law,
                           const Eigen::Vector3d& about, TraversalScratch& scratch);

/// The same within a budget of sphere tests (time-critical variant, Weller and Zachmann 2009): pairs of nodes are
/// opened in the order of their expected overlap; those not opened when the budget is spent count with it. Expected
/// overlap of two balls: the volume of their lens times both balls' leaf density, acting along their centres. A count
/// instead of a clock keeps the answer reproducible.
PenetrationSum penetration_within(const SphereTree& a, const SphereTree& b, const Pose& X_AB, PairForce law,
                                  const Eigen::Vector3d& about, std::uint64_t budget);

/// Stops at the first two leaf spheres that overlap.
SphereContact overlaps(const SphereTree& a, const SphereTree& b, const Pose& X_AB, TraversalScratch& scratch);

/// Smallest gap of two leaf spheres by branch and bound.
SphereSeparation separation(const SphereTree& a, const SphereTree& b, const Pose& X_AB);

}  // namespace sixdof::ist
