// Compiled once per instruction set: part of candidates.cpp and swept_candidates.cpp, included by nothing else.
#if defined(SIXDOF_ORACLE_CANDIDATES_BOUNDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_ORACLE_CANDIDATES_BOUNDS_INL_H_
#undef SIXDOF_ORACLE_CANDIDATES_BOUNDS_INL_H_
#else
#define SIXDOF_ORACLE_CANDIDATES_BOUNDS_INL_H_
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include <hwy/highway.h>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>

// Separating-axis tests between the children of a node of A and those of a node of B, one child of A per SIMD lane.
//
// B may be translated by a displacement meanwhile; the tests then hold for all fractions x in 0 .. 1 of it. For that,
// B's boxes are taken at x = 1/2 and enlarged by half of the displacement.
//
// Coordinates are floats relative to the centre of A's tree; half extents include the rounding, so a test never
// separates volumes that intersect. No multiplication is fused and nothing is summed across lanes, so every instruction
// set finds the same pairs.

HWY_BEFORE_NAMESPACE();
namespace sixdof::candidates {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, Tree::k_width>;
using V = hn::Vec<Lanes>;
using M = hn::Mask<Lanes>;

constexpr Lanes k_lanes;
constexpr std::size_t k_width = Tree::k_width;

/// x y + z with two roundings: the same bits on every instruction set.
template <class Vec>
HWY_INLINE Vec unfused_mul_add(Vec x, Vec y, Vec z) {
  return hn::Add(hn::Mul(x, y), z);
}

HWY_INLINE M no_lane() { return hn::Lt(hn::Zero(k_lanes), hn::Zero(k_lanes)); }

/// The bits of the lanes of `mask`, from bit `i` on.
HWY_INLINE std::uint32_t bits_of(M mask, std::size_t i) {
  HWY_ALIGN std::uint8_t stored[8] = {};
  hn::StoreMaskBits(k_lanes, mask, stored);
  return static_cast<std::uint32_t>(stored[0]) << i;
}

/// The motion of B in the frames of the trees: p_A - center_A = rotation (p_B - center_B) + shift + x displacement.
struct TreeMotion {
  float rotation[3][3];
  float shift[3];
  float displacement[3];
  float slack;                 ///< Largest error of a transformed coordinate.
  float middle[3];             ///< shift + displacement / 2
  float half_displacement[3];  ///< displacement / 2
  float half_sweep_in_a[3];    ///< Half extents of the displacement along A's axes,
  float half_sweep_in_b[3];    ///< and along B's.
  float inverse[3];  ///< 1 / displacement, per axis of A; 1 / slack where the displacement is below the slack.
  float pad[3];      ///< 0; the slack where the displacement is below the slack.

  TreeMotion(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& displacement_A) {
    const Eigen::Vector3d d = X_AB.R * b.center() + X_AB.t - a.center();
    // A coordinate is the sum of seven products and sums of lengths of this size, each rounded by 6e-8.
    constexpr double k_float_rounding = 6e-7;
    // Rounding of the doubles, which matters where the bodies are far from their origins.
    constexpr double k_double_rounding = 1e-14;
    const double size =
        a.radius() + b.radius() + d.lpNorm<Eigen::Infinity>() + displacement_A.lpNorm<Eigen::Infinity>();
    slack =
        static_cast<float>(k_float_rounding * size +
                           k_double_rounding * (X_AB.t.lpNorm<1>() + b.center().lpNorm<1>() + a.center().lpNorm<1>()));
    const Eigen::Vector3d displacement_B = X_AB.R.transpose() * displacement_A;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) rotation[i][k] = static_cast<float>(X_AB.R(i, k));
      shift[i] = static_cast<float>(d[i]);
      displacement[i] = static_cast<float>(displacement_A[i]);
      half_displacement[i] = 0.5f * displacement[i];
      middle[i] = static_cast<float>(d[i] + 0.5 * displacement_A[i]);
      half_sweep_in_a[i] = std::abs(half_displacement[i]);
      half_sweep_in_b[i] = static_cast<float>(0.5 * std::abs(displacement_B[i]));
      const bool moves = std::abs(displacement[i]) > slack;
      inverse[i] = 1.0f / (moves ? displacement[i] : slack);
      pad[i] = moves ? 0.0f : slack;
    }
  }
};

