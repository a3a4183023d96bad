// Part of candidates.cpp, which includes it once per instruction set: it has no include guard.

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/cross_axes.h>
#include <sixdof/oracle/expansion-inl.h>
#include <sixdof/oracle/tree_motion.h>
#include <sixdof/oracle/volumes-inl.h>

// Separating-axis tests of volumes of two trees (volumes-inl.h).
//
// The tree of y may be translated by a displacement meanwhile (Passage). A test is linear in the displacement's
// fraction, so each gives the interval of fractions at which it does not separate two volumes: they may intersect in
// the intersection of these intervals. Fractions are counted from the displacement's middle, at which volumes are
// taken: -1/2 .. 1/2.
//
// A test never separates volumes that intersect. No multiplication is fused and nothing is summed across lanes, so
// every instruction set finds the same pairs.

HWY_BEFORE_NAMESPACE();
namespace sixdof::candidates {
namespace HWY_NAMESPACE {

using namespace volumes::HWY_NAMESPACE;
using detail::Passage;

constexpr Rounding k_rounding = Rounding::unfused;

/// Rounding of a gap along an axis, in units of TreeMotion::slack. A direction of length 1 has components of at most
/// sqrt(3) together, so the coordinates of an offset give two slacks; of the other lengths, which are those of volumes,
/// the rounding is less than one slack each for y's turned ones and for the sums.
constexpr float k_slacks = 4.0f;

/// Bits of the volumes x that are not separated from volume j of y.
HWY_INLINE std::uint32_t overlapping_volumes(const Volumes& x, const Volumes& y, std::size_t j, float slack) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    const VolumePairs<k_rounding> pairs{x, y, i, j};
    V gap = set(-Tree::k_empty);
    V offset[3];
    for (std::size_t k = 0; k < 3; ++k) {
      offset[k] = pairs.offset_in_x(k);
      gap = hn::Max(gap, hn::Sub(hn::Abs(offset[k]), pairs.extent_in_x(k)));
      gap = hn::Max(gap, hn::Sub(hn::Abs(pairs.offset_in_y(k)), pairs.extent_in_y(k)));
    }
    if (hn::AllTrue(k_lanes, hn::Gt(gap, set(k_slacks * slack)))) continue;
    const auto normals = pairs.along_normals(offset);
    gap = hn::Max(gap, hn::Max(normals.of_x.gap(), normals.of_y.gap()));
    bits |= bits_of(hn::Le(gap, set(k_slacks * slack)), i);
  }
  return bits;
}

/// The intervals of the displacement's fractions (0 .. 1) in which the volumes x may intersect volume j of y. Returns
/// those (bits) whose interval contains one in 0 .. 1.
HWY_INLINE std::uint32_t overlap_intervals(const Volumes& x, const Volumes& y, std::size_t j, const Passage& passage,
                                           float slack, float* HWY_RESTRICT first, float* HWY_RESTRICT last) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    const VolumePairs<k_rounding> pairs{x, y, i, j};
    lanes::HWY_NAMESPACE::FractionInterval<V> interval{set(detail::k_first_fraction - 0.5f),
                                                       set(detail::k_last_fraction - 0.5f)};
    // To the fractions at which 0 is in the range that moves along.
    const auto narrow_box = [&](V offset, V extent, const detail::Speed& speed) {
      const V reach = hn::Add(extent, set(k_slacks * slack + speed.pad));
      interval.narrow(hn::Neg(hn::Add(offset, reach)), hn::Sub(reach, offset), set(speed.inverse));
    };
    V offset[3];
    V speed_x = hn::Zero(k_lanes), speed_y = hn::Zero(k_lanes);  // along the normals
    for (std::size_t k = 0; k < 3; ++k) {
      offset[k] = pairs.offset_in_x(k);
      narrow_box(offset[k], pairs.extent_in_x(k), passage.along_x[k]);
      narrow_box(pairs.offset_in_y(k), pairs.extent_in_y(k), passage.along_y[k]);
      speed_x = unfused_mul_add(load(x.normal[k] + i), set(passage.in_x[k]), speed_x);
      speed_y = unfused_mul_add(set(y.normal[k][j]), set(passage.in_y[k]), speed_y);
    }
    const auto narrow_slab = [&](const AxisRange& range, V speed) {
      const M slow = hn::Le(hn::Abs(speed), set(slack));
      const V pad = hn::Add(set(k_slacks * slack), hn::IfThenElseZero(slow, set(slack)));
      interval.narrow(hn::Neg(hn::Add(range.high, pad)), hn::Sub(pad, range.low),
                      hn::Div(set(1.0f), hn::IfThenElse(slow, set(slack), speed)));
    };
    const auto normals = pairs.along_normals(offset);
    narrow_slab(normals.of_x, speed_x);
    narrow_slab(normals.of_y, speed_y);
    const V low = hn::Add(interval.first, set(0.5f - detail::k_fraction_rounding));
    const V high = hn::Add(interval.last, set(0.5f + detail::k_fraction_rounding));
    hn::Store(low, k_lanes, first + i);
    hn::Store(high, k_lanes, last + i);
    const M meets = hn::And(hn::Le(low, set(1.0f)), hn::Ge(high, hn::Zero(k_lanes)));
    bits |= bits_of(hn::And(hn::Le(low, high), meets), i);
  }
  return bits;
}

/// The volumes x (bits), of those in `bits`, that are not separated from volume j of y by an axis across an axis of
/// each frame.
inline HWY_NOINLINE std::uint32_t overlapping_across_axes(const Volumes& x, const Volumes& y, std::size_t j,
                                                          const float (&axes_x)[detail::CrossAxes::k_count][3],
                                                          const float (&axes_y)[detail::CrossAxes::k_count][3],
                                                          std::uint32_t bits, const Passage& passage, float slack) {
  // Rounding of the directions, the products and the extents is less than two slacks more.
  const V enough = set((k_slacks + 2.0f) * slack);
  std::uint32_t overlapping = 0;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    const V gap = VolumePairs<k_rounding>{x, y, i, j}.gap_across_axes(axes_x, axes_y, passage.half_in_x);
    overlapping |= bits_of(hn::Le(gap, enough), i);
  }
  return bits & overlapping;
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::candidates
HWY_AFTER_NAMESPACE();
