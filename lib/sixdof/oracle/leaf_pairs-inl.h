// Part of distance_bounds-inl.h and of generation/ray_cast_bounds-inl.h: the pairs of triangles of two leaves. Taken
// once per instruction set: the guard is Highway's for that.
#if defined(SIXDOF_ORACLE_LEAF_PAIRS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_ORACLE_LEAF_PAIRS_INL_H_
#undef SIXDOF_ORACLE_LEAF_PAIRS_INL_H_
#else
#define SIXDOF_ORACLE_LEAF_PAIRS_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/frames.h>
#include <sixdof/oracle/lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::leaf_pairs {
namespace HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using detail::Frame;
using detail::Frames;

constexpr std::uint32_t k_leaf = Tree::k_leaf_triangles;

/// All pairs of triangles of two leaves, in A's frame relative to its centre. Lane 4 i + j holds pair (i, j).
struct LeafPair {
  static constexpr std::size_t k_pairs = k_leaf * k_leaf;
  HWY_ALIGN float a[3][3][k_pairs];  // [corner][axis][pair]
  HWY_ALIGN float b[3][3][k_pairs];
  HWY_ALIGN float lower[k_pairs];  // bounds on the distance
  HWY_ALIGN float upper[k_pairs];  // but for rounding; set for pairs whose lower bound is not above the best
};

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

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::leaf_pairs
HWY_AFTER_NAMESPACE();

#endif  // guard per instruction set