/// Volumes of a node's children in their own frame and in the other tree's; boxes as centre and half extents.
struct alignas(64) Children {
  float center[3][k_width], half[3][k_width];              // in the own frame
  float other_center[3][k_width], other_half[3][k_width];  // box around it in the other frame, for all fractions
  float unswept_half[3][k_width];                          // of that box at one fraction; like other_half with slack
  float normal[3][k_width];                                // in the other frame
  float slab_lower[k_width], slab_upper[k_width];          // along the normals, from A's centre, with slack
};

/// @tparam of_b true for children of B (the other frame is A's), false for those of A.
template <bool of_b>
HWY_INLINE void load_children(const Tree::Node& node, const TreeMotion& x, Children& out) {
  const V half = hn::Set(k_lanes, 0.5f);
  const V slack = hn::Set(k_lanes, x.slack);
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    V c[3], h[3], n[3], from[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const V lower = hn::Load(k_lanes, node.lower[k] + i), upper = hn::Load(k_lanes, node.upper[k] + i);
      c[k] = hn::Mul(half, hn::Add(lower, upper));
      h[k] = hn::Mul(half, hn::Sub(upper, lower));
      n[k] = hn::Load(k_lanes, node.normal[k] + i);
      hn::Store(c[k], k_lanes, out.center[k] + i);
      hn::Store(h[k], k_lanes, out.half[k] + i);
      from[k] = of_b ? c[k] : hn::Sub(c[k], hn::Set(k_lanes, x.middle[k]));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      V center = of_b ? hn::Set(k_lanes, x.middle[k]) : hn::Zero(k_lanes);
      V extent = slack;
      V normal = hn::Zero(k_lanes);
      for (std::size_t j = 0; j < 3; ++j) {
        const V r = hn::Set(k_lanes, of_b ? x.rotation[k][j] : x.rotation[j][k]);
        center = unfused_mul_add(r, from[j], center);
        extent = unfused_mul_add(hn::Abs(r), h[j], extent);
        normal = unfused_mul_add(r, n[j], normal);
      }
      hn::Store(center, k_lanes, out.other_center[k] + i);
      hn::Store(extent, k_lanes, out.unswept_half[k] + i);
      const V swept = hn::Add(extent, hn::Set(k_lanes, of_b ? x.half_sweep_in_a[k] : x.half_sweep_in_b[k]));
      hn::Store(swept, k_lanes, out.other_half[k] + i);
      hn::Store(normal, k_lanes, out.normal[k] + i);
    }
    // Slabs: a scalar product has three coordinates that are off by the slack, and moves by half of the displacement
    // along the normal.
    V along_displacement = hn::Zero(k_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      const V normal = of_b ? hn::Load(k_lanes, out.normal[k] + i) : n[k];
      along_displacement = unfused_mul_add(normal, hn::Set(k_lanes, x.half_displacement[k]), along_displacement);
    }
    const V slab_slack = unfused_mul_add(hn::Set(k_lanes, 3.0f), slack, hn::Abs(along_displacement));
    V lower = hn::Sub(hn::Load(k_lanes, node.slab_lower + i), slab_slack);
    V upper = hn::Add(hn::Load(k_lanes, node.slab_upper + i), slab_slack);
    if (of_b) {
      for (std::size_t k = 0; k < 3; ++k) {
        const V along = hn::Mul(hn::Load(k_lanes, out.normal[k] + i), hn::Set(k_lanes, x.middle[k]));
        lower = hn::Add(lower, along);
        upper = hn::Add(upper, along);
      }
    }
    hn::Store(lower, k_lanes, out.slab_lower + i);
    hn::Store(upper, k_lanes, out.slab_upper + i);
  }
}

/// Lanes of A's children that are separated from B's child j by an axis perpendicular to the displacement and to an
/// axis of A.
HWY_INLINE M separated_across_displacement(const Children& a, const Children& b, std::size_t j, std::size_t i,
                                           const TreeMotion& x) {
  M apart = no_lane();
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
    const V move_l = hn::Set(k_lanes, x.displacement[l]), move_m = hn::Set(k_lanes, x.displacement[m]);
    const V l_off = hn::Sub(hn::Load(k_lanes, a.center[l] + i), hn::Set(k_lanes, b.other_center[l][j]));
    const V m_off = hn::Sub(hn::Load(k_lanes, a.center[m] + i), hn::Set(k_lanes, b.other_center[m][j]));
    const V l_half = hn::Add(hn::Load(k_lanes, a.half[l] + i), hn::Set(k_lanes, b.unswept_half[l][j]));
    const V m_half = hn::Add(hn::Load(k_lanes, a.half[m] + i), hn::Set(k_lanes, b.unswept_half[m][j]));
    const V across = hn::Sub(hn::Mul(l_off, move_m), hn::Mul(m_off, move_l));
    const V radius = unfused_mul_add(l_half, hn::Abs(move_m), hn::Mul(m_half, hn::Abs(move_l)));
    apart = hn::Or(apart, hn::Gt(hn::Abs(across), radius));
  }
  return apart;
}

