#include <sixdof/oracle/swept_candidates.h>

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/swept_candidates.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/oracle/candidates-inl.h>

// A separating-axis test of two triangles (boxes along each axis, both planes) is linear in the displacement's
// fraction, so each test gives the interval of fractions at which it does not separate the triangles. They may
// intersect in the intersection of these intervals.

HWY_BEFORE_NAMESPACE();
namespace sixdof::candidates {
namespace HWY_NAMESPACE {

/// Magnitude of a fraction that is not bounded.
constexpr float k_unbounded = 1e9f;

/// To the fractions x with low <= speed x <= high. Lanes with a speed so small that rounding loses speed x stay.
HWY_INLINE void narrow_to_linear(V low, V high, V speed, FractionInterval& interval) {
  constexpr float k_lost = 1e-30f;
  const M still = hn::Le(hn::Abs(speed), hn::Set(k_lanes, k_lost));
  const V inverse = hn::Div(hn::Set(k_lanes, 1.0f), hn::IfThenElse(still, hn::Set(k_lanes, 1.0f), speed));
  const V x = hn::Mul(low, inverse), y = hn::Mul(high, inverse);
  interval.first = hn::Max(interval.first, hn::IfThenElse(still, hn::Set(k_lanes, -k_unbounded), hn::Min(x, y)));
  interval.last = hn::Min(interval.last, hn::IfThenElse(still, hn::Set(k_lanes, k_unbounded), hn::Max(x, y)));
}

/// Pairs of triangles (bits) that may intersect at a fraction in 0 .. 1, and the intervals of all pairs.
HWY_INLINE std::uint32_t test_moving_triangles(const LeafLanes& a, const LeafLanes& b, const TreeMotion& x,
                                               float* first, float* last) {
  std::uint32_t bits = 0;
  const V zero = hn::Zero(k_lanes);
  const V one = hn::Set(k_lanes, 1.0f);
  const V displacement[3] = {hn::Set(k_lanes, x.displacement[0]), hn::Set(k_lanes, x.displacement[1]),
                             hn::Set(k_lanes, x.displacement[2])};
  for (std::size_t i = 0; i < k_pairs; i += hn::Lanes(k_lanes)) {
    const auto of_a = [i](const float* p) { return load_of_a(p, i); };
    const auto of_b = [i](const float* p) { return load_of_b(p, i); };
    FractionInterval interval{hn::Set(k_lanes, -k_unbounded), hn::Set(k_lanes, k_unbounded)};
    for (std::size_t k = 0; k < 3; ++k) {  // B's boxes include the slack
      interval.narrow_to_boxes(of_a(a.lower[k]), of_a(a.upper[k]), of_b(b.lower[k]), of_b(b.upper[k]), k, x);
    }
    const auto store = [&] {  // returns the lanes whose interval contains a fraction in 0 .. 1
      const V pad = hn::Set(k_lanes, k_fraction_rounding);
      const V low = hn::Sub(hn::Max(interval.first, hn::Neg(one)), pad);
      const V high = hn::Add(hn::Min(interval.last, hn::Add(one, one)), pad);
      hn::StoreU(low, k_lanes, first + i);
      hn::StoreU(high, k_lanes, last + i);
      return hn::And(hn::Le(low, high), hn::And(hn::Le(low, one), hn::Ge(high, zero)));
    };
    if (hn::AllFalse(k_lanes, store())) continue;
    PairLanes p(a, b, i, x.slack);
    // Rounding of the products of normals, of up to the square of a size, with differences as long as the displacement.
    const V rounding = hn::Set(
        k_lanes, 1e-6f * (std::abs(x.displacement[0]) + std::abs(x.displacement[1]) + std::abs(x.displacement[2])));
    p.tolerance_a = unfused_mul_add(rounding, hn::Mul(of_a(a.size), of_a(a.size)), p.tolerance_a);
    p.tolerance_b = unfused_mul_add(rounding, hn::Mul(of_b(b.size), of_b(b.size)), p.tolerance_b);
    const auto along = [&](const V(&normal)[3]) {
      return unfused_mul_add(normal[2], displacement[2],
                             unfused_mul_add(normal[1], displacement[1], hn::Mul(normal[0], displacement[0])));
    };
    {  // B's corners and A's plane: distances increase by the displacement along the normal.
      const PlaneRange range(p.normal_a, p.corner_a[0], p.corner_b);
      narrow_to_linear(hn::Sub(hn::Neg(p.tolerance_a), range.high), hn::Sub(p.tolerance_a, range.low),
                       along(p.normal_a), interval);
    }
    {  // A's corners and B's plane: they decrease.
      const PlaneRange range(p.normal_b, p.corner_b[0], p.corner_a);
      narrow_to_linear(hn::Sub(range.low, p.tolerance_b), hn::Add(range.high, p.tolerance_b), along(p.normal_b),
                       interval);
    }
    bits |= bits_of(store(), i);
  }
  return bits;
}

void find_swept_candidates(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement,
                           SweptCandidates& found) {
  const TreeMotion motion(a, b, X_AB, displacement);
  const auto test = [&](Tree::Child leaf_a, const LeafLanes& of_a, Tree::Child leaf_b, const LeafLanes& of_b) {
    float first[k_pairs], last[k_pairs];
    const std::uint32_t bits = test_moving_triangles(of_a, of_b, motion, first, last);
    for_each_pair(bits, leaf_a, leaf_b, [&](std::uint32_t lane, TrianglePair pair) {
      found.pairs.push_back(pair);
      found.first.push_back(first[lane]);
      found.last.push_back(last[lane]);
    });
  };
  DualTreeTraversal<true, decltype(test)>(a, b, motion, test).run();
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::candidates
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof {

namespace candidates {
HWY_EXPORT(find_swept_candidates);
}

void find_swept_candidates(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement,
                           SweptCandidates& found) {
  found.pairs.clear();
  found.first.clear();
  found.last.clear();
  HWY_DYNAMIC_DISPATCH(candidates::find_swept_candidates)(a, b, X_AB, displacement, found);
}

void select_candidates(const SweptCandidates& swept, double x, std::vector<TrianglePair>& pairs) {
  const auto fraction = static_cast<float>(x);  // intervals are padded by more than this rounds
  pairs.resize(swept.pairs.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < swept.pairs.size(); ++i) {
    pairs[count] = swept.pairs[i];
    count += swept.first[i] <= fraction && fraction <= swept.last[i] ? 1 : 0;
  }
  pairs.resize(count);
}

}  // namespace sixdof
#endif  // HWY_ONCE
