// Part of candidates.cpp, which includes it once per instruction set: it has no include guard.

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/cross_axes.h>
#include <sixdof/oracle/lanes-inl.h>
#include <sixdof/oracle/tree_motion.h>

// Separating-axis tests between the children of a node of A and those of a node of B, one child of A per SIMD lane.
//
// B may be translated by a displacement meanwhile. A test is linear in the displacement's fraction, so each gives the
// interval of fractions at which it does not separate two volumes: they may intersect in the intersection of these
// intervals. Fractions are counted from the displacement's middle, at which B's volumes are taken: -1/2 .. 1/2.
//
// Coordinates are floats relative to the centre of A's tree; half extents include the rounding, so a test never
// separates volumes that intersect. No multiplication is fused and nothing is summed across lanes, so every instruction
// set finds the same pairs.

HWY_BEFORE_NAMESPACE();
namespace sixdof::candidates {
namespace HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;

HWY_INLINE M no_lane() { return hn::Lt(hn::Zero(k_lanes), hn::Zero(k_lanes)); }

using detail::TreeMotion;

/// Volumes of a node's children in their own frame and in the other tree's; boxes as centre and half extents.
struct alignas(64) Children {
  float center[3][k_width], half[3][k_width];              // in the own frame
  float other_center[3][k_width], other_half[3][k_width];  // box around it in the other frame, with slack
  float normal[3][k_width];                                // in the other frame
  float slab_lower[k_width], slab_upper[k_width];          // along the normals, from A's centre, with slack
  float slab_inverse[k_width];                             // TreeMotion::Speed of B along the normals
};

/// @tparam of_b true for children of B (the other frame is A's), false for those of A.
/// @tparam moving the displacement is not zero
template <bool of_b, bool moving>
HWY_INLINE void load_children(const Tree::Node& node, const TreeMotion& x, Children& out) {
  const V half = set(0.5f);
  const V slack = set(x.slack);
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    V c[3], h[3], n[3], from[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const V lower = load(node.lower[k] + i), upper = load(node.upper[k] + i);
      c[k] = hn::Mul(half, hn::Add(lower, upper));
      h[k] = hn::Mul(half, hn::Sub(upper, lower));
      n[k] = load(node.normal[k] + i);
      hn::Store(c[k], k_lanes, out.center[k] + i);
      hn::Store(h[k], k_lanes, out.half[k] + i);
      from[k] = of_b ? c[k] : hn::Sub(c[k], set(x.middle[k]));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      V center = of_b ? set(x.middle[k]) : hn::Zero(k_lanes);
      V extent = slack;
      V normal = hn::Zero(k_lanes);
      for (std::size_t j = 0; j < 3; ++j) {
        const V r = set(of_b ? x.rotation[k][j] : x.rotation[j][k]);
        center = unfused_mul_add(r, from[j], center);
        extent = unfused_mul_add(hn::Abs(r), h[j], extent);
        normal = unfused_mul_add(r, n[j], normal);
      }
      hn::Store(center, k_lanes, out.other_center[k] + i);
      hn::Store(extent, k_lanes, out.other_half[k] + i);
      hn::Store(normal, k_lanes, out.normal[k] + i);
    }
    // Slabs: a scalar product has three coordinates that are off by the slack.
    V slab_slack = hn::Mul(set(3.0f), slack);
    if constexpr (moving) {
      V speed = hn::Zero(k_lanes);
      for (std::size_t k = 0; k < 3; ++k) {
        speed = unfused_mul_add(of_b ? load(out.normal[k] + i) : n[k], set(x.displacement[k]), speed);
      }
      const M slow = hn::Le(hn::Abs(speed), slack);
      hn::Store(hn::Div(set(1.0f), hn::IfThenElse(slow, slack, speed)), k_lanes, out.slab_inverse + i);
      slab_slack = hn::Add(slab_slack, hn::IfThenElseZero(slow, slack));
    }
    V lower = hn::Sub(load(node.slab_lower + i), slab_slack);
    V upper = hn::Add(load(node.slab_upper + i), slab_slack);
    if (of_b) {
      for (std::size_t k = 0; k < 3; ++k) {
        const V along = hn::Mul(load(out.normal[k] + i), set(x.middle[k]));
        lower = hn::Add(lower, along);
        upper = hn::Add(upper, along);
      }
    }
    hn::Store(lower, k_lanes, out.slab_lower + i);
    hn::Store(upper, k_lanes, out.slab_upper + i);
  }
}

