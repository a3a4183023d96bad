// Compiled once per instruction set: part of ray_cast_traversal.cpp, included by nothing else.
#if defined(SIXDOF_GENERATION_RAY_CAST_LEAVES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_GENERATION_RAY_CAST_LEAVES_INL_H_
#undef SIXDOF_GENERATION_RAY_CAST_LEAVES_INL_H_
#else
#define SIXDOF_GENERATION_RAY_CAST_LEAVES_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/generation/ray_cast_bounds-inl.h>
#include <sixdof/oracle/frank_wolfe-inl.h>

// Separating-axis bounds for the pairs of triangles of two leaves, one pair per SIMD lane. Gap and slope are as in
// ray_cast_bounds-inl.h.

HWY_BEFORE_NAMESPACE();
namespace sixdof::ray_cast {
namespace HWY_NAMESPACE {

namespace fw = frank_wolfe::HWY_NAMESPACE;

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
  const auto dot = [](const V* n, V x, V y, V z) {
    return unfused_mul_add(n[2], z, unfused_mul_add(n[1], y, hn::Mul(n[0], x)));
  };
  const V u[3] = {set(ray.u[0]), set(ray.u[1]), set(ray.u[2])};
  for (const auto* corners : {pairs.a, pairs.b}) {
    for (std::size_t edge = 0; edge < 3; ++edge) {
      V e[3];
      for (std::size_t k = 0; k < 3; ++k) {
        e[k] = hn::Sub(hn::Load(k_lanes, corners[(edge + 1) % 3][k] + i), hn::Load(k_lanes, corners[edge][k] + i));
      }
      const V n[3] = {unfused_sub_mul(hn::Mul(e[1], u[2]), e[2], u[1]),
                      unfused_sub_mul(hn::Mul(e[2], u[0]), e[0], u[2]),
                      unfused_sub_mul(hn::Mul(e[0], u[1]), e[1], u[0])};
      V least = hn::Zero(k_lanes);
      V greatest = hn::Zero(k_lanes);
      for (const auto* of : {pairs.a, pairs.b}) {
        V projection[3];
        for (std::size_t corner = 0; corner < 3; ++corner) {
          projection[corner] = dot(n, hn::Load(k_lanes, of[corner][0] + i), hn::Load(k_lanes, of[corner][1] + i),
                                   hn::Load(k_lanes, of[corner][2] + i));
        }
        least = hn::Add(least, hn::Min(hn::Min(projection[0], projection[1]), projection[2]));
        greatest = hn::Add(greatest, hn::Max(hn::Max(projection[0], projection[1]), projection[2]));
      }
      const V length = hn::Sqrt(hn::Max(dot(n, n[0], n[1], n[2]), set(k_smallest_square)));
      const V along = dot(n, u[0], u[1], u[2]);
      best.keep_larger(least, along, length, ray);
      best.keep_larger(hn::Neg(greatest), hn::Neg(along), length, ray);
    }
  }
}

/// Sets gaps and slopes: by Frank-Wolfe steps towards the point of S + {t u, t >= t0} that is nearest to the origin.
/// Each iterate x is an axis. Where the nearest point is one with t > t0 they converge slowly: then axes across the ray
/// are tried at the end.
HWY_INLINE void bound_triangles(TrianglePairs& pairs, const Ray& ray) {
  using Arithmetic = fw::Unfused;
  constexpr auto k_least = fw::Extreme::least;
  constexpr int k_steps = 5;
  const V zero = hn::Zero(k_lanes);
  const V enough = set(ray.slack);
  for (std::size_t i = 0; i < TrianglePairs::k_count; i += hn::Lanes(k_lanes)) {
    V x[3] = {set(ray.axis[0]), set(ray.axis[1]), set(ray.axis[2])};
    BestAxes best{set(-Tree::k_empty), zero};
    V forward = zero;  // the step along u from S to x
    for (int step = 0; step <= k_steps; ++step) {
      const fw::Support<V> a = fw::support<Arithmetic, k_least>(k_lanes, x, pairs.a, i);
      const fw::Support<V> b = fw::support<Arithmetic, k_least>(k_lanes, x, pairs.b, i);
      const V length = fw::length<Arithmetic>(k_lanes, x);
      V along = hn::Mul(x[0], set(ray.u[0]));
      for (std::size_t k = 1; k < 3; ++k) along = unfused_mul_add(x[k], set(ray.u[k]), along);
      best.keep_larger(hn::Add(a.value, b.value), along, length, ray);
      if (step == k_steps || hn::AllTrue(k_lanes, hn::Gt(best.gap, enough))) break;
      const V s[3] = {hn::Add(a.point[0], b.point[0]), hn::Add(a.point[1], b.point[1]),
                      hn::Add(a.point[2], b.point[2])};
      if (step == 0) {  // x is ray.axis, which is no point of S; s is
        for (std::size_t k = 0; k < 3; ++k) x[k] = s[k];
      } else {
        fw::step<Arithmetic>(k_lanes, x, s);
      }
      forward = zero;
      for (std::size_t k = 0; k < 3; ++k) forward = unfused_sub_mul(forward, x[k], set(ray.u[k]));
      forward = hn::Max(forward, zero);
      for (std::size_t k = 0; k < 3; ++k) x[k] = unfused_mul_add(forward, set(ray.u[k]), x[k]);
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

#endif
