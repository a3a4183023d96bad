// Part of ray_cast_search.cpp, which includes it once per instruction set: it has no include guard.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/generation/ray_cast_search.h>
#include <sixdof/generation/ray_cast_tree.h>
#include <sixdof/oracle/lanes-inl.h>

// Separating-axis bounds for one volume against the eight children of a node, one child per SIMD lane. Notation: see
// ray_cast_search.h. For a unit vector n, the gap at t0 = ray.translation is
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

using namespace lanes::HWY_NAMESPACE;

constexpr std::size_t k_leaf_triangles = Tree::k_leaf_triangles;

/// Gaps not above this, in units of Cast::size(), do not count. Roundings are 6e-8 each of numbers up to Cast::size():
/// - a gap carries up to 16: three of transforming a corner, one or two each of fitting, shifting and adding: 1e-6;
/// - a bound carries 4 from where it is made and 4 from where it is read: 5e-7; its slope is off by up to five (n and u
///   are rounded, a dot product has three), times a translation of at most Cast::size(): 3e-7.
constexpr float k_slack = 2e-6f;

/// Length of axes. They are shorter than unit vectors by more than their rounding, so that a gap along them never
/// exceeds the distance.
constexpr double k_axis_length = 1.0 - 4e-7;

/// The ray in single precision.
struct Ray {
  float u[3];
  float axis[3];  ///< Of the best hit, k_axis_length long.
  float target;
  float slack;        ///< k_slack as a length.
  float translation;  ///< Of the best hit: t0.
  float reach;        ///< Cast::reach()
  float shift[3];     ///< t0 u

