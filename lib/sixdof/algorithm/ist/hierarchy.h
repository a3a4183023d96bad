#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <sixdof/algorithm/ist/sphere.h>

namespace sixdof::ist {

/// One node: its up to four children's balls side by side, so that sixteen of the balls of two nodes are tested at
/// once; one cache line. In single precision, relative to the centre of the tree's bound and in units of its radius; a
/// ball is rounded up, so it still contains all leaf spheres below it. Children fill the slots from the first on; empty
/// slots have radius -infinity.
struct alignas(64) SphereNode {
  static constexpr std::size_t k_slots = 4;
  std::array<float, k_slots> x, y, z, r;
};

/// Inner sphere tree: leaves are the packed spheres; an inner node's ball contains all LEAF spheres below it
/// ("wrapped", Weller and Zachmann 2009), which is tighter than containing the children's balls. A node's children are
/// all nodes or all leaves; a leaf among nodes is the only one of a node of its own.
struct SphereTree {
  std::vector<SphereNode> nodes;    ///< nodes[0] is the root; a node's children are neighbours.
  std::vector<std::int32_t> below;  ///< Per node: the child in its first slot; >= 0: a node; < 0: ~index of a leaf.
  /// Per node and slot: sum of the leaf volumes, each times its share.
  std::vector<std::array<double, SphereNode::k_slots>> volumes;
  std::vector<Sphere> leaves;  ///< In tree order: a subtree's leaves are neighbours.
  std::vector<double> shares;  ///< How much a leaf's overlaps count; empty: 1 each.
  Sphere bound;                ///< Contains all leaves.
  double volume = 0.0;         ///< Of all leaves, as `volumes`.

  std::size_t children(std::size_t node) const {
    const auto& r = nodes[node].r;
    return static_cast<std::size_t>(std::count_if(r.begin(), r.end(), [](float radius) { return radius >= 0.0f; }));
  }
  /// The ball of a child, in the mesh's frame and length unit.
  Sphere ball(std::size_t node, std::size_t slot) const {
    const SphereNode& n = nodes[node];
    return {bound.center + bound.radius * Eigen::Vector3d(n.x[slot], n.y[slot], n.z[slot]), bound.radius * n.r[slot]};
  }
  double share(std::int32_t leaf) const { return shares.empty() ? 1.0 : shares[static_cast<std::size_t>(leaf)]; }
  std::size_t bytes() const {
    return nodes.size() * (sizeof(SphereNode) + sizeof(below[0]) + sizeof(volumes[0])) +
           leaves.size() * sizeof(Sphere) + shares.size() * sizeof(double);
  }
};

/// Builds the hierarchy top-down: each node's spheres are split in four by batch neural gas with volume-weighted
/// magnification (Weller and Zachmann 2009; Cottrell et al. 2006):
///   w_i = sum_j h(k_ij) v_j x_j / sum_j h(k_ij) v_j,  h(k) = exp(-k / lambda),  lambda_t = lambda_0 (0.01 /
///   lambda_0)^(t / T),
/// with k_ij the rank of prototype i by distance from sphere j, v_j its volume, lambda_0 = 4 / 2. The last 16 spheres
/// are shared out evenly among up to four nodes of leaves instead.
/// Deterministic, whatever the number of threads. @throws BadArgument if there is no sphere.
SphereTree build_sphere_tree(std::vector<Sphere> spheres);

/// Makes every leaf's overlaps count `shares` times, one per leaf in tree order; sums of volumes follow.
void set_shares(SphereTree& tree, std::vector<double> shares);

}  // namespace sixdof::ist
