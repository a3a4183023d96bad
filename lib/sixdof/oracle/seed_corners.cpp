#include <sixdof/oracle/seed_corners.h>

#include <sixdof/base/simd_targets.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/seed_corners.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/proximity/lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::detail {
namespace HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;

/// Squared distances of a node's boxes from p.
void bound_corners(const Tree::Node& node, const float (&p)[3], float* HWY_RESTRICT bounds) {
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    V squared = hn::Zero(k_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      const V at = set(p[k]);
      const V below = hn::Sub(load(node.lower[k] + i), at);
      const V above = hn::Sub(at, load(node.upper[k] + i));
      const V gap = hn::Max(hn::Max(below, above), hn::Zero(k_lanes));
      squared = unfused_mul_add(gap, gap, squared);
    }
    hn::Store(squared, k_lanes, bounds + i);
  }
}

/// Square of the distance of p from the closest corner of a leaf.
float least_squared(const Tree::Leaf& leaf, const float (&p)[3]) {
  const hn::CappedTag<float, Tree::k_leaf_triangles> d;
  auto least = hn::Set(d, Tree::k_empty);
  for (std::size_t corner = 0; corner < 3; ++corner) {
    for (std::size_t t = 0; t < Tree::k_leaf_triangles; t += hn::Lanes(d)) {
      auto squared = hn::Zero(d);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto offset = hn::Sub(hn::Load(d, leaf.corner[corner][k] + t), hn::Set(d, p[k]));
        squared = unfused_mul_add(offset, offset, squared);
      }
      least = hn::Min(least, squared);
    }
  }
  return hn::GetLane(hn::MinOfLanes(d, least));
}

/// Takes a corner of a leaf that is closer than `best`.
bool take_closer_corner(const Tree::Leaf& leaf, std::uint32_t index, const float (&p)[3], Corner& best) {
  if (least_squared(leaf, p) >= best.squared) return false;
  bool found = false;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    for (std::uint32_t t = 0; t < leaf.child.count(); ++t) {
      const float q[3] = {leaf.corner[corner][0][t], leaf.corner[corner][1][t], leaf.corner[corner][2][t]};
      float squared = 0.0f;
      for (std::size_t k = 0; k < 3; ++k) squared += (q[k] - p[k]) * (q[k] - p[k]);
      if (squared >= best.squared) continue;
      best = {squared, index, t, {q[0], q[1], q[2]}};
      found = true;
    }
  }
  return found;
}

bool find_corner(const Tree& tree, const float (&p)[3], const CornerEffort& effort, Corner& best,
                 std::vector<CornerVolume>& stack) {
  // A leaf's area is about radius^2 / leaves.
  const float equal =
      effort.leaf_areas * static_cast<float>(tree.radius() * tree.radius() / static_cast<double>(tree.leaves().size()));
  const float tolerance = effort.tolerance;
  int leaves = 0;
  bool found = false;
  stack.assign(1, {Tree::Child::node(0), 0, 0.0f});
  while (!stack.empty() && leaves < effort.most_leaves) {
    const CornerVolume top = stack.back();
    stack.pop_back();
    if (tolerance * top.lower + equal >= best.squared) continue;
    if (top.child.is_leaf()) {
      ++leaves;
      found |= take_closer_corner(tree.leaves()[top.leaf], top.leaf, p, best);
      continue;
    }
    const Tree::Node& node = tree.nodes()[top.child.node()];
    HWY_ALIGN float bounds[k_width];
    bound_corners(node, p, bounds);
    const std::size_t first = stack.size();
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      if (tolerance * bounds[i] + equal >= best.squared) continue;
      push_sorted(stack, first, {node.child[i], node.leaf(i), bounds[i]});
    }
  }
  return found;
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::detail {

HWY_EXPORT(find_corner);

bool find_corner(const Tree& tree, const float (&p)[3], const CornerEffort& effort, Corner& best,
                 std::vector<CornerVolume>& stack) {
  return HWY_DYNAMIC_DISPATCH(find_corner)(tree, p, effort, best, stack);
}

SeedCorners::SeedCorners(const Tree& tree) {
  for (std::size_t i = 0; i < k_count; ++i) {
    leaf[i] = static_cast<std::uint32_t>((2 * i + 1) * tree.leaves().size() / (2 * k_count));
    for (std::size_t k = 0; k < 3; ++k) point[k][i] = tree.leaves()[leaf[i]].corner[0][k][0];
  }
}

}  // namespace sixdof::detail
#endif  // HWY_ONCE