/// Children of A (bits) that are not separated from child j of B.
HWY_INLINE std::uint32_t overlapping_children(const Children& a, const Tree::Node& node_a, const Children& b,
                                              std::size_t j) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    M apart = no_lane();
    V middle_a = hn::Zero(k_lanes), radius_a = hn::Zero(k_lanes);  // of A's boxes along the normal of j
    V middle_b = hn::Zero(k_lanes), radius_b = hn::Zero(k_lanes);  // of j's box along A's normals
    for (std::size_t k = 0; k < 3; ++k) {
      const V other = load(a.other_center[k] + i);
      const V gap_in_a =
          hn::Sub(hn::Abs(hn::Sub(load(a.center[k] + i), set(b.other_center[k][j]))), load(a.half[k] + i));
      const V gap_in_b = hn::Sub(hn::Abs(hn::Sub(other, set(b.center[k][j]))), load(a.other_half[k] + i));
      apart = hn::Or(apart, hn::Gt(gap_in_a, set(b.other_half[k][j])));
      apart = hn::Or(apart, hn::Gt(gap_in_b, set(b.half[k][j])));
      const V normal_a = load(a.normal[k] + i);  // of A's child, in B's frame
      const V normal_b = set(b.normal[k][j]);    // of j, in A's frame
      middle_a = unfused_mul_add(normal_b, load(a.center[k] + i), middle_a);
      radius_a = unfused_mul_add(hn::Abs(normal_b), load(a.half[k] + i), radius_a);
      middle_b = unfused_mul_add(load(node_a.normal[k] + i), set(b.other_center[k][j]), middle_b);
      radius_b = unfused_mul_add(hn::Abs(normal_a), set(b.half[k][j]), radius_b);
    }
    apart = hn::Or(apart, hn::Gt(hn::Sub(middle_b, radius_b), load(a.slab_upper + i)));
    apart = hn::Or(apart, hn::Lt(hn::Add(middle_b, radius_b), load(a.slab_lower + i)));
    apart = hn::Or(apart, hn::Gt(hn::Sub(middle_a, radius_a), set(b.slab_upper[j])));
    apart = hn::Or(apart, hn::Lt(hn::Add(middle_a, radius_a), set(b.slab_lower[j])));
    bits |= bits_of(hn::Not(apart), i);
  }
  return bits;
}

/// The intervals of the displacement's fractions (0 .. 1) in which children of A may intersect child j of B. Returns
/// the children (bits) whose interval contains one in 0 .. 1.
HWY_INLINE std::uint32_t overlap_intervals(const Children& a, const Tree::Node& node_a, const Children& b,
                                           std::size_t j, const TreeMotion& x, float* HWY_RESTRICT first,
                                           float* HWY_RESTRICT last) {
  std::uint32_t bits = 0;
  const V half = set(0.5f);
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    lanes::HWY_NAMESPACE::FractionInterval<V> interval{set(detail::k_first_fraction - 0.5f),
                                                       set(detail::k_last_fraction - 0.5f)};
    // To |offset - speed x| <= radius.
    const auto narrow = [&](V offset, V radius, V inverse_speed) {
      interval.narrow(hn::Sub(offset, radius), hn::Add(offset, radius), inverse_speed);
    };
    V middle_a = hn::Zero(k_lanes), radius_a = hn::Zero(k_lanes);  // of A's boxes along the normal of j
    V middle_b = hn::Zero(k_lanes), radius_b = hn::Zero(k_lanes);  // of j's box along A's normals
    for (std::size_t k = 0; k < 3; ++k) {
      const V center = load(a.center[k] + i), extent = load(a.half[k] + i);
      narrow(hn::Sub(center, set(b.other_center[k][j])), hn::Add(extent, set(b.other_half[k][j] + x.along_a[k].pad)),
             set(x.along_a[k].inverse));
      narrow(hn::Sub(set(b.center[k][j]), load(a.other_center[k] + i)),
             hn::Add(load(a.other_half[k] + i), set(b.half[k][j] + x.along_b[k].pad)), set(x.along_b[k].inverse));
      const V normal_b = set(b.normal[k][j]);
      middle_a = unfused_mul_add(normal_b, center, middle_a);
      radius_a = unfused_mul_add(hn::Abs(normal_b), extent, radius_a);
      middle_b = unfused_mul_add(load(node_a.normal[k] + i), set(b.other_center[k][j]), middle_b);
      radius_b = unfused_mul_add(hn::Abs(load(a.normal[k] + i)), set(b.half[k][j]), radius_b);
    }
    const auto narrow_to_slab = [&](V middle, V radius, V lower, V upper, V inverse_speed) {
      narrow(hn::Sub(hn::Mul(half, hn::Add(lower, upper)), middle),
             hn::Add(hn::Mul(half, hn::Sub(upper, lower)), radius), inverse_speed);
    };
    narrow_to_slab(middle_b, radius_b, load(a.slab_lower + i), load(a.slab_upper + i), load(a.slab_inverse + i));
    narrow_to_slab(middle_a, radius_a, set(b.slab_lower[j]), set(b.slab_upper[j]), set(-b.slab_inverse[j]));
    const V low = hn::Add(interval.first, set(0.5f - detail::k_fraction_rounding));
    const V high = hn::Add(interval.last, set(0.5f + detail::k_fraction_rounding));
    hn::Store(low, k_lanes, first + i);
    hn::Store(high, k_lanes, last + i);
    const M meets = hn::And(hn::Le(low, set(1.0f)), hn::Ge(high, hn::Zero(k_lanes)));
    bits |= bits_of(hn::And(hn::Le(low, high), meets), i);
  }
  return bits;
}

