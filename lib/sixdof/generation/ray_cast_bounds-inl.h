// Compiled once per instruction set: part of ray_cast_traversal.cpp, included by nothing else.
#if defined(SIXDOF_GENERATION_RAY_CAST_BOUNDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_GENERATION_RAY_CAST_BOUNDS_INL_H_
#undef SIXDOF_GENERATION_RAY_CAST_BOUNDS_INL_H_
#else
#define SIXDOF_GENERATION_RAY_CAST_BOUNDS_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <hwy/highway.h>

#include <sixdof/generation/ray_cast_front.h>
#include <sixdof/generation/ray_cast_traversal.h>
#include <sixdof/generation/ray_cast_tree.h>

// Separating-axis bounds for one volume against the eight children of a node, one child per SIMD lane. Notation: see
// ray_cast_traversal.h. For a unit vector n, the gap at t0 = ray.translation is
//   min over s in S of n . s + t0 n . u - d,
// and n . u is its slope. Where the gap is positive and the slope is not negative, the pair is farther apart than d at
// t0 and at every larger t. No ray parameter is divided by n . u, so grazing rays are no special case.
//
// Axes n that are tried for a pair of volumes, each the intersection of a box, a ball and a slab:
//   - the axis of the best hit. Where surfaces are smooth it is close to the best one for every pair that matters, and
//     slabs make the bound tight to second order in the size of the patches;
//   - from ball centre to ball centre, with slabs: tight for small patches at a distance;
//   - from box to box, from where the sum of the boxes is nearest to the origin;
//   - the normals of both slabs.
// Where the ball centres come nearer as t grows beyond t0, the second and third axis are those at the t where they are
// nearest, t0 + `later`, and the gap there is lowered by later times the slope, to t0. At that t the second axis has
// n . u = 0 up to rounding: if rounding makes it negative, the gap is lowered by what that takes up to the largest t.
//
// Nothing here uses fused multiply-add, and all operations (+ - * / sqrt min max) are rounded by IEEE rules lane by
// lane. So which pairs are expanded, and in what order, is the same on every instruction set.

HWY_BEFORE_NAMESPACE();
namespace sixdof::ray_cast {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, Tree::k_width>;
using V = hn::Vec<Lanes>;

constexpr Lanes k_lanes;
constexpr std::size_t k_width = Tree::k_width;
constexpr std::size_t k_leaf_triangles = Tree::k_leaf_triangles;

/// Gaps not above this, in units of Cast::size(), do not count. Roundings are 6e-8 each of numbers up to Cast::size():
/// - a gap carries up to 16: three of transforming a corner, one or two each of fitting, shifting and adding: 1e-6;
/// - a bound carries 4 from where it is made and 4 from where it is read: 5e-7; its slope is off by up to five (n and u
///   are rounded, a dot product has three), times a translation of at most Cast::size(): 3e-7.
constexpr float k_slack = 2e-6f;

/// Length of axes. They are shorter than unit vectors by more than their rounding, so that a gap along them never
/// exceeds the distance.
constexpr double k_axis_length = 1.0 - 4e-7;

/// Squared lengths are raised to at least this, so that nothing is divided by zero.
constexpr float k_smallest_square = 1e-36f;

HWY_INLINE V set(float x) { return hn::Set(k_lanes, x); }
/// x y + z and z - x y, with two roundings.
HWY_INLINE V unfused_mul_add(V x, V y, V z) { return hn::Add(hn::Mul(x, y), z); }
HWY_INLINE V unfused_sub_mul(V z, V x, V y) { return hn::Sub(z, hn::Mul(x, y)); }

/// The ray in single precision.
struct Ray {
  float u[3];
  float axis[3];  ///< Of the best hit, k_axis_length long.
  float target;
  float slack;        ///< k_slack as a length.
  float translation;  ///< Of the best hit: t0.
  float reach;        ///< Upper bound on every t of interest.
  float shift[3];     ///< t0 u

  explicit Ray(const Cast& cast)
      : target(static_cast<float>(cast.target)),
        slack(static_cast<float>(k_slack * cast.size())),
        reach(static_cast<float>(1.01 * cast.size())) {
    for (int k = 0; k < 3; ++k) u[k] = static_cast<float>(cast.direction[k]);
    set_best(cast);
  }

  void set_best(const Cast& cast) {
    for (int k = 0; k < 3; ++k) {
      axis[k] = static_cast<float>(k_axis_length * cast.best.axis[k]);
      shift[k] = static_cast<float>(cast.best.translation * cast.direction[k]);
    }
    translation = static_cast<float>(cast.best.translation);
  }