/// Children of A (bits) that are not separated from child j of B.
/// @tparam moving the displacement is not zero.
template <bool moving>
HWY_INLINE std::uint32_t overlapping_children(const Children& a, const Tree::Node& node_a, const Children& b,
                                              std::size_t j, const TreeMotion& x) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    M apart = no_lane();
    V middle_a = hn::Zero(k_lanes), radius_a = hn::Zero(k_lanes);  // of A's boxes along the normal of j
    V middle_b = hn::Zero(k_lanes), radius_b = hn::Zero(k_lanes);  // of j's box along A's normals
    for (std::size_t k = 0; k < 3; ++k) {
      const V other = hn::Load(k_lanes, a.other_center[k] + i);
      const V gap_in_a =
          hn::Sub(hn::Abs(hn::Sub(hn::Load(k_lanes, a.center[k] + i), hn::Set(k_lanes, b.other_center[k][j]))),
                  hn::Load(k_lanes, a.half[k] + i));
      const V gap_in_b =
          hn::Sub(hn::Abs(hn::Sub(other, hn::Set(k_lanes, b.center[k][j]))), hn::Load(k_lanes, a.other_half[k] + i));
      apart = hn::Or(apart, hn::Gt(gap_in_a, hn::Set(k_lanes, b.other_half[k][j])));
      apart = hn::Or(apart, hn::Gt(gap_in_b, hn::Set(k_lanes, b.half[k][j])));
      const V normal_a = hn::Load(k_lanes, a.normal[k] + i);  // of A's child, in B's frame
      const V normal_b = hn::Set(k_lanes, b.normal[k][j]);    // of j, in A's frame
      middle_a = unfused_mul_add(normal_b, hn::Load(k_lanes, a.center[k] + i), middle_a);
      radius_a = unfused_mul_add(hn::Abs(normal_b), hn::Load(k_lanes, a.half[k] + i), radius_a);
      middle_b =
          unfused_mul_add(hn::Load(k_lanes, node_a.normal[k] + i), hn::Set(k_lanes, b.other_center[k][j]), middle_b);
      radius_b = unfused_mul_add(hn::Abs(normal_a), hn::Set(k_lanes, b.half[k][j]), radius_b);
    }
    apart = hn::Or(apart, hn::Gt(hn::Sub(middle_b, radius_b), hn::Load(k_lanes, a.slab_upper + i)));
    apart = hn::Or(apart, hn::Lt(hn::Add(middle_b, radius_b), hn::Load(k_lanes, a.slab_lower + i)));
    apart = hn::Or(apart, hn::Gt(hn::Sub(middle_a, radius_a), hn::Set(k_lanes, b.slab_upper[j])));
    apart = hn::Or(apart, hn::Lt(hn::Add(middle_a, radius_a), hn::Set(k_lanes, b.slab_lower[j])));
    if constexpr (moving) apart = hn::Or(apart, separated_across_displacement(a, b, j, i, x));
    bits |= bits_of(hn::Not(apart), i);
  }
  return bits;
}

/// The interval of the displacement's fraction in which something may hold, per lane.
struct FractionInterval {
  V first, last;

  /// To the fractions at which a box of B overlaps a box of A along an axis of A; bounds are those at fraction 0.
  HWY_INLINE void narrow_to_boxes(V lower_a, V upper_a, V lower_b, V upper_b, std::size_t axis, const TreeMotion& x) {
    const V pad = hn::Set(k_lanes, x.pad[axis]);
    const V inverse = hn::Set(k_lanes, x.inverse[axis]);
    const V low = hn::Mul(hn::Sub(hn::Sub(lower_a, upper_b), pad), inverse);
    const V high = hn::Mul(hn::Add(hn::Sub(upper_a, lower_b), pad), inverse);
    first = hn::Max(first, x.inverse[axis] < 0.0f ? high : low);
    last = hn::Min(last, x.inverse[axis] < 0.0f ? low : high);
  }
};

/// Rounding of a fraction, a quotient of differences.
constexpr float k_fraction_rounding = 2e-6f;

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::candidates
HWY_AFTER_NAMESPACE();

#endif
