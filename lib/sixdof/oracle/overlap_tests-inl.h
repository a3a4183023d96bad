// Part of candidates_bounds-inl.h and triangle_pairs-inl.h. Taken once per instruction set: the guard is Highway's for
// that.
#if defined(SIXDOF_ORACLE_OVERLAP_TESTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_ORACLE_OVERLAP_TESTS_INL_H_
#undef SIXDOF_ORACLE_OVERLAP_TESTS_INL_H_
#else
#define SIXDOF_ORACLE_OVERLAP_TESTS_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/tree_motion.h>
#include <sixdof/proximity/lanes-inl.h>

// What separating axes say about pairs of volumes or of triangles, one pair per SIMD lane. An axis gives a range of
// coordinates of y against x: the pair is apart along it where 0 is not in the range. If y is displaced, the range
// moves at the rate of the displacement's component along the axis: that gives the interval of the displacement's
// fractions at which the axis does not separate the pair, and the pair may intersect in the intersection of all these
// intervals.
//
// No multiplication is fused, so every instruction set finds the same.

HWY_BEFORE_NAMESPACE();
namespace sixdof::overlap_tests {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// How fast a range moves, per fraction of the displacement. Ranges are widened by `pad`.
template <class D>
struct Rate {
  hn::Vec<D> inverse, pad;

  HWY_INLINE Rate(hn::Vec<D> inverse_rate, hn::Vec<D> padding) : inverse(inverse_rate), pad(padding) {}
  HWY_INLINE explicit Rate(const detail::Speed& speed)
      : inverse(hn::Set(D(), speed.inverse)), pad(hn::Set(D(), speed.pad)) {}

  /// @param least a slower range is taken to move at this rate, and widened by `slow_pad`
  HWY_INLINE static Rate of(hn::Vec<D> rate, float least, float slow_pad) {
    const auto slow = hn::Le(hn::Abs(rate), hn::Set(D(), least));
    return {hn::Div(hn::Set(D(), 1.0f), hn::IfThenElse(slow, hn::Set(D(), least), rate)),
            hn::IfThenElseZero(slow, hn::Set(D(), slow_pad))};
  }
};

/// Pairs that may intersect.
/// @tparam moving whether y is displaced
template <class D, bool moving>
class Overlaps;

template <class D>
class Overlaps<D, false> {
 public:
  using V = hn::Vec<D>;

  /// @param tolerance ranges that are less far from 0 do not separate
  /// @param origin not used here
  HWY_INLINE explicit Overlaps(float tolerance, float origin = 0.0f) : tolerance_(hn::Set(D(), tolerance)) {
    (void)origin;
  }

  HWY_INLINE void axis(V low, V high, const Rate<D>& rate) {
    (void)rate;
    gap_ = hn::Max(gap_, hn::Max(low, hn::Neg(high)));
  }
  /// The range middle - half .. middle + half.
  HWY_INLINE void symmetric_axis(V middle, V half, const Rate<D>& rate) {
    (void)rate;
    gap_ = hn::Max(gap_, hn::Sub(hn::Abs(middle), half));
  }
  /// The coordinates of x and of y.
  HWY_INLINE void axis(V low_x, V high_x, V low_y, V high_y, const Rate<D>& rate) {
    (void)rate;
    apart_ = hn::Or(apart_, hn::Or(hn::Gt(low_y, high_x), hn::Gt(low_x, high_y)));
  }
  HWY_INLINE void take(const float* first, const float* last) {
    (void)first;
    (void)last;
  }
  /// Lanes that may intersect.
  HWY_INLINE hn::Mask<D> store(float* first, float* last) const {
    (void)first;
    (void)last;
    return hn::AndNot(apart_, hn::Le(gap_, tolerance_));
  }

 private:
  V tolerance_;
  hn::Mask<D> apart_ = hn::Lt(hn::Zero(D()), hn::Zero(D()));
  V gap_ = hn::Set(D(), -Tree::k_empty);
};

template <class D>
class Overlaps<D, true> {
 public:
  using V = hn::Vec<D>;

  /// @param origin of the ranges: the fraction at which pairs are where the ranges say
  HWY_INLINE explicit Overlaps(float tolerance, float origin = 0.0f)
      : tolerance_(hn::Set(D(), tolerance)),
        origin_(hn::Set(D(), origin)),
        first_(hn::Set(D(), detail::k_first_fraction - origin)),
        last_(hn::Set(D(), detail::k_last_fraction - origin)) {}

  HWY_INLINE void axis(V low, V high, const Rate<D>& rate) {
    const V pad = hn::Add(tolerance_, rate.pad);
    const V x = hn::Mul(hn::Neg(hn::Add(high, pad)), rate.inverse), y = hn::Mul(hn::Sub(pad, low), rate.inverse);
    first_ = hn::Max(first_, hn::Min(x, y));
    last_ = hn::Min(last_, hn::Max(x, y));
  }
  /// Rounded by 1.2e-7 of `middle` more than axis(), a fifth of the slack.
  HWY_INLINE void symmetric_axis(V middle, V half, const Rate<D>& rate) {
    const V at = hn::Neg(hn::Mul(middle, rate.inverse));
    const V around = hn::Mul(hn::Add(half, hn::Add(tolerance_, rate.pad)), hn::Abs(rate.inverse));
    first_ = hn::Max(first_, hn::Sub(at, around));
    last_ = hn::Min(last_, hn::Add(at, around));
  }
  HWY_INLINE void axis(V low_x, V high_x, V low_y, V high_y, const Rate<D>& rate) {
    axis(hn::Sub(low_y, high_x), hn::Sub(high_y, low_x), rate);
  }
  /// Intervals that were stored.
  HWY_INLINE void take(const float* first, const float* last) {
    first_ = hn::Max(first_, hn::Sub(hn::Load(D(), first), origin_));
    last_ = hn::Min(last_, hn::Sub(hn::Load(D(), last), origin_));
  }
  /// Stores the intervals of fractions, 0 .. 1. Returns the lanes in which one contains a fraction in 0 .. 1.
  HWY_INLINE hn::Mask<D> store(float* first, float* last) const {
    const V pad = hn::Set(D(), detail::k_fraction_rounding);
    const V low = hn::Add(first_, hn::Sub(origin_, pad)), high = hn::Add(last_, hn::Add(origin_, pad));
    hn::Store(low, D(), first);
    hn::Store(high, D(), last);
    return hn::And(hn::Le(low, high), hn::And(hn::Le(low, hn::Set(D(), 1.0f)), hn::Ge(high, hn::Zero(D()))));
  }

 private:
  V tolerance_, origin_, first_, last_;
};

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::overlap_tests
HWY_AFTER_NAMESPACE();

#endif  // guard per instruction set
