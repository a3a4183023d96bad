// Compiled once per instruction set: part of distance_traversal.cpp, included by nothing else.
#if defined(SIXDOF_ORACLE_DISTANCE_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_ORACLE_DISTANCE_LEAF_INL_H_
#undef SIXDOF_ORACLE_DISTANCE_LEAF_INL_H_
#else
#define SIXDOF_ORACLE_DISTANCE_LEAF_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/distance_bounds-inl.h>

// Lower bounds on the distances of all pairs of triangles of two leaves, one pair per SIMD lane.

HWY_BEFORE_NAMESPACE();
namespace sixdof::detail {
namespace HWY_NAMESPACE {

constexpr std::uint32_t k_leaf = Tree::k_leaf_triangles;

/// All pairs of triangles of two leaves, in A's frame relative to its centre. Lane 4 i + j holds pair (i, j).
struct LeafPair {
  static constexpr std::size_t k_pairs = k_leaf * k_leaf;
  HWY_ALIGN float a[3][3][k_pairs];  // [corner][axis][pair]
  HWY_ALIGN float b[3][3][k_pairs];
  HWY_ALIGN float bounds[k_pairs];
  HWY_ALIGN float reached[k_pairs];  // distance of some points of the two: an upper bound, but for rounding
};

/// Bounds along w alone; the corners stay in their own frames. Returns whether any pair is left.
HWY_INLINE bool bound_toward(const Tree::Leaf& a, const Tree::Leaf& b, const Frame& f, const Slack& slack, float best,
                             float* HWY_RESTRICT bounds) {
  const hn::CappedTag<float, k_leaf> d;
  HWY_ALIGN float far_a[k_leaf];
  HWY_ALIGN float near_b[k_leaf];
  for (std::size_t i = 0; i < k_leaf; i += hn::Lanes(d)) {
    auto most = hn::Set(d, -Tree::k_empty);
    auto least = hn::Set(d, Tree::k_empty);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      auto along_a = hn::Zero(d);
      auto along_b = hn::Zero(d);
      for (std::size_t k = 0; k < 3; ++k) {
        along_a = hn::MulAdd(hn::Set(d, f.toward[k]), hn::Load(d, a.corner[corner][k] + i), along_a);
        along_b = hn::MulAdd(hn::Set(d, f.toward_fixed[k]), hn::Load(d, b.corner[corner][k] + i), along_b);
      }
      most = hn::Max(most, along_a);
      least = hn::Min(least, along_b);
    }
    hn::Store(most, d, far_a + i);
    hn::Store(least, d, near_b + i);
  }
  const double shift = f.translation_along - static_cast<double>(slack.sizes);
  const float nearest = std::min(std::min(near_b[0], near_b[1]), std::min(near_b[2], near_b[3]));
  const float farthest = std::max(std::max(far_a[0], far_a[1]), std::max(far_a[2], far_a[3]));
  if (static_cast<float>(static_cast<double>(nearest - farthest) + shift) > best) return false;
  for (std::size_t i = 0; i < k_leaf; ++i) {
    for (std::size_t j = 0; j < k_leaf; ++j) {
      bounds[k_leaf * i + j] = static_cast<float>(static_cast<double>(near_b[j] - far_a[i]) + shift);
    }
  }
  return true;
}

/// Lays out all pairs; B's corners are turned into A's frame.
HWY_INLINE void lay_out(const Tree::Leaf& a, const Tree::Leaf& b, const Frame& f, LeafPair& pairs) {
  const hn::CappedTag<float, k_leaf> d;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < k_leaf; j += hn::Lanes(d)) {
        auto p = hn::Set(d, f.translation[k]);
        for (std::size_t m = 0; m < 3; ++m) {
          p = hn::MulAdd(hn::Set(d, f.rotation[k][m]), hn::Load(d, b.corner[corner][m] + j), p);
        }
        for (std::size_t i = 0; i < k_leaf; ++i) {
          hn::Store(p, d, pairs.b[corner][k] + k_leaf * i + j);
          hn::Store(hn::Set(d, a.corner[corner][k][i]), d, pairs.a[corner][k] + k_leaf * i + j);
        }
      }
    }
  }
}