  explicit Ray(const Cast& cast)
      : target(static_cast<float>(cast.target)),
        slack(static_cast<float>(k_slack * cast.size())),
        reach(static_cast<float>(cast.reach())) {
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
  const V along = dot(n, normal);
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
      normal[k] = load(node.normal[k] + i);
      centers = unfused_mul_add(n[k], hn::Add(load(node.ball_center[k] + i), set(at[k])), centers);
    }
    const V child =
        support_value(n, load(node.ball_radius + i), normal, load(node.slab_offset + i), load(node.slab_half + i));
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
  const V u[3] = {set(ray.u[0]), set(ray.u[1]), set(ray.u[2])};
  // The fixed slab's normal, of the side with n . u >= 0.
  const float fixed_rate = fixed.normal[0] * ray.u[0] + fixed.normal[1] * ray.u[1] + fixed.normal[2] * ray.u[2];
  const float sign = fixed_rate < 0.0f ? -1.0f : 1.0f;
  const float fixed_on_normal = sign * fixed.slab_offset - fixed.slab_half - ray.target;

  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    V w[3], normal[3];  // w: difference of the balls' centres at t0
    for (std::size_t k = 0; k < 3; ++k) {
      w[k] = hn::Add(load(node.ball_center[k] + i), set(at[k]));
      normal[k] = load(node.normal[k] + i);
    }
    const V radius = load(node.ball_radius + i);
    const V slab_offset = load(node.slab_offset + i);
    const V slab_half = load(node.slab_half + i);
    V gap = load(gaps + i);
    V slope = load(slopes + i);
    const auto keep_larger = [&gap, &slope](V other_gap, V other_slope) {
      slope = hn::IfThenElse(hn::Gt(other_gap, gap), other_slope, slope);
      gap = hn::Max(gap, other_gap);
    };
    V later = zero;  // from t0 to where the centres are nearest
    for (std::size_t k = 0; k < 3; ++k) later = unfused_sub_mul(later, w[k], u[k]);
    later = hn::Max(later, zero);
    {  // From ball centre to ball centre.
      V near[3];
      V length2 = set(k_smallest_square);
      for (std::size_t k = 0; k < 3; ++k) {
        near[k] = unfused_mul_add(later, u[k], w[k]);
        length2 = unfused_mul_add(near[k], near[k], length2);
      }
      const V length = hn::Sqrt(length2);
      const V inverse = hn::Div(set(static_cast<float>(k_axis_length)), length);
      const V n[3] = {hn::Mul(near[0], inverse), hn::Mul(near[1], inverse), hn::Mul(near[2], inverse)};
      V centers = hn::Add(length, support_value(n, radius, normal, slab_offset, slab_half));
      centers = hn::Add(centers, support_value(n, fixed_radius, fixed_normal, fixed_offset, fixed_half));
      const V rate = dot(n, u);
      centers = hn::Sub(centers, hn::Max(hn::Mul(later, rate), hn::Mul(set(ray.reach), hn::Neg(rate))));
      keep_larger(hn::Sub(centers, target), hn::Max(rate, zero));
    }
    {  // From box to box.
      V squared = zero;
      V length_times_rate = zero;
      for (std::size_t k = 0; k < 3; ++k) {
        const V half = hn::Add(load(node.half[k] + i), set(fixed.half[k]));
        const V center = unfused_mul_add(later, u[k], hn::Add(load(node.center[k] + i), set(box_at[k])));
        const V apart = hn::Max(hn::Sub(hn::Abs(center), half), zero);
        squared = unfused_mul_add(apart, apart, squared);
        length_times_rate = unfused_mul_add(hn::CopySign(apart, center), u[k], length_times_rate);
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
        child_rate = unfused_mul_add(normal[k], u[k], child_rate);
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

namespace fw = frank_wolfe;

/// Some pairs of triangles of two leaves. Coordinates are relative to a common origin, A's reflected, B's at t0.
struct TrianglePairs {
  static constexpr std::size_t k_count = 8;
  HWY_ALIGN float a[3][3][k_count];  // [corner][axis][pair]
  HWY_ALIGN float b[3][3][k_count];
  HWY_ALIGN float gaps[k_count];
  HWY_ALIGN float slopes[k_count];
};

/// Gaps along the best axes so far, and their slopes.
struct BestAxes {
  V gap;
  V slope;

  /// Takes an axis of any length.
  /// @param support the least axis . s
  /// @param along axis . u; may be below 0 by rounding
  HWY_INLINE void keep_larger(V support, V along, V length, const Ray& ray) {
    const V zero = hn::Zero(k_lanes);
    const V new_slope = hn::Div(along, length);
    const V drop = hn::Mul(set(ray.reach), hn::Min(new_slope, zero));
    const V new_gap = hn::Add(hn::Sub(hn::Div(support, length), set(ray.target)), drop);
    // A gap that culls is not replaced.
    const auto better = hn::And(hn::Le(gap, set(ray.slack)), hn::Gt(new_gap, gap));
    slope = hn::IfThenElse(better, hn::Max(new_slope, zero), slope);
    gap = hn::IfThenElse(better, new_gap, gap);
  }
};

/// Applies the cross products of the ray and each edge as axes, for pairs i .. i + Lanes - 1. Triangles that pass each
/// other, seen along the ray, are separated along one of them, unless their nearest points are corners.
HWY_INLINE void bound_across_ray(const TrianglePairs& pairs, std::size_t i, const Ray& ray, BestAxes& best) {
  const V u[3] = {set(ray.u[0]), set(ray.u[1]), set(ray.u[2])};
  for (const auto* corners : {pairs.a, pairs.b}) {
    for (std::size_t edge = 0; edge < 3; ++edge) {
      V e[3];
      for (std::size_t k = 0; k < 3; ++k) {
        e[k] = hn::Sub(load(corners[(edge + 1) % 3][k] + i), load(corners[edge][k] + i));
      }
      const V n[3] = {unfused_sub_mul(hn::Mul(e[1], u[2]), e[2], u[1]),
                      unfused_sub_mul(hn::Mul(e[2], u[0]), e[0], u[2]),
                      unfused_sub_mul(hn::Mul(e[0], u[1]), e[1], u[0])};
      V least = hn::Zero(k_lanes);
      V greatest = hn::Zero(k_lanes);
      for (const auto* of : {pairs.a, pairs.b}) {
        V projection[3];
        for (std::size_t corner = 0; corner < 3; ++corner) {
          const V p[3] = {load(of[corner][0] + i), load(of[corner][1] + i), load(of[corner][2] + i)};
          projection[corner] = dot(n, p);
        }
        least = hn::Add(least, hn::Min(hn::Min(projection[0], projection[1]), projection[2]));
        greatest = hn::Add(greatest, hn::Max(hn::Max(projection[0], projection[1]), projection[2]));
      }
      const V length = fw::length<fw::Rounding::unfused>(n);
      const V along = dot(n, u);
      best.keep_larger(least, along, length, ray);
      best.keep_larger(hn::Neg(greatest), hn::Neg(along), length, ray);
    }
  }
}

/// Sets gaps and slopes: by Frank-Wolfe steps towards the point of S + {t u, t >= t0} that is nearest to the origin.
/// Each iterate x is an axis. Where the nearest point is one with t > t0 they converge slowly: then axes across the ray
/// are tried at the end.
HWY_INLINE void bound_triangles(TrianglePairs& pairs, const Ray& ray) {
  constexpr auto k_unfused = fw::Rounding::unfused;
  constexpr auto k_least = fw::Extreme::least;
  constexpr int k_steps = 5;
  const V u[3] = {set(ray.u[0]), set(ray.u[1]), set(ray.u[2])};
  const V zero = hn::Zero(k_lanes);
  const V enough = set(ray.slack);
  for (std::size_t i = 0; i < TrianglePairs::k_count; i += hn::Lanes(k_lanes)) {
    V x[3] = {set(ray.axis[0]), set(ray.axis[1]), set(ray.axis[2])};
    BestAxes best{set(-Tree::k_empty), zero};
    V forward = zero;  // the step along u from S to x
    for (int step = 0; step <= k_steps; ++step) {
      const fw::Support a = fw::support<k_unfused, k_least>(x, pairs.a, i);
      const fw::Support b = fw::support<k_unfused, k_least>(x, pairs.b, i);
      const V length = fw::length<k_unfused>(x);
      best.keep_larger(hn::Add(a.value, b.value), dot(x, u), length, ray);
      if (step == k_steps || hn::AllTrue(k_lanes, hn::Gt(best.gap, enough))) break;
      const V s[3] = {hn::Add(a.point[0], b.point[0]), hn::Add(a.point[1], b.point[1]),
                      hn::Add(a.point[2], b.point[2])};
      if (step == 0) {  // x is ray.axis, which is no point of S; s is
        for (std::size_t k = 0; k < 3; ++k) x[k] = s[k];
      } else {
        fw::step<k_unfused>(x, s);
      }
      forward = zero;
      for (std::size_t k = 0; k < 3; ++k) forward = unfused_sub_mul(forward, x[k], u[k]);
      forward = hn::Max(forward, zero);
      for (std::size_t k = 0; k < 3; ++k) x[k] = unfused_mul_add(forward, u[k], x[k]);
    }
    const auto later = hn::And(hn::Le(best.gap, enough), hn::Gt(forward, zero));
    BestAxes across = best;
    if (!hn::AllFalse(k_lanes, later)) bound_across_ray(pairs, i, ray, across);
    hn::Store(hn::IfThenElse(later, across.gap, best.gap), k_lanes, pairs.gaps + i);
    hn::Store(hn::IfThenElse(later, across.slope, best.slope), k_lanes, pairs.slopes + i);
  }
}

/// The least ray.axis . p of each triangle.
HWY_INLINE void support_values(const CastLeaf& leaf, const Ray& ray, float* HWY_RESTRICT values) {
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const auto& p = leaf.corner[corner];
    for (std::size_t i = 0; i < k_leaf_triangles; ++i) {
      const float x = ray.axis[0] * p[0][i] + ray.axis[1] * p[1][i] + ray.axis[2] * p[2][i];
      values[i] = corner == 0 ? x : std::min(values[i], x);
    }
  }
}

/// Lays out some pairs of triangles.
/// @param chosen 4 i + j for pair (i, j); lanes beyond `count` repeat the first
HWY_INLINE void lay_out(const CastLeaf& a, const CastLeaf& b, const Ray& ray, const std::uint32_t* chosen,
                        std::size_t count, TrianglePairs& pairs) {
  for (std::size_t k = 0; k < 3; ++k) {
    // Relative to one corner, so that differences do not round beyond the given floats.
    const float origin = a.corner[0][k][0];
    const float b_shift = origin + ray.shift[k];
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (std::size_t n = 0; n < TrianglePairs::k_count; ++n) {
        const std::uint32_t pair = chosen[n < count ? n : 0];
        pairs.a[corner][k][n] = a.corner[corner][k][pair / k_leaf_triangles] - origin;
        pairs.b[corner][k][n] = b.corner[corner][k][pair % k_leaf_triangles] + b_shift;
      }
    }
  }
}

/// What bounds say about all pairs of triangles of two leaves.
struct LeafBounds {
  float gap;  ///< Together with the slope a bound for all pairs; CastFront::k_no_bound if one is left.
  float slope;
  std::size_t count = 0;                                     ///< Pairs that are left,
  std::uint32_t pairs[k_leaf_triangles * k_leaf_triangles];  ///< 4 i + j each, the smallest gap first.
};

HWY_INLINE LeafBounds bound_leaves(const CastLeaf& a, const CastLeaf& b, const Ray& ray) {
  LeafBounds result;
  // The axis of the best hit, for all pairs at once.
  float support_a[k_leaf_triangles], support_b[k_leaf_triangles];
  support_values(a, ray, support_a);
  support_values(b, ray, support_b);
  const float along = ray.axis[0] * ray.shift[0] + ray.axis[1] * ray.shift[1] + ray.axis[2] * ray.shift[2] - ray.target;
  result.gap = along + *std::min_element(support_a, support_a + k_leaf_triangles) +
               *std::min_element(support_b, support_b + k_leaf_triangles);
  result.slope = ray.axis_slope();
  if (result.gap > ray.slack) return result;

  // Each pair by itself. The line with the least gap and the largest slope bounds all pairs that are culled.
  result.gap = CastFront::k_not_in_front;
  std::uint32_t left[k_leaf_triangles * k_leaf_triangles];  // 4 i + j for pair (i, j)
  std::size_t left_count = 0;
  for (std::uint32_t i = 0; i < a.child.count(); ++i) {
    for (std::uint32_t j = 0; j < b.child.count(); ++j) {
      left[left_count] = static_cast<std::uint32_t>(k_leaf_triangles) * i + j;
      const float gap = along + support_a[i] + support_b[j];
      left_count += gap > ray.slack ? 0 : 1;
      result.gap = gap > ray.slack ? std::min(result.gap, gap) : result.gap;
    }
  }

  float gaps[k_leaf_triangles * k_leaf_triangles];
  TrianglePairs pairs;
  for (std::size_t first = 0; first < left_count; first += TrianglePairs::k_count) {
    const std::size_t count = std::min(TrianglePairs::k_count, left_count - first);
    lay_out(a, b, ray, left + first, count, pairs);
    bound_triangles(pairs, ray);
    for (std::size_t n = 0; n < count; ++n) {
      if (pairs.gaps[n] > ray.slack) {
        result.gap = std::min(result.gap, pairs.gaps[n]);
        result.slope = std::max(result.slope, pairs.slopes[n]);
        continue;
      }
      const std::uint32_t pair = left[first + n];
      gaps[pair] = pairs.gaps[n];
      std::size_t at = result.count++;
      for (; at > 0 && gaps[result.pairs[at - 1]] > gaps[pair]; --at) result.pairs[at] = result.pairs[at - 1];
      result.pairs[at] = pair;
    }
  }
  if (result.count != 0) result.gap = CastFront::k_no_bound;
  return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ray_cast
HWY_AFTER_NAMESPACE();