  float axis_slope() const { return axis[0] * u[0] + axis[1] * u[1] + axis[2] * u[2]; }
};

/// The least n . (p - centre of the ball) over a volume: the larger of the bounds from the ball, and from the slab with
/// the ball for the part of n across its normal. Both n and the slab's normal are shorter than unit vectors by more
/// than their rounding, so the square root is never below the length of that part.
HWY_INLINE V support_value(const V* HWY_RESTRICT n, V radius, const V* HWY_RESTRICT normal, V slab_offset,
                           V slab_half) {
  const V along = unfused_mul_add(n[2], normal[2], unfused_mul_add(n[1], normal[1], hn::Mul(n[0], normal[0])));
  const V across = hn::Sqrt(hn::Max(unfused_sub_mul(set(1.0f), along, along), hn::Zero(k_lanes)));
  V slab = unfused_sub_mul(hn::Mul(along, slab_offset), hn::Abs(along), slab_half);
  slab = unfused_sub_mul(slab, across, radius);
  return hn::Max(hn::Neg(radius), slab);
}

/// The same for one volume.
HWY_INLINE float support_value(const float* n, const CastVolume& v) {
  const float along = n[0] * v.normal[0] + n[1] * v.normal[1] + n[2] * v.normal[2];
  const float across = std::sqrt(std::max(1.0f - along * along, 0.0f));
  return std::max(-v.ball_radius, along * v.slab_offset - std::abs(along) * v.slab_half - across * v.ball_radius);
}

/// Sets gap and slope of each child against `fixed`, the volume of the other tree, along the best of the axes.
/// @param projections of the differences of the balls' centres on ray.axis: the child with the least is the most likely
/// to be hit first
HWY_INLINE void bound_children(const CastNode& node, const CastVolume& fixed, const Ray& ray, float* HWY_RESTRICT gaps,
                               float* HWY_RESTRICT slopes, float* HWY_RESTRICT projections) {
  const V zero = hn::Zero(k_lanes);
  const V target = set(ray.target);
  float at[3], box_at[3];  // centres of the fixed ball and box at t0
  for (std::size_t k = 0; k < 3; ++k) {
    at[k] = fixed.ball_center[k] + ray.shift[k];
    box_at[k] = fixed.center[k] + ray.shift[k];
  }

  // The axis of the best hit. If it culls all children, whatever the number of lanes, the others are not tried.
  const float fixed_on_axis = support_value(ray.axis, fixed) - ray.target;
  bool all = true;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    V n[3], normal[3];
    V centers = zero;
    for (std::size_t k = 0; k < 3; ++k) {
      n[k] = set(ray.axis[k]);
      normal[k] = hn::Load(k_lanes, node.normal[k] + i);
      centers = unfused_mul_add(n[k], hn::Add(hn::Load(k_lanes, node.ball_center[k] + i), set(at[k])), centers);
    }
    const V child = support_value(n, hn::Load(k_lanes, node.ball_radius + i), normal,
                                  hn::Load(k_lanes, node.slab_offset + i), hn::Load(k_lanes, node.slab_half + i));
    const V gap = hn::Add(hn::Add(centers, child), set(fixed_on_axis));
    hn::Store(centers, k_lanes, projections + i);
    hn::Store(gap, k_lanes, gaps + i);
    hn::Store(set(ray.axis_slope()), k_lanes, slopes + i);
    all = all && hn::AllTrue(k_lanes, hn::Gt(gap, set(ray.slack)));
  }
  if (all) return;

