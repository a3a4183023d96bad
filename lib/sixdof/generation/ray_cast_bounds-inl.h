// Compiled once per instruction set: part of ray_cast_traversal.cpp, included by nothing else.
#if defined(SIXDOF_CONFIGURATION_RAY_CAST_BOUNDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_CONFIGURATION_RAY_CAST_BOUNDS_INL_H_
#undef SIXDOF_CONFIGURATION_RAY_CAST_BOUNDS_INL_H_
#else
#define SIXDOF_CONFIGURATION_RAY_CAST_BOUNDS_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <hwy/highway.h>

#include <sixdof/generation/ray_cast_front.h>
#include <sixdof/generation/ray_cast_tree.h>

// Let S be the set of differences b - a (b in B at translation 0, a in A), a Minkowski sum of B and the mirrored A. B at
// translation t is at least d away from A for every t >= t0 if some unit vector n with n . u >= 0 has
//   n . (s + t0 u) >= d for all s in S:
// moving on along u only adds to the left side. A pair of volumes that passes this test for the translation t0 found so far
// cannot raise it. That is all there is: no ray parameter is ever divided by n . u, grazing rays are no special case.
// The left side is a line in t0, and does not depend on d: what culls a pair for one target, culls it for many.
//
// Axes n tried for a pair of volumes, each the intersection of a box, a ball and a slab:
//   - the normal at the closest points found so far: where surfaces are smooth it is close to the best for every pair
//     that matters, and slabs make it tight to second order in the size of the patches;
//   - from centre to centre, with slabs: tight for small patches at a distance;
//   - from box to box, where the nearest point of the sum of the boxes lies; bounds at that translation are lowered by the
//     way there;
//   - the normals of the slabs.
// Where centres come nearer as t grows beyond t0, boxes and centres are taken at the nearest translation instead. There n .
// u is 0, but for rounding: should it be negative, the bound is lowered by what that could take until the end.
//
// Nothing here uses fused multiply-add, and all else (+ - * / sqrt min max) is rounded by IEEE rules lane by lane. So
// which pairs are looked into, and in what order, is the same on every instruction set.

HWY_BEFORE_NAMESPACE();
namespace sixdof::ray_cast {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, Tree::k_width>;
using V = hn::Vec<Lanes>;

constexpr Lanes k_lanes;
constexpr std::size_t k_width = Tree::k_width;
constexpr std::size_t k_leaf_triangles = Tree::k_leaf_triangles;

/// Gaps below this, in units of Cast::size(), are none. Roundings are 6e-8 each of numbers up to Cast::size():
/// - bounds carry up to 16: three of turning a corner, one or two each of fitting, shifting and adding: 1e-6;
/// - a line loses 4 when it is made and 4 when it is read: 5e-7; its slope is off by up to five (n and u are rounded, a
///   dot product has three), which counts with the translation between, at most Cast::size(): 3e-7.
constexpr float k_slack = 2e-6f;

/// Axes are shorter than unit vectors by more than their rounding: a gap along them never exceeds the distance.
constexpr double k_axis_length = 1.0 - 4e-7;

/// Squares of lengths below this are taken for this, so that nothing is divided by zero.
constexpr float k_tiny_square = 1e-36f;

HWY_INLINE V set(float x) { return hn::Set(k_lanes, x); }
HWY_INLINE V mul_add(V x, V y, V z) { return hn::Add(hn::Mul(x, y), z); }
HWY_INLINE V sub_mul(V z, V x, V y) { return hn::Sub(z, hn::Mul(x, y)); }

/// The ray in floats.
struct Ray {
  float u[3];
  float axis[3];
  float target;
  float slack;
  float translations;    ///< The largest that was found so far.
  float reach;     ///< No translation is larger; with some more for rounding.
  float shift[3];  ///< translation * u