/// B's children (bits) whose boxes, along all of the displacement, overlap the box of a node of A, or of its only child
/// in `lanes_a`.
HWY_INLINE std::uint32_t overlapping_node(const Children& b, const Tree::Node& a, std::uint32_t lanes_a,
                                          const TreeMotion& x) {
  const float* lower[3] = {&a.volume.lower[0], &a.volume.lower[1], &a.volume.lower[2]};
  const float* upper[3] = {&a.volume.upper[0], &a.volume.upper[1], &a.volume.upper[2]};
  if ((lanes_a & (lanes_a - 1)) == 0) {
    const auto i = static_cast<std::size_t>(std::countr_zero(lanes_a));
    for (std::size_t k = 0; k < 3; ++k) {
      lower[k] = &a.lower[k][i];
      upper[k] = &a.upper[k][i];
    }
  }
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    M apart = no_lane();
    for (std::size_t k = 0; k < 3; ++k) {
      const V center = load(b.other_center[k] + i);
      const V half = hn::Add(load(b.other_half[k] + i), set(std::abs(x.half_displacement[k])));
      apart = hn::Or(apart, hn::Gt(hn::Sub(center, half), set(*upper[k])));
      apart = hn::Or(apart, hn::Lt(hn::Add(center, half), set(*lower[k])));
    }
    bits |= bits_of(hn::Not(apart), i);
  }
  return bits;
}

/// Children of A (bits), of those in `bits`, that are not separated from child j of B by an axis across an axis of A
/// and one of B.
inline HWY_NOINLINE std::uint32_t overlapping_across_axes(const Children& a, const Children& b, std::size_t j,
                                                          std::uint32_t bits, const detail::CrossAxes& axes,
                                                          const TreeMotion& x) {
  // Off by the slack are the coordinates of B's centre; rounding of the directions, the products and the extents is
  // less than a slack each. A direction of length 1 has components of at most sqrt(3) together.
  constexpr float k_slacks = 6.0f;
  float radius_b[detail::CrossAxes::k_count], middle_b[detail::CrossAxes::k_count];
  for (std::size_t n = 0; n < detail::CrossAxes::k_count; ++n) {
    middle_b[n] = 0.0f;
    radius_b[n] = k_slacks * x.slack;
    for (std::size_t k = 0; k < 3; ++k) {
      middle_b[n] += axes.in_a[n][k] * b.other_center[k][j];
      radius_b[n] += std::abs(axes.in_b[n][k]) * b.half[k][j] + std::abs(axes.in_a[n][k] * x.half_displacement[k]);
    }
  }
  std::uint32_t overlapping = 0;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    M apart = no_lane();
    for (std::size_t n = 0; n < detail::CrossAxes::k_count; ++n) {
      V offset = set(-middle_b[n]), radius = set(radius_b[n]);
      for (std::size_t k = 0; k < 3; ++k) {
        offset = unfused_mul_add(set(axes.in_a[n][k]), load(a.center[k] + i), offset);
        radius = unfused_mul_add(set(std::abs(axes.in_a[n][k])), load(a.half[k] + i), radius);
      }
      apart = hn::Or(apart, hn::Gt(hn::Abs(offset), radius));
    }
    overlapping |= bits_of(hn::Not(apart), i);
  }
  return bits & overlapping;
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::candidates
HWY_AFTER_NAMESPACE();