  const V fixed_radius = set(fixed.ball_radius);
  const V fixed_offset = set(fixed.slab_offset);
  const V fixed_half = set(fixed.slab_half);
  const V fixed_normal[3] = {set(fixed.normal[0]), set(fixed.normal[1]), set(fixed.normal[2])};
  // The fixed slab's normal, of the side with n . u >= 0.
  const float fixed_rate = fixed.normal[0] * ray.u[0] + fixed.normal[1] * ray.u[1] + fixed.normal[2] * ray.u[2];
  const float sign = fixed_rate < 0.0f ? -1.0f : 1.0f;
  const float fixed_on_normal = sign * fixed.slab_offset - fixed.slab_half - ray.target;

  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    V w[3], normal[3];  // w: difference of the balls' centres at t0
    for (std::size_t k = 0; k < 3; ++k) {
      w[k] = hn::Add(hn::Load(k_lanes, node.ball_center[k] + i), set(at[k]));
      normal[k] = hn::Load(k_lanes, node.normal[k] + i);
    }
    const V radius = hn::Load(k_lanes, node.ball_radius + i);
    const V slab_offset = hn::Load(k_lanes, node.slab_offset + i);
    const V slab_half = hn::Load(k_lanes, node.slab_half + i);
    V gap = hn::Load(k_lanes, gaps + i);
    V slope = hn::Load(k_lanes, slopes + i);
    const auto keep_larger = [&gap, &slope](V other_gap, V other_slope) {
      slope = hn::IfThenElse(hn::Gt(other_gap, gap), other_slope, slope);
      gap = hn::Max(gap, other_gap);
    };
    V later = zero;  // from t0 to where the centres are nearest
    for (std::size_t k = 0; k < 3; ++k) later = unfused_sub_mul(later, w[k], set(ray.u[k]));
    later = hn::Max(later, zero);
    {  // From ball centre to ball centre.
      V near[3];
      V length2 = set(k_smallest_square);
      for (std::size_t k = 0; k < 3; ++k) {
        near[k] = unfused_mul_add(later, set(ray.u[k]), w[k]);
        length2 = unfused_mul_add(near[k], near[k], length2);
      }
      const V length = hn::Sqrt(length2);
      const V inverse = hn::Div(set(static_cast<float>(k_axis_length)), length);
      const V n[3] = {hn::Mul(near[0], inverse), hn::Mul(near[1], inverse), hn::Mul(near[2], inverse)};
      V centers = hn::Add(length, support_value(n, radius, normal, slab_offset, slab_half));
      centers = hn::Add(centers, support_value(n, fixed_radius, fixed_normal, fixed_offset, fixed_half));
      V rate = hn::Mul(n[0], set(ray.u[0]));
      rate = unfused_mul_add(n[1], set(ray.u[1]), rate);
      rate = unfused_mul_add(n[2], set(ray.u[2]), rate);
      centers = hn::Sub(centers, hn::Max(hn::Mul(later, rate), hn::Mul(set(ray.reach), hn::Neg(rate))));
      keep_larger(hn::Sub(centers, target), hn::Max(rate, zero));
    }
    {  // From box to box.
      V squared = zero;
      V length_times_rate = zero;
      for (std::size_t k = 0; k < 3; ++k) {
        const V half = hn::Add(hn::Load(k_lanes, node.half[k] + i), set(fixed.half[k]));
        const V center =
            unfused_mul_add(later, set(ray.u[k]), hn::Add(hn::Load(k_lanes, node.center[k] + i), set(box_at[k])));
        const V apart = hn::Max(hn::Sub(hn::Abs(center), half), zero);
        squared = unfused_mul_add(apart, apart, squared);
        length_times_rate = unfused_mul_add(hn::CopySign(apart, center), set(ray.u[k]), length_times_rate);
      }
      const V length = hn::Sqrt(hn::Max(squared, set(k_smallest_square)));
      const V rate = hn::Div(length_times_rate, length);
      const V at_t0 = hn::Sub(length, hn::Mul(later, rate));
      const V boxes = hn::IfThenElse(hn::Ge(length_times_rate, zero), at_t0, set(CastFront::k_no_bound));
      keep_larger(hn::Sub(boxes, target), rate);
    }
    {  // The normals of both slabs.
      const V fixed_n[3] = {set(sign * fixed.normal[0]), set(sign * fixed.normal[1]), set(sign * fixed.normal[2])};
      V on_fixed = zero;  // projections on the fixed slab's normal
      V child_rate = zero;
      V middle = slab_offset;  // of the child's slab, on its normal
      for (std::size_t k = 0; k < 3; ++k) {
        on_fixed = unfused_mul_add(fixed_n[k], w[k], on_fixed);
        child_rate = unfused_mul_add(normal[k], set(ray.u[k]), child_rate);
        middle = unfused_mul_add(normal[k], w[k], middle);
      }
      on_fixed = hn::Add(on_fixed,
                         hn::Add(support_value(fixed_n, radius, normal, slab_offset, slab_half), set(fixed_on_normal)));
      const V on_child = hn::IfThenElse(hn::Lt(child_rate, zero), hn::Neg(middle), middle);
      const V flip = hn::CopySign(set(1.0f), child_rate);
      const V child_n[3] = {hn::Mul(flip, normal[0]), hn::Mul(flip, normal[1]), hn::Mul(flip, normal[2])};
      const V fixed_support = support_value(child_n, fixed_radius, fixed_normal, fixed_offset, fixed_half);
      keep_larger(on_fixed, set(sign * fixed_rate));
      keep_larger(hn::Sub(hn::Add(hn::Sub(on_child, slab_half), fixed_support), target), hn::Abs(child_rate));
    }
    hn::Store(gap, k_lanes, gaps + i);
    hn::Store(slope, k_lanes, slopes + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ray_cast
HWY_AFTER_NAMESPACE();

#endif
