// Compiled once per instruction set: part of ray_cast_traversal.cpp, included by nothing else.
#if defined(SIXDOF_CONFIGURATION_RAY_CAST_LEAVES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_CONFIGURATION_RAY_CAST_LEAVES_INL_H_
#undef SIXDOF_CONFIGURATION_RAY_CAST_LEAVES_INL_H_
#else
#define SIXDOF_CONFIGURATION_RAY_CAST_LEAVES_INL_H_
#endif

#include <cstddef>

#include <hwy/highway.h>

#include <sixdof/configuration/ray_cast_bounds-inl.h>

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

/// By how much each pair's distance surely exceeds the aim from ray.travel on, and the gap's slope: Frank-Wolfe steps
/// towards the point of S + {t u, t >= ray.travel} that is nearest to the origin.
HWY_INLINE void bound_triangles(LeafPair& pairs, const Ray& ray) {
  constexpr int k_steps = 5;
  const V zero = hn::Zero(k_lanes);
  const V tiny = set(k_tiny_square);
  const V enough = set(ray.slack);
  for (std::size_t i = 0; i < LeafPair::k_pairs; i += hn::Lanes(k_lanes)) {
    const auto load = [i](const float* p) { return hn::Load(k_lanes, p + i); };
    V x[3] = {set(ray.axis[0]), set(ray.axis[1]), set(ray.axis[2])};
    V best = set(-Tree::k_empty);
    V best_slope = zero;
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
      V slope = hn::Mul(x[0], set(ray.u[0]));
      for (std::size_t k = 1; k < 3; ++k) slope = mul_add(x[k], set(ray.u[k]), slope);
      slope = hn::Div(slope, length);
      // Rounding may have left a slope below 0.
      const V drop = hn::Mul(set(ray.reach), hn::Min(slope, zero));
      const V gap = hn::Add(hn::Sub(hn::Div(hn::Add(low_a, low_b), length), set(ray.aim)), drop);
      const auto better = hn::And(hn::Le(best, enough), hn::Gt(gap, best));  // what is enough stays
      best_slope = hn::IfThenElse(better, hn::Max(slope, zero), best_slope);
      best = hn::IfThenElse(better, gap, best);
      if (step == k_steps || hn::AllTrue(k_lanes, hn::Gt(best, enough))) break;
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
      V up = zero;
      for (std::size_t k = 0; k < 3; ++k) up = sub_mul(up, x[k], set(ray.u[k]));
      up = hn::Max(up, zero);
      for (std::size_t k = 0; k < 3; ++k) x[k] = mul_add(up, set(ray.u[k]), x[k]);
    }
    hn::Store(best, k_lanes, pairs.gaps + i);
    hn::Store(best_slope, k_lanes, pairs.slopes + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ray_cast
HWY_AFTER_NAMESPACE();

#endif