  float axis_slope() const { return axis[0] * u[0] + axis[1] * u[1] + axis[2] * u[2]; }
};

/// Smallest n . (p - centre of the ball) over a volume: over the ball, and over the slab with what is left of n over
/// the ball. Both n and the slab's normal are shorter than unit vectors by more than their rounding, so the square root
/// is never below the length of what is left.
HWY_INLINE V lowest(const V* HWY_RESTRICT n, V radius, const V* HWY_RESTRICT normal, V slab_offset, V slab_half) {
  const V along = mul_add(n[2], normal[2], mul_add(n[1], normal[1], hn::Mul(n[0], normal[0])));
  const V rest = hn::Sqrt(hn::Max(sub_mul(set(1.0f), along, along), hn::Zero(k_lanes)));
  V slab = sub_mul(hn::Mul(along, slab_offset), hn::Abs(along), slab_half);
  slab = sub_mul(slab, rest, radius);
  return hn::Max(hn::Neg(radius), slab);
}

/// The same for one volume.
HWY_INLINE float lowest(const float* n, const CastVolume& v) {
  const float along = n[0] * v.normal[0] + n[1] * v.normal[1] + n[2] * v.normal[2];
  const float rest = std::sqrt(std::max(1.0f - along * along, 0.0f));
  return std::max(-v.ball_radius, along * v.slab_offset - std::abs(along) * v.slab_half - rest * v.ball_radius);
}

/// By how much each child's distance from `fixed` surely exceeds the target from ray.translation on.
/// @param slopes of the gaps with the translation, below ray.translation as well
/// @param heights of the balls' centres above the fixed one's along the axis found so far: the lowest is most likely to
/// hold what hits first
HWY_INLINE void bound_children(const CastNode& node, const CastVolume& fixed, const Ray& ray, float* HWY_RESTRICT gaps,
                               float* HWY_RESTRICT slopes, float* HWY_RESTRICT heights) {
  const V zero = hn::Zero(k_lanes);
  const V target = set(ray.target);
  float at[3], box_at[3];
  for (std::size_t k = 0; k < 3; ++k) {
    at[k] = fixed.ball_center[k] + ray.shift[k];
    box_at[k] = fixed.center[k] + ray.shift[k];
  }
  const float axis_lowest = lowest(ray.axis, fixed) - ray.target;
  // The fixed slab's normal, turned to where B comes from.
  const float toward = fixed.normal[0] * ray.u[0] + fixed.normal[1] * ray.u[1] + fixed.normal[2] * ray.u[2];
  const float sign = toward < 0.0f ? -1.0f : 1.0f;
  const float fixed_lowest = sign * fixed.slab_offset - fixed.slab_half - ray.target;

  // The axis found so far: where it culls all children, whatever the number of lanes, that is enough.
  bool all = true;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    V n[3], normal[3];
    V middle = zero;
    for (std::size_t k = 0; k < 3; ++k) {
      n[k] = set(ray.axis[k]);
      normal[k] = hn::Load(k_lanes, node.normal[k] + i);
      middle = mul_add(n[k], hn::Add(hn::Load(k_lanes, node.ball_center[k] + i), set(at[k])), middle);
    }
    const V low = lowest(n, hn::Load(k_lanes, node.ball_radius + i), normal, hn::Load(k_lanes, node.slab_offset + i),
                         hn::Load(k_lanes, node.slab_half + i));
    const V gap = hn::Add(hn::Add(middle, low), set(axis_lowest));
    hn::Store(middle, k_lanes, heights + i);
    hn::Store(gap, k_lanes, gaps + i);
    hn::Store(set(ray.axis_slope()), k_lanes, slopes + i);
    all = all && hn::AllTrue(k_lanes, hn::Gt(gap, set(ray.slack)));
  }
  if (all) return;

  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    V w[3], normal[3];
    for (std::size_t k = 0; k < 3; ++k) {
      w[k] = hn::Add(hn::Load(k_lanes, node.ball_center[k] + i), set(at[k]));
      normal[k] = hn::Load(k_lanes, node.normal[k] + i);
    }
    const V radius = hn::Load(k_lanes, node.ball_radius + i);
    const V slab_offset = hn::Load(k_lanes, node.slab_offset + i);
    const V slab_half = hn::Load(k_lanes, node.slab_half + i);
    V gap = hn::Load(k_lanes, gaps + i);
    V slope = hn::Load(k_lanes, slopes + i);
    const auto take = [&gap, &slope](V other_gap, V other_slope) {
      slope = hn::IfThenElse(hn::Gt(other_gap, gap), other_slope, slope);
      gap = hn::Max(gap, other_gap);
    };
    V later = zero;  // how much farther B goes until the centres are nearest
    for (std::size_t k = 0; k < 3; ++k) later = sub_mul(later, w[k], set(ray.u[k]));
    later = hn::Max(later, zero);
    {  // From centre to centre at the nearest translation.
      V near[3];
      V length2 = set(k_tiny_square);
      for (std::size_t k = 0; k < 3; ++k) {
        near[k] = mul_add(later, set(ray.u[k]), w[k]);
        length2 = mul_add(near[k], near[k], length2);
      }
      const V length = hn::Sqrt(length2);
      const V inverse = hn::Div(set(static_cast<float>(k_axis_length)), length);
      const V n[3] = {hn::Mul(near[0], inverse), hn::Mul(near[1], inverse), hn::Mul(near[2], inverse)};
      const V fixed_normal[3] = {set(fixed.normal[0]), set(fixed.normal[1]), set(fixed.normal[2])};
      V centers = hn::Add(length, lowest(n, radius, normal, slab_offset, slab_half));
      centers = hn::Add(centers,
                        lowest(n, set(fixed.ball_radius), fixed_normal, set(fixed.slab_offset), set(fixed.slab_half)));
      V rate = hn::Mul(n[0], set(ray.u[0]));
      rate = mul_add(n[1], set(ray.u[1]), rate);
      rate = mul_add(n[2], set(ray.u[2]), rate);
      // Now it is less by the way to there.
      centers = hn::Sub(centers, hn::Max(hn::Mul(later, rate), hn::Mul(set(ray.reach), hn::Neg(rate))));
      take(hn::Sub(centers, target), hn::Max(rate, zero));
    }
    {  // From box to box at the nearest translation.
      V squared = zero;
      V up_box = zero;
      for (std::size_t k = 0; k < 3; ++k) {
        const V half = hn::Add(hn::Load(k_lanes, node.half[k] + i), set(fixed.half[k]));
        const V across = mul_add(later, set(ray.u[k]), hn::Add(hn::Load(k_lanes, node.center[k] + i), set(box_at[k])));
        const V apart = hn::Max(hn::Sub(hn::Abs(across), half), zero);
        squared = mul_add(apart, apart, squared);
        up_box = mul_add(hn::CopySign(apart, across), set(ray.u[k]), up_box);
      }
      // As above.
      const V length = hn::Sqrt(hn::Max(squared, set(k_tiny_square)));
      const V rate = hn::Div(up_box, length);
      const V from_now_on = hn::Sub(length, hn::Mul(later, rate));
      const V boxes = hn::IfThenElse(hn::Ge(up_box, zero), from_now_on, set(CastFront::k_never));
      take(hn::Sub(boxes, target), rate);
    }
    {  // The slabs' normals.
      const V fixed_n[3] = {set(sign * fixed.normal[0]), set(sign * fixed.normal[1]), set(sign * fixed.normal[2])};
      V middle = zero;
      V child_up = zero;
      V child_middle = slab_offset;
      for (std::size_t k = 0; k < 3; ++k) {
        middle = mul_add(fixed_n[k], w[k], middle);
        child_up = mul_add(normal[k], set(ray.u[k]), child_up);
        child_middle = mul_add(normal[k], w[k], child_middle);
      }
      middle = hn::Add(middle, hn::Add(lowest(fixed_n, radius, normal, slab_offset, slab_half), set(fixed_lowest)));
      const V turned = hn::IfThenElse(hn::Lt(child_up, zero), hn::Neg(child_middle), child_middle);
      const V fixed_normal[3] = {set(fixed.normal[0]), set(fixed.normal[1]), set(fixed.normal[2])};
      const V flip = hn::CopySign(set(1.0f), child_up);
      const V child_n[3] = {hn::Mul(flip, normal[0]), hn::Mul(flip, normal[1]), hn::Mul(flip, normal[2])};
      const V over =
          lowest(child_n, set(fixed.ball_radius), fixed_normal, set(fixed.slab_offset), set(fixed.slab_half));
      take(middle, set(sign * toward));
      take(hn::Sub(hn::Add(hn::Sub(turned, slab_half), over), target), hn::Abs(child_up));
    }
    hn::Store(gap, k_lanes, gaps + i);
    hn::Store(slope, k_lanes, slopes + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ray_cast
HWY_AFTER_NAMESPACE();

#endif
