#include <sixdof/oracle/candidates.h>


#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/candidates.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/oracle/candidates-inl.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::candidates {
namespace HWY_NAMESPACE {

/// Lanes in which all corners lie strictly on one side of a plane, by more than `tolerance`.
HWY_INLINE M on_one_side(const V (&normal)[3], const V (&origin)[3], const V (&corner)[3][3], V tolerance) {
  V height[3];
  for (std::size_t c = 0; c < 3; ++c) {
    height[c] = hn::Mul(normal[0], hn::Sub(corner[c][0], origin[0]));
    height[c] = mul_add(normal[1], hn::Sub(corner[c][1], origin[1]), height[c]);
    height[c] = mul_add(normal[2], hn::Sub(corner[c][2], origin[2]), height[c]);
  }
  const V lowest = hn::Min(hn::Min(height[0], height[1]), height[2]);
  const V highest = hn::Max(hn::Max(height[0], height[1]), height[2]);
  return hn::Or(hn::Gt(lowest, tolerance), hn::Lt(highest, hn::Neg(tolerance)));
}

/// Pairs of triangles that may meet: bit 4 i + j.
HWY_INLINE std::uint32_t meeting_triangles(const LeafLanes& a, const LeafLanes& b, float slack) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_pairs; i += hn::Lanes(k_lanes)) {
    const auto of_a = [i](const float* p) { return load_of_a(p, i); };
    const auto of_b = [i](const float* p) { return load_of_b(p, i); };
    M apart = none();
    for (std::size_t k = 0; k < 3; ++k) {
      apart = hn::Or(apart, hn::Gt(of_a(a.lower[k]), of_b(b.upper[k])));
      apart = hn::Or(apart, hn::Gt(of_b(b.lower[k]), of_a(a.upper[k])));
    }
    if (hn::AllTrue(k_lanes, apart)) continue;
    V corner_a[3][3], corner_b[3][3], normal_a[3], normal_b[3];
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        corner_a[c][k] = of_a(a.corner[c][k]);
        corner_b[c][k] = of_b(b.corner[c][k]);
      }
      normal_a[k] = of_a(a.normal[k]);
      normal_b[k] = of_b(b.normal[k]);
    }
    V tolerance_a, tolerance_b;
    height_tolerances(of_a(a.size), of_b(b.size), slack, tolerance_a, tolerance_b);
    apart = hn::Or(apart, on_one_side(normal_a, corner_a[0], corner_b, tolerance_a));
    apart = hn::Or(apart, on_one_side(normal_b, corner_b[0], corner_a, tolerance_b));
    HWY_ALIGN std::uint8_t stored[8] = {};
    hn::StoreMaskBits(k_lanes, hn::Not(apart), stored);
    bits |= static_cast<std::uint32_t>(stored[0]) << i;
  }
  return bits;
}

void find_candidates_here(const Tree& a, const Tree& b, const Pose& X_AB, std::vector<CandidatePair>& pairs) {
  const Placement placement(a, b, X_AB, Eigen::Vector3d::Zero());
  const auto meet = [&](Tree::Child leaf_a, const LeafLanes& of_a, Tree::Child leaf_b, const LeafLanes& of_b) {
    for_each_pair(meeting_triangles(of_a, of_b, placement.slack), leaf_a, leaf_b,
                  [&](std::uint32_t, CandidatePair pair) { pairs.push_back(pair); });
  };
  Descent<false, decltype(meet)>(a, b, placement, meet).visit(0, 0, ~0u, ~0u);
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::candidates
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof {

namespace candidates {
HWY_EXPORT(find_candidates_here);
}

void find_candidates(const Tree& a, const Tree& b, const Pose& X_AB, std::vector<CandidatePair>& pairs) {
  pairs.clear();
  HWY_DYNAMIC_DISPATCH(candidates::find_candidates_here)(a, b, X_AB, pairs);
}

void find_in_box(const Tree& tree, const Eigen::AlignedBox3d& box, std::vector<std::uint32_t>& triangles) {
  triangles.clear();
  // Rounding to float, and of the difference from the tree's centre.
  const double slack = 1e-6 * (tree.radius() + box.diagonal().norm()) + 1e-15 * tree.center().lpNorm<1>();
  float lower[3], upper[3];
  for (int k = 0; k < 3; ++k) {
    lower[k] = static_cast<float>(box.min()[k] - tree.center()[k] - slack);
    upper[k] = static_cast<float>(box.max()[k] - tree.center()[k] + slack);
  }
  const auto visit = [&](auto&& self, const Tree::Node& node) -> void {
    for (std::size_t i = 0; i < node.child_count; ++i) {
      bool apart = false;
      for (std::size_t k = 0; k < 3; ++k) apart = apart || node.lower[k][i] > upper[k] || node.upper[k][i] < lower[k];
      if (apart) continue;
      const Tree::Child child = node.child[i];
      if (!child.is_leaf()) {
        self(self, tree.nodes()[child.node()]);
        continue;
      }
      for (std::uint32_t t = child.first(); t < child.first() + child.count(); ++t) triangles.push_back(t);
    }
  };
  visit(visit, tree.nodes()[0]);
}

}  // namespace sixdof
#endif  // HWY_ONCE
