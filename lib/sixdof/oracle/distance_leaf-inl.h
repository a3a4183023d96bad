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
#include <sixdof/oracle/frank_wolfe-inl.h>

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
  HWY_ALIGN float lower[k_pairs];  // bounds on the distance
  HWY_ALIGN float upper[k_pairs];  // but for rounding; set for pairs whose lower bound is not above the best
};

/// Lower bounds by the axis w alone. Returns false if all are above `best`.
HWY_INLINE bool bound_along_direction(const Tree::Leaf& a, const Tree::Leaf& b, const Frame& f, const Slack& slack,
                                      float best, float* HWY_RESTRICT lower) {
  const hn::CappedTag<float, k_leaf> d;
  HWY_ALIGN float greatest_a[k_leaf];
  HWY_ALIGN float least_b[k_leaf];
  for (std::size_t i = 0; i < k_leaf; i += hn::Lanes(d)) {
    auto greatest = hn::Set(d, -Tree::k_empty);
    auto least = hn::Set(d, Tree::k_empty);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      auto along_a = hn::Zero(d);
      auto along_b = hn::Zero(d);
      for (std::size_t k = 0; k < 3; ++k) {
        along_a = hn::MulAdd(hn::Set(d, f.direction[k]), hn::Load(d, a.corner[corner][k] + i), along_a);
        along_b = hn::MulAdd(hn::Set(d, f.direction_fixed[k]), hn::Load(d, b.corner[corner][k] + i), along_b);
      }
      greatest = hn::Max(greatest, along_a);
      least = hn::Min(least, along_b);
    }
    hn::Store(greatest, d, greatest_a + i);
    hn::Store(least, d, least_b + i);
  }
  const double shift = f.translation_along - static_cast<double>(slack.local);
  const float least = std::min(std::min(least_b[0], least_b[1]), std::min(least_b[2], least_b[3]));
  const float greatest = std::max(std::max(greatest_a[0], greatest_a[1]), std::max(greatest_a[2], greatest_a[3]));
  if (static_cast<float>(static_cast<double>(least - greatest) + shift) > best) return false;
  for (std::size_t i = 0; i < k_leaf; ++i) {
    for (std::size_t j = 0; j < k_leaf; ++j) {
      lower[k_leaf * i + j] = static_cast<float>(static_cast<double>(least_b[j] - greatest_a[i]) + shift);
    }
  }
  return true;
}

/// Writes the corners of all pairs; those of B are transformed to A's frame.
HWY_INLINE void load_pairs(const Tree::Leaf& a, const Tree::Leaf& b, const Frame& f, LeafPair& pairs) {
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

/// Raises the lower bounds by Frank-Wolfe steps, until they are above `enough` or k_steps are done.
HWY_INLINE void bound_triangles(LeafPair& pairs, float slack, float enough) {
  namespace fw = frank_wolfe::HWY_NAMESPACE;
  constexpr int k_steps = 5;
  const V goal = hn::Set(k_lanes, enough);
  for (std::size_t i = 0; i < LeafPair::k_pairs; i += hn::Lanes(k_lanes)) {
    const auto load = [i](const float* p) { return hn::Load(k_lanes, p + i); };
    V lower = load(pairs.lower);
    if (hn::AllTrue(k_lanes, hn::Gt(lower, goal))) {
      hn::Store(hn::Set(k_lanes, Tree::k_empty), k_lanes, pairs.upper + i);
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
      const auto of_a = fw::support<fw::Fused, fw::Extreme::greatest>(k_lanes, x, pairs.a, i);
      const auto of_b = fw::support<fw::Fused, fw::Extreme::least>(k_lanes, x, pairs.b, i);
      length = fw::length<fw::Fused>(k_lanes, x);
      lower = hn::Max(lower, hn::Sub(hn::Div(hn::Sub(of_b.value, of_a.value), length), hn::Set(k_lanes, slack)));
      if (step == k_steps || hn::AllTrue(k_lanes, hn::Gt(lower, goal))) break;
      const V s[3] = {hn::Sub(of_b.point[0], of_a.point[0]), hn::Sub(of_b.point[1], of_a.point[1]),
                      hn::Sub(of_b.point[2], of_a.point[2])};
      fw::step<fw::Fused>(k_lanes, x, s);
    }
    hn::Store(lower, k_lanes, pairs.lower + i);
    hn::Store(length, k_lanes, pairs.upper + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::detail
HWY_AFTER_NAMESPACE();

#endif
