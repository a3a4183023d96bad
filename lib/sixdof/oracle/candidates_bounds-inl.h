// Part of candidates.cpp, which includes it once per instruction set: it has no include guard.

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/overlap_tests-inl.h>
#include <sixdof/oracle/tree_motion.h>
#include <sixdof/proximity/cross_axes.h>
#include <sixdof/proximity/expansion-inl.h>
#include <sixdof/proximity/volumes-inl.h>

// Separating-axis tests of volumes of two trees (volumes-inl.h).
//
// Of a displacement (Passage), volumes are taken at its middle.
//
// A test never separates volumes that intersect. No multiplication is fused and nothing is summed across lanes, so
// every instruction set finds the same pairs.

HWY_BEFORE_NAMESPACE();
namespace sixdof::candidates {
namespace HWY_NAMESPACE {

using namespace volumes::HWY_NAMESPACE;
using detail::Passage;
using detail::TreeMotion;

constexpr Rounding k_rounding = Rounding::unfused;

/// Rounding of a gap along an axis, in units of TreeMotion::rounding. A direction of length 1 has components of at most
/// sqrt(3) together, so the coordinates of an offset give two units; of the other lengths, which are those of volumes,
/// the rounding is less than one unit each for y's turned ones and for the sums.
constexpr float k_units = 4.0f;

/// Bits of the volumes x that may intersect volume j of y.
/// @param first, last if moving: the fractions between which they may
template <bool moving>
HWY_INLINE std::uint32_t overlapping_volumes(const Volumes& x, const Volumes& y, std::size_t j, const Passage& passage,
                                             const TreeMotion& motion, float* HWY_RESTRICT first,
                                             float* HWY_RESTRICT last) {
  using Rate = overlap_tests::HWY_NAMESPACE::Rate<Lanes>;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    const VolumePairs<k_rounding> pairs{x, y, i, j};
    overlap_tests::HWY_NAMESPACE::Overlaps<Lanes, moving> overlaps(motion.slack(k_units), 0.5f);
    V offset[3];
    V rate_x = hn::Zero(k_lanes), rate_y = hn::Zero(k_lanes);  // along the normals
    for (std::size_t k = 0; k < 3; ++k) {
      offset[k] = pairs.offset_in_x(k);
      overlaps.symmetric_axis(offset[k], pairs.extent_in_x(k), Rate(passage.along_x[k]));
      overlaps.symmetric_axis(pairs.offset_in_y(k), pairs.extent_in_y(k), Rate(passage.along_y[k]));
      rate_x = unfused_mul_add(load(x.normal[k] + i), set(passage.in_x[k]), rate_x);
      rate_y = unfused_mul_add(set(y.normal[k][j]), set(passage.in_y[k]), rate_y);
    }
    if (hn::AllFalse(k_lanes, overlaps.store(first + i, last + i))) continue;
    const auto normals = pairs.along_normals(offset);
    overlaps.axis(normals.of_x.low, normals.of_x.high, Rate::of(rate_x, motion.rounding, motion.rounding));
    overlaps.axis(normals.of_y.low, normals.of_y.high, Rate::of(rate_y, motion.rounding, motion.rounding));
    bits |= bits_of(overlaps.store(first + i, last + i), i);
  }
  return bits;
}

/// Of the volumes x in `bits`, those (as bits) that none of the nine cross products of both frames' axes separates from
/// volume j of y.
inline HWY_NOINLINE std::uint32_t overlapping_across_axes(const Volumes& x, const Volumes& y, std::size_t j,
                                                          const float (&axes_x)[detail::CrossAxes::k_count][3],
                                                          const float (&axes_y)[detail::CrossAxes::k_count][3],
                                                          std::uint32_t bits, const Passage& passage,
                                                          const TreeMotion& motion) {
  // Rounding of the directions, the products and the extents is less than two units more.
  const V enough = set(motion.slack(k_units + 2.0f));
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
