// Compiled once per instruction set: part of ray_cast_traversal.cpp, included by nothing else.
#if defined(SIXDOF_CONFIGURATION_RAY_CAST_LEAVES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_CONFIGURATION_RAY_CAST_LEAVES_INL_H_
#undef SIXDOF_CONFIGURATION_RAY_CAST_LEAVES_INL_H_
#else
#define SIXDOF_CONFIGURATION_RAY_CAST_LEAVES_INL_H_
#endif

#include <cstddef>

#include <hwy/highway.h>

#include <sixdof/generation/ray_cast_bounds-inl.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::ray_cast {
namespace HWY_NAMESPACE {

/// Some pairs of triangles of two leaves.
struct LeafPair {
  static constexpr std::size_t k_pairs = 8;
  HWY_ALIGN float a[3][3][k_pairs];  // [corner][axis][pair]
  HWY_ALIGN float b[3][3][k_pairs];
  HWY_ALIGN float gaps[k_pairs];
  HWY_ALIGN float slopes[k_pairs];
};

/// Gaps along the best axes so far, and their slopes.
struct Gaps {
  V gap;
  V slope;

  /// @param low the least axis . s over S
  /// @param along axis . u; rounding may have left it below 0
  /// @param length of the axis
  HWY_INLINE void take(V low, V along, V length, const Ray& ray) {
    const V zero = hn::Zero(k_lanes);
    const V new_slope = hn::Div(along, length);
    const V drop = hn::Mul(set(ray.reach), hn::Min(new_slope, zero));
    const V new_gap = hn::Add(hn::Sub(hn::Div(low, length), set(ray.target)), drop);
    const auto better = hn::And(hn::Le(gap, set(ray.slack)), hn::Gt(new_gap, gap));  // what is enough stays
    slope = hn::IfThenElse(better, hn::Max(new_slope, zero), slope);
    gap = hn::IfThenElse(better, new_gap, gap);
  }
};

/// Tries the axes across the ray and an edge, for pairs i .. i + Lanes - 1. Triangles that the ray leads past each
/// other, seen along it, are apart along one of them, or their nearest corners are.
HWY_INLINE void pass_by(const LeafPair& pairs, std::size_t i, const Ray& ray, Gaps& best) {
  const auto dot = [](const V* n, V x, V y, V z) { return mul_add(n[2], z, mul_add(n[1], y, hn::Mul(n[0], x))); };
  const V u[3] = {set(ray.u[0]), set(ray.u[1]), set(ray.u[2])};
  for (const auto* corners : {pairs.a, pairs.b}) {
    for (std::size_t edge = 0; edge < 3; ++edge) {
      V e[3];
      for (std::size_t k = 0; k < 3; ++k) {
        e[k] = hn::Sub(hn::Load(k_lanes, corners[(edge + 1) % 3][k] + i), hn::Load(k_lanes, corners[edge][k] + i));
      }
      const V n[3] = {sub_mul(hn::Mul(e[1], u[2]), e[2], u[1]), sub_mul(hn::Mul(e[2], u[0]), e[0], u[2]),
                      sub_mul(hn::Mul(e[0], u[1]), e[1], u[0])};
      V low = hn::Zero(k_lanes);
      V high = hn::Zero(k_lanes);
      for (const auto* of : {pairs.a, pairs.b}) {
        V heights[3];
        for (std::size_t corner = 0; corner < 3; ++corner) {
          heights[corner] = dot(n, hn::Load(k_lanes, of[corner][0] + i), hn::Load(k_lanes, of[corner][1] + i),
                                hn::Load(k_lanes, of[corner][2] + i));
        }
        low = hn::Add(low, hn::Min(hn::Min(heights[0], heights[1]), heights[2]));
        high = hn::Add(high, hn::Max(hn::Max(heights[0], heights[1]), heights[2]));
      }
      const V length = hn::Sqrt(hn::Max(dot(n, n[0], n[1], n[2]), set(k_tiny_square)));
      const V along = dot(n, u[0], u[1], u[2]);
      best.take(low, along, length, ray);
      best.take(hn::Neg(high), hn::Neg(along), length, ray);
    }
  }
}

/// By how much each pair's distance surely exceeds the target from ray.translation on, and the gap's slope: Frank-Wolfe steps
/// towards the point of S + {t u, t >= ray.translation} that is nearest to the origin. Where that is a point of a later
/// translation they may be many: then axes across the ray are tried at last.
HWY_INLINE void bound_triangles(LeafPair& pairs, const Ray& ray) {
  constexpr int k_steps = 5;
  const V zero = hn::Zero(k_lanes);
  const V tiny = set(k_tiny_square);
  const V enough = set(ray.slack);
  for (std::size_t i = 0; i < LeafPair::k_pairs; i += hn::Lanes(k_lanes)) {
    const auto load = [i](const float* p) { return hn::Load(k_lanes, p + i); };
    V x[3] = {set(ray.axis[0]), set(ray.axis[1]), set(ray.axis[2])};
    Gaps best{set(-Tree::k_empty), zero};
    V up = zero;
    for (int step = 0; step <= k_steps; ++step) {
      // The corners that lie lowest along x.
      V low_a, low_b;
      V p[3], q[3];
      for (std::size_t corner = 0; corner < 3; ++corner) {
        V along_a = hn::Mul(x[0], load(pairs.a[corner][0]));
        V along_b = hn::Mul(x[0], load(pairs.b[corner][0]));
        for (std::size_t k = 1; k < 3; ++k) {
          along_a = mul_add(x[k], load(pairs.a[corner][k]), along_a);
          along_b = mul_add(x[k], load(pairs.b[corner][k]), along_b);
        }
        if (corner == 0) {
          low_a = along_a;
          low_b = along_b;
          for (std::size_t k = 0; k < 3; ++k) {
            p[k] = load(pairs.a[0][k]);
            q[k] = load(pairs.b[0][k]);
          }
        } else {
          const auto lower_a = hn::Lt(along_a, low_a);
          const auto lower_b = hn::Lt(along_b, low_b);
          low_a = hn::Min(along_a, low_a);
          low_b = hn::Min(along_b, low_b);
          for (std::size_t k = 0; k < 3; ++k) {
            p[k] = hn::IfThenElse(lower_a, load(pairs.a[corner][k]), p[k]);
            q[k] = hn::IfThenElse(lower_b, load(pairs.b[corner][k]), q[k]);
          }
        }
      }
      V length2 = hn::Mul(x[0], x[0]);
      for (std::size_t k = 1; k < 3; ++k) length2 = mul_add(x[k], x[k], length2);
      const V length = hn::Sqrt(hn::Max(length2, tiny));
      V along = hn::Mul(x[0], set(ray.u[0]));
      for (std::size_t k = 1; k < 3; ++k) along = mul_add(x[k], set(ray.u[k]), along);
      best.take(hn::Add(low_a, low_b), along, length, ray);
      if (step == k_steps || hn::AllTrue(k_lanes, hn::Gt(best.gap, enough))) break;
      V d[3];
      for (std::size_t k = 0; k < 3; ++k) d[k] = hn::Add(p[k], q[k]);
      if (step == 0) {  // the axis is no point of S; d is
        for (std::size_t k = 0; k < 3; ++k) x[k] = d[k];
      } else {
        V down = zero;
        V norm = tiny;
        for (std::size_t k = 0; k < 3; ++k) {
          d[k] = hn::Sub(d[k], x[k]);
          down = sub_mul(down, x[k], d[k]);
          norm = mul_add(d[k], d[k], norm);
        }
        const V t = hn::Min(hn::Max(hn::Div(down, norm), zero), set(1.0f));
        for (std::size_t k = 0; k < 3; ++k) x[k] = mul_add(t, d[k], x[k]);
      }
      up = zero;
      for (std::size_t k = 0; k < 3; ++k) up = sub_mul(up, x[k], set(ray.u[k]));
      up = hn::Max(up, zero);
      for (std::size_t k = 0; k < 3; ++k) x[k] = mul_add(up, set(ray.u[k]), x[k]);
    }
    const auto later = hn::And(hn::Le(best.gap, enough), hn::Gt(up, zero));
    Gaps passing = best;
    if (!hn::AllFalse(k_lanes, later)) pass_by(pairs, i, ray, passing);
    hn::Store(hn::IfThenElse(later, passing.gap, best.gap), k_lanes, pairs.gaps + i);
    hn::Store(hn::IfThenElse(later, passing.slope, best.slope), k_lanes, pairs.slopes + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ray_cast
HWY_AFTER_NAMESPACE();

#endif
