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

/// Lanes in which all corners lie on one side of a plane, by more than `tolerance`.
HWY_INLINE M on_one_side(const PlaneRange& range, V tolerance) {
  return hn::Or(hn::Gt(range.low, tolerance), hn::Lt(range.high, hn::Neg(tolerance)));
}

/// Pairs of triangles (bits) that may intersect: by their boxes, and by both planes.
HWY_INLINE std::uint32_t test_triangles(const LeafLanes& a, const LeafLanes& b, float slack) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_pairs; i += hn::Lanes(k_lanes)) {
    M apart = no_lane();
    for (std::size_t k = 0; k < 3; ++k) {
      apart = hn::Or(apart, hn::Gt(load_of_a(a.lower[k], i), load_of_b(b.upper[k], i)));
      apart = hn::Or(apart, hn::Gt(load_of_b(b.lower[k], i), load_of_a(a.upper[k], i)));
    }
    if (hn::AllTrue(k_lanes, apart)) continue;
    const PairLanes p(a, b, i, slack);
    apart = hn::Or(apart, on_one_side({p.normal_a, p.corner_a[0], p.corner_b}, p.tolerance_a));
    apart = hn::Or(apart, on_one_side({p.normal_b, p.corner_b[0], p.corner_a}, p.tolerance_b));
    bits |= bits_of(hn::Not(apart), i);
  }
  return bits;
}

void find_candidates(const Tree& a, const Tree& b, const Pose& X_AB, std::vector<TrianglePair>& pairs) {
  const TreeMotion motion(a, b, X_AB, Eigen::Vector3d::Zero());
  const auto test = [&](Tree::Child leaf_a, const LeafLanes& of_a, Tree::Child leaf_b, const LeafLanes& of_b) {
    for_each_pair(test_triangles(of_a, of_b, motion.slack), leaf_a, leaf_b,
                  [&](std::uint32_t, TrianglePair pair) { pairs.push_back(pair); });
  };
  DualTreeTraversal<false, decltype(test)>(a, b, motion, test).run();
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::candidates
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof {

namespace candidates {
HWY_EXPORT(find_candidates);
}

void find_candidates(const Tree& a, const Tree& b, const Pose& X_AB, std::vector<TrianglePair>& pairs) {
  pairs.clear();
  HWY_DYNAMIC_DISPATCH(candidates::find_candidates)(a, b, X_AB, pairs);
}

}  // namespace sixdof
#endif  // HWY_ONCE
