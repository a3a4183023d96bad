#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <sixdof/algorithm/ist/sphere.h>

namespace sixdof::ist {

/// One node: its up to four children side by side, so that one vector instruction tests them all. Empty slots have
/// radius -infinity: every overlap test with them fails.
struct alignas(32) SphereNode {
  static constexpr std::int32_t k_empty = INT32_MIN;
  std::array<double, 4> x, y, z, r;
  std::array<double, 4> volume;       ///< Sum of the leaf volumes below, for estimates.
  std::array<std::int32_t, 4> child;  ///< >= 0: index of a node; < 0: ~index of a leaf sphere; k_empty: none.

  Sphere sphere(std::size_t slot) const { return {{x[slot], y[slot], z[slot]}, r[slot]}; }
};

/// Inner sphere tree: leaves are the packed spheres; an inner node's ball contains all LEAF spheres below it
/// ("wrapped", Weller and Zachmann 2009), which is tighter than containing the children's balls.
struct SphereTree {
  std::vector<SphereNode> nodes;  ///< nodes[0] is the root.
  std::vector<Sphere> leaves;     ///< In tree order: a subtree's leaves are neighbours.
  Sphere bound;                   ///< Contains all leaves.
  double volume = 0.0;            ///< Sum of the leaf volumes.

  std::size_t bytes() const { return nodes.size() * sizeof(SphereNode) + leaves.size() * sizeof(Sphere); }
};

/// Builds the hierarchy top-down: each node's spheres are split in four by batch neural gas with volume-weighted
/// magnification (Weller and Zachmann 2009; Cottrell et al. 2006):
///   w_i = sum_j h(k_ij) v_j x_j / sum_j h(k_ij) v_j,  h(k) = exp(-k / lambda),  lambda_t = lambda_0 (0.01 /
///   lambda_0)^(t / T),
/// with k_ij the rank of prototype i by distance from sphere j, v_j its volume, lambda_0 = 4 / 2.
/// Deterministic, whatever the number of threads. @throws BadArgument if there is no sphere.
SphereTree build_sphere_tree(std::vector<Sphere> spheres);

}  // namespace sixdof::ist