/// Raises the bounds by Frank-Wolfe steps towards the closest points of the triangles' difference.
HWY_INLINE void bound_triangles(LeafPair& pairs, float slack, float enough) {
  constexpr int k_steps = 5;
  const V goal = hn::Set(k_lanes, enough);
  for (std::size_t i = 0; i < LeafPair::k_pairs; i += hn::Lanes(k_lanes)) {
    const auto load = [i](const float* p) { return hn::Load(k_lanes, p + i); };
    V best = load(pairs.bounds);
    if (hn::AllTrue(k_lanes, hn::Gt(best, goal))) {
      hn::Store(hn::Set(k_lanes, Tree::k_empty), k_lanes, pairs.reached + i);
      continue;
    }
    V x[3];  // a difference b - a of points of the triangles: first of the centroids, then ever shorter
    for (std::size_t k = 0; k < 3; ++k) {
      const V p = hn::Add(hn::Add(load(pairs.a[0][k]), load(pairs.a[1][k])), load(pairs.a[2][k]));
      const V q = hn::Add(hn::Add(load(pairs.b[0][k]), load(pairs.b[1][k])), load(pairs.b[2][k]));
      x[k] = hn::Mul(hn::Set(k_lanes, 1.0f / 3.0f), hn::Sub(q, p));
    }
    V length;
    for (int step = 0;; ++step) {
      // The corners of a farthest and of b least far along x.
      V far_a, far_b;
      V p[3], q[3];
      for (std::size_t corner = 0; corner < 3; ++corner) {
        V along_a = hn::Mul(x[0], load(pairs.a[corner][0]));
        V along_b = hn::Mul(x[0], load(pairs.b[corner][0]));
        for (std::size_t k = 1; k < 3; ++k) {
          along_a = hn::MulAdd(x[k], load(pairs.a[corner][k]), along_a);
          along_b = hn::MulAdd(x[k], load(pairs.b[corner][k]), along_b);
        }
        if (corner == 0) {
          far_a = along_a;
          far_b = along_b;
          for (std::size_t k = 0; k < 3; ++k) {
            p[k] = load(pairs.a[0][k]);
            q[k] = load(pairs.b[0][k]);
          }
        } else {
          const auto farther = hn::Gt(along_a, far_a);
          const auto nearer = hn::Lt(along_b, far_b);
          far_a = hn::Max(along_a, far_a);
          far_b = hn::Min(along_b, far_b);
          for (std::size_t k = 0; k < 3; ++k) {
            p[k] = hn::IfThenElse(farther, load(pairs.a[corner][k]), p[k]);
            q[k] = hn::IfThenElse(nearer, load(pairs.b[corner][k]), q[k]);
          }
        }
      }
      V length2 = hn::Mul(x[0], x[0]);
      for (std::size_t k = 1; k < 3; ++k) length2 = hn::MulAdd(x[k], x[k], length2);
      length = hn::Sqrt(hn::Max(length2, hn::Set(k_lanes, 1e-36f)));
      best = hn::Max(best, hn::Sub(hn::Div(hn::Sub(far_b, far_a), length), hn::Set(k_lanes, slack)));
      if (step == k_steps || hn::AllTrue(k_lanes, hn::Gt(best, goal))) break;
      V d[3];
      V down = hn::Zero(k_lanes);
      V norm = hn::Set(k_lanes, 1e-36f);
      for (std::size_t k = 0; k < 3; ++k) {
        d[k] = hn::Sub(hn::Sub(q[k], p[k]), x[k]);
        down = hn::NegMulAdd(x[k], d[k], down);
        norm = hn::MulAdd(d[k], d[k], norm);
      }
      const V t = hn::Min(hn::Max(hn::Div(down, norm), hn::Zero(k_lanes)), hn::Set(k_lanes, 1.0f));
      for (std::size_t k = 0; k < 3; ++k) x[k] = hn::MulAdd(t, d[k], x[k]);
    }
    hn::Store(best, k_lanes, pairs.bounds + i);
    hn::Store(length, k_lanes, pairs.reached + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::detail
HWY_AFTER_NAMESPACE();

#endif
