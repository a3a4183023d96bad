#pragma once

#include <cstdint>

#include <Eigen/Core>

#include <sixdof/algorithm/ist/hierarchy.h>
#include <sixdof/algorithm/ist/node_pair.h>
#include <sixdof/geometry/pose.h>

namespace sixdof::ist {

/// Magnitude of the force between two overlapping leaf spheres; it acts along the line of their centres.
enum class PairForce {
  volume,    ///< The overlap's volume (Weller and Zachmann 2009).
  gradient,  ///< The area of the disc bounded by the circle in which the spheres meet, which is minus the derivative of
             ///< the volume by the distance of the centres: the sum is minus the gradient of the summed volume.
};

/// Memory that traversals reuse.
struct TraversalScratch {
  PairList node_pairs;  ///< To be expanded.
  PairList leaf_pairs;  ///< That may overlap.
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
/// of nodes are expanded in the order of their expected overlap; those that the budget does not cover are added with
/// it. The expected overlap of two balls is the overlap volume of the balls times the density of the leaves in both,
/// with a force along the line of centres. A budget of tests, unlike one of time, gives reproducible answers.
PenetrationSum penetration_within_budget(const SphereTree& a, const SphereTree& b, const Pose& X_AB, PairForce law,
                                         const Eigen::Vector3d& about, std::uint64_t budget);

/// Stops at the first two leaf spheres that overlap.
SphereContact overlaps(const SphereTree& a, const SphereTree& b, const Pose& X_AB, TraversalScratch& scratch);

/// Smallest gap of two leaf spheres, by branch and bound.
SphereSeparation separation(const SphereTree& a, const SphereTree& b, const Pose& X_AB);

}  // namespace sixdof::ist
