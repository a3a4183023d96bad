#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <sixdof/algorithm/ist/sphere.h>

namespace sixdof::ist {

/// The bounding spheres ("balls") of a node's up to four children, as arrays over the children: one cache line. In
/// single precision, relative to the centre of the tree's bound and in units of its radius; radii are rounded up.
/// Children fill the first slots; empty slots have radius -infinity.
struct alignas(64) SphereNode {
  static constexpr std::size_t k_slots = 4;
  std::array<float, k_slots> x, y, z, r;
};

/// Inner sphere tree. Its leaves are the packed spheres. A ball contains all LEAF spheres below it ("wrapped", Weller
/// and Zachmann 2009). The children of a node are either all nodes or all leaves.
struct SphereTree {
  std::vector<SphereNode> nodes;          ///< nodes[0] is the root; the children of a node are consecutive.
  std::vector<std::int32_t> first_child;  ///< Per node: index of a node, or ~index of a leaf (then negative).
  /// Per node and slot: sum of the volumes of the leaves below, each times its weight (length^3).
  std::vector<std::array<double, SphereNode::k_slots>> volumes;
  std::vector<Sphere> leaves;   ///< In tree order: the leaves of a subtree are consecutive.
  std::vector<double> weights;  ///< Per leaf: factor of its overlap volumes; empty: 1 each.
  /// Per leaf: axis of its normal cone, or zero (normal_cone.h); empty: zero each. In the mesh's frame.
  std::vector<Eigen::Vector3d> axes;
  Sphere bound;         ///< Contains all leaves.
  double volume = 0.0;  ///< Of all leaves, weighted as `volumes`.

  std::size_t children(std::size_t node) const {
    const auto& r = nodes[node].r;
    return static_cast<std::size_t>(std::count_if(r.begin(), r.end(), [](float radius) { return radius >= 0.0f; }));
  }
  /// The ball of a child, in the mesh's frame and length unit.
  Sphere ball(std::size_t node, std::size_t slot) const {
    const SphereNode& n = nodes[node];
    return {bound.center + bound.radius * Eigen::Vector3d(n.x[slot], n.y[slot], n.z[slot]), bound.radius * n.r[slot]};
  }
  double weight(std::int32_t leaf) const { return weights.empty() ? 1.0 : weights[static_cast<std::size_t>(leaf)]; }
  Eigen::Vector3d axis(std::int32_t leaf) const {
    if (axes.empty()) return Eigen::Vector3d::Zero();
    return axes[static_cast<std::size_t>(leaf)];
  }
  std::size_t bytes() const {
    return nodes.size() * (sizeof(SphereNode) + sizeof(first_child[0]) + sizeof(volumes[0])) +
           leaves.size() * sizeof(Sphere) + weights.size() * sizeof(double) + axes.size() * sizeof(Eigen::Vector3d);
  }
};

/// Builds the hierarchy top-down. A node's spheres are split in four by batch neural gas with volume-weighted
/// magnification (Weller and Zachmann 2009; Cottrell et al. 2006):
///   w_i = sum_j h(k_ij) v_j x_j / sum_j h(k_ij) v_j,  h(k) = exp(-k / lambda),
///   lambda_t = lambda_0 (0.01 / lambda_0)^(t / T),  lambda_0 = 4 / 2,
/// with k_ij the rank of prototype i by distance from sphere j and v_j the sphere's volume. Up to 16 spheres are split
/// evenly instead, so that nodes of leaves are nearly full. The same bits for every number of threads. @throws
/// BadArgument if there is no sphere.
SphereTree build_sphere_tree(std::vector<Sphere> spheres);

/// Sets the weight of every leaf, in tree order, and updates the sums of volumes.
void set_weights(SphereTree& tree, std::vector<double> weights);

}  // namespace sixdof::ist
