// Part of oracle/distance_bounds-inl.h and of oracle/ray_cast_bounds-inl.h: the pairs of triangles of two leaves.
// Taken once per instruction set: the guard is Highway's for that.
#if defined(SIXDOF_PROXIMITY_LEAF_PAIRS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_PROXIMITY_LEAF_PAIRS_INL_H_
#undef SIXDOF_PROXIMITY_LEAF_PAIRS_INL_H_
#else
#define SIXDOF_PROXIMITY_LEAF_PAIRS_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/geometry/tree.h>
#include <sixdof/proximity/frames.h>
#include <sixdof/proximity/lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::leaf_pairs {
namespace HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using detail::Frame;
using detail::Frames;

/// All pairs of triangles of two leaves, in A's frame relative to its centre. Lane 4 i + j holds pair (i, j).
struct LeafPair {
  HWY_ALIGN float a[3][3][k_pairs];  // [corner][axis][pair]
  HWY_ALIGN float b[3][3][k_pairs];
  HWY_ALIGN float lower[k_pairs];  // bounds on the distance
  HWY_ALIGN float upper[k_pairs];  // but for rounding; set for pairs whose lower bound is not above the best
};

/// Bits of the pairs for which x is below the limit,
HWY_INLINE std::uint32_t pairs_below(const float (&x)[k_pairs], float limit) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_pairs; i += hn::Lanes(k_lanes)) {
    bits |= bits_of(hn::Lt(load(x + i), set(limit)), i);
  }
  return bits;
}
/// and for which it is not above. A bound that is no number excludes nothing.
HWY_INLINE std::uint32_t pairs_within(const float (&x)[k_pairs], float limit) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_pairs; i += hn::Lanes(k_lanes)) {
    bits |= bits_of(hn::Not(hn::Gt(load(x + i), set(limit))), i);
  }
  return bits;
}

/// Sorts pairs (bits) by x, the smallest first. Returns their number.
HWY_INLINE std::size_t sort_pairs(std::uint32_t bits, const float (&x)[k_pairs], std::uint32_t (&sorted)[k_pairs]) {
  std::size_t count = 0;
  for (; bits != 0; bits &= bits - 1) {
    const auto pair = static_cast<std::uint32_t>(std::countr_zero(bits));
    std::size_t at = count++;
    for (; at > 0 && x[sorted[at - 1]] > x[pair]; --at) sorted[at] = sorted[at - 1];
    sorted[at] = pair;
  }
  return count;
}

/// Lower bounds by the axis w alone, less `slack`. Returns the least; if that is above `best` it sets none.
template <Rounding rounding>
HWY_INLINE float bound_along_direction(const Tree::Leaf& a, const Tree::Leaf& b, const Frames& frames, float slack,
                                       float best, float* HWY_RESTRICT lower) {
  const hn::CappedTag<float, k_leaf> d;
  HWY_ALIGN float front_a[k_leaf], front_b[k_leaf];  // how far triangles reach towards the other body
  const auto set_front = [&](const Tree::Leaf& leaf, const Frame& f, float* front) {
    for (std::size_t i = 0; i < k_leaf; i += hn::Lanes(d)) {
      auto greatest = hn::Set(d, -Tree::k_empty);
      for (std::size_t corner = 0; corner < 3; ++corner) {
        auto along = hn::Zero(d);
        for (std::size_t k = 0; k < 3; ++k) {
          along = mul_add<rounding>(hn::Set(d, f.direction[k]), hn::Load(d, leaf.corner[corner][k] + i), along);
        }
        greatest = hn::Max(greatest, along);
      }
      hn::Store(greatest, d, front + i);
    }
  };
  set_front(a, frames.a, front_a);
  set_front(b, frames.b, front_b);
  const auto greatest = [](const float* x) { return std::max(std::max(x[0], x[1]), std::max(x[2], x[3])); };
  const double shift = frames.shift_along - static_cast<double>(slack);
  const auto gap = [shift](float of_a, float of_b) {
    return static_cast<float>(shift - static_cast<double>(of_a + of_b));
  };
  const float least_bound = gap(greatest(front_a), greatest(front_b));
  if (least_bound > best) return least_bound;
  for (std::size_t i = 0; i < k_leaf; ++i) {
    for (std::size_t j = 0; j < k_leaf; ++j) lower[k_leaf * i + j] = gap(front_a[i], front_b[j]);
  }
  return least_bound;
}

/// Writes the corners of all pairs; those of B are transformed to A's frame, N of f.
template <Rounding rounding>
HWY_INLINE void load_pairs(const Tree::Leaf& a, const Tree::Leaf& b, const Frame& f, LeafPair& pairs) {
  const hn::CappedTag<float, k_leaf> d;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < k_leaf; j += hn::Lanes(d)) {
        auto p = hn::Set(d, f.translation[k]);
        for (std::size_t m = 0; m < 3; ++m) {
          p = mul_add<rounding>(hn::Set(d, f.axis[m][k]), hn::Load(d, b.corner[corner][m] + j), p);
        }
        for (std::size_t i = 0; i < k_leaf; ++i) {
          hn::Store(p, d, pairs.b[corner][k] + k_leaf * i + j);
          hn::Store(hn::Set(d, a.corner[corner][k][i]), d, pairs.a[corner][k] + k_leaf * i + j);
        }
      }
    }
  }
}

/// n . (q - p) over the triangles of pairs i, i + 1, ...
struct Projections {
  V low, high;

  template <Rounding rounding>
  static HWY_INLINE Projections along(const V (&n)[3], const LeafPair& pairs, std::size_t i) {
    using frank_wolfe::Extreme;
    const auto most = [&](const auto& t) { return frank_wolfe::support<rounding, Extreme::greatest>(n, t, i).value; };
    const auto least = [&](const auto& t) { return frank_wolfe::support<rounding, Extreme::least>(n, t, i).value; };
    return {hn::Sub(least(pairs.b), most(pairs.a)), hn::Sub(most(pairs.b), least(pairs.a))};
  }
};

/// Frank-Wolfe steps from the difference of the centroids. Each iterate x is an axis.
/// @param bound is told of each: shift(x) may move it before it is used, keep(value, x) takes the least x . (q - p),
/// and is_enough() ends the steps
/// @param x set to the last iterate: a difference q - p of points of the triangles, but for shifts
template <Rounding rounding, int steps, class Bound>
HWY_INLINE void take_steps(const LeafPair& pairs, std::size_t i, Bound& bound, V (&x)[3]) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto sum = [&](const auto& t) {
      return hn::Add(hn::Add(load(t[0][k] + i), load(t[1][k] + i)), load(t[2][k] + i));
    };
    x[k] = hn::Mul(set(1.0f / 3.0f), hn::Sub(sum(pairs.b), sum(pairs.a)));
  }
  for (int step = 0;; ++step) {
    bound.shift(x);
    const auto p = frank_wolfe::support<rounding, frank_wolfe::Extreme::greatest>(x, pairs.a, i);
    const auto q = frank_wolfe::support<rounding, frank_wolfe::Extreme::least>(x, pairs.b, i);
    bound.keep(hn::Sub(q.value, p.value), x);
    if (step == steps || bound.is_enough()) return;
    const V s[3] = {hn::Sub(q.point[0], p.point[0]), hn::Sub(q.point[1], p.point[1]), hn::Sub(q.point[2], p.point[2])};
    frank_wolfe::step<rounding>(x, s);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::leaf_pairs
HWY_AFTER_NAMESPACE();

#endif  // guard per instruction set
