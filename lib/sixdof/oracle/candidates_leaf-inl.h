// Compiled once per instruction set: part of candidates.cpp and swept_candidates.cpp, included by nothing else.
#if defined(SIXDOF_ORACLE_CANDIDATES_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_ORACLE_CANDIDATES_LEAF_INL_H_
#undef SIXDOF_ORACLE_CANDIDATES_LEAF_INL_H_
#else
#define SIXDOF_ORACLE_CANDIDATES_LEAF_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <hwy/highway.h>

#include <sixdof/geometry/tree.h>
#include <sixdof/geometry/triangle_pair.h>
#include <sixdof/oracle/candidates_bounds-inl.h>

// The triangles of leaves, one per SIMD lane, and the 4 x 4 pairs of triangles of two leaves, one pair per lane: lane
// 4 i + j is that of triangle i of A's leaf and triangle j of B's.

HWY_BEFORE_NAMESPACE();
namespace sixdof::candidates {
namespace HWY_NAMESPACE {

using LeafLanesTag = hn::CappedTag<float, Tree::k_leaf_triangles>;
using LeafV = hn::Vec<LeafLanesTag>;

constexpr LeafLanesTag k_leaf_lanes;
constexpr std::size_t k_leaf = Tree::k_leaf_triangles;
constexpr std::size_t k_pairs = k_leaf * k_leaf;

/// A leaf's triangles in A's frame, relative to the centre of A's tree. Missing triangles repeat the last.
struct alignas(64) LeafLanes {
  float corner[3][3][k_leaf];  // [corner][axis]
  float normal[3][k_leaf];     // (c1 - c0) x (c2 - c0)
  float lower[3][k_leaf], upper[3][k_leaf];
  float size[k_leaf];  // sum of the absolute components of both edges from corner 0
};

/// Fills everything but the corners, from the corners. Boxes are enlarged by `slack`.
HWY_INLINE void compute_from_corners(LeafLanes& leaf, float slack) {
  for (std::size_t i = 0; i < k_leaf; i += hn::Lanes(k_leaf_lanes)) {
    LeafV corner[3][3], u[3], v[3];
    LeafV size = hn::Zero(k_leaf_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 3; ++c) corner[c][k] = hn::Load(k_leaf_lanes, leaf.corner[c][k] + i);
      u[k] = hn::Sub(corner[1][k], corner[0][k]);
      v[k] = hn::Sub(corner[2][k], corner[0][k]);
      size = hn::Add(size, hn::Add(hn::Abs(u[k]), hn::Abs(v[k])));
      const LeafV lower = hn::Min(hn::Min(corner[0][k], corner[1][k]), corner[2][k]);
      const LeafV upper = hn::Max(hn::Max(corner[0][k], corner[1][k]), corner[2][k]);
      hn::Store(hn::Sub(lower, hn::Set(k_leaf_lanes, slack)), k_leaf_lanes, leaf.lower[k] + i);
      hn::Store(hn::Add(upper, hn::Set(k_leaf_lanes, slack)), k_leaf_lanes, leaf.upper[k] + i);
    }
    hn::Store(size, k_leaf_lanes, leaf.size + i);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
      hn::Store(hn::Sub(hn::Mul(u[l], v[m]), hn::Mul(u[m], v[l])), k_leaf_lanes, leaf.normal[k] + i);
    }
  }
}

HWY_INLINE void load_leaf_of_b(const Tree::Leaf& from, const TreeMotion& x, LeafLanes& out) {
  for (std::size_t i = 0; i < k_leaf; i += hn::Lanes(k_leaf_lanes)) {
    for (std::size_t c = 0; c < 3; ++c) {
      LeafV p[3];
      for (std::size_t k = 0; k < 3; ++k) p[k] = hn::Load(k_leaf_lanes, from.corner[c][k] + i);
      for (std::size_t k = 0; k < 3; ++k) {
        LeafV q = hn::Set(k_leaf_lanes, x.shift[k]);
        for (std::size_t j = 0; j < 3; ++j) q = unfused_mul_add(hn::Set(k_leaf_lanes, x.rotation[k][j]), p[j], q);
        hn::Store(q, k_leaf_lanes, out.corner[c][k] + i);
      }
    }
  }
  compute_from_corners(out, x.slack);
}

HWY_INLINE void load_leaf_of_a(const Tree::Leaf& from, LeafLanes& out) {
  std::memcpy(out.corner, from.corner, sizeof(out.corner));
  compute_from_corners(out, 0.0f);
}

/// Children of A (bits) whose boxes overlap a leaf of B at some fraction of the displacement.
HWY_INLINE std::uint32_t overlapping_boxes(const Tree::Node& node_a, const LeafLanes& b, const TreeMotion& x) {
  float lower[3], upper[3];
  for (std::size_t k = 0; k < 3; ++k) {
    lower[k] = *std::min_element(b.lower[k], b.lower[k] + k_leaf);
    upper[k] = *std::max_element(b.upper[k], b.upper[k] + k_leaf);
  }
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    FractionInterval interval{hn::Zero(k_lanes), hn::Set(k_lanes, 1.0f)};
    for (std::size_t k = 0; k < 3; ++k) {
      interval.narrow_to_boxes(hn::Load(k_lanes, node_a.lower[k] + i), hn::Load(k_lanes, node_a.upper[k] + i),
                               hn::Set(k_lanes, lower[k]), hn::Set(k_lanes, upper[k]), k, x);
    }
    const V last = hn::Add(interval.last, hn::Set(k_lanes, 2.0f * k_fraction_rounding));
    bits |= bits_of(hn::Le(interval.first, last), i);
  }
  return bits;
}

/// Values of A's and of B's triangles for the lanes i, i + 1, ... of the pairs.
HWY_INLINE V load_of_a(const float* p, std::size_t i) {
#if HWY_TARGET == HWY_SCALAR
  return hn::Set(k_lanes, p[i / k_leaf]);
#else
  if constexpr (hn::MaxLanes(k_lanes) <= k_leaf) {
    return hn::Set(k_lanes, p[i / k_leaf]);
  } else {
    const hn::Half<Lanes> half;
    return hn::Combine(k_lanes, hn::Set(half, p[i / k_leaf + 1]), hn::Set(half, p[i / k_leaf]));
  }
#endif
}
HWY_INLINE V load_of_b(const float* p, std::size_t i) {
#if HWY_TARGET == HWY_SCALAR
  return hn::Load(k_lanes, p + i % k_leaf);
#else
  (void)i;
  return hn::LoadDup128(k_lanes, p);
#endif
}

/// Corners and normals for the lanes i, i + 1, ... of the pairs, and the tolerances of their plane distances.
struct PairLanes {
  V corner_a[3][3], corner_b[3][3];  // [corner][axis]
  V normal_a[3], normal_b[3];
  V tolerance_a, tolerance_b;

  /// Tolerances: errors of normal . (corner of the other triangle - corner 0), wherever the boxes overlap. A normal is
  /// a sum of products of edges (size E) whose coordinates are off by twice the slack s: 8 s E. A corner of the other
  /// triangle (size E') is at most E + E' + 6 s away, off by 2 s: together below 16 s E (2 E + E' + 6 s), which
  /// includes the rounding of the products.
  HWY_INLINE PairLanes(const LeafLanes& a, const LeafLanes& b, std::size_t i, float slack) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        corner_a[c][k] = load_of_a(a.corner[c][k], i);
        corner_b[c][k] = load_of_b(b.corner[c][k], i);
      }
      normal_a[k] = load_of_a(a.normal[k], i);
      normal_b[k] = load_of_b(b.normal[k], i);
    }
    const V size_a = load_of_a(a.size, i), size_b = load_of_b(b.size, i);
    const V s = hn::Set(k_lanes, 16.0f * slack);
    const V both = hn::Add(hn::Add(size_a, size_b), hn::Set(k_lanes, 6.0f * slack));
    tolerance_a = hn::Mul(hn::Mul(s, size_a), hn::Add(both, size_a));
    tolerance_b = hn::Mul(hn::Mul(s, size_b), hn::Add(both, size_b));
  }
};

/// Range of normal . (p - origin) over three corners p.
struct PlaneRange {
  V low, high;

  HWY_INLINE PlaneRange(const V (&normal)[3], const V (&origin)[3], const V (&corner)[3][3]) {
    V distance[3];
    for (std::size_t c = 0; c < 3; ++c) {
      distance[c] = hn::Mul(normal[0], hn::Sub(corner[c][0], origin[0]));
      distance[c] = unfused_mul_add(normal[1], hn::Sub(corner[c][1], origin[1]), distance[c]);
      distance[c] = unfused_mul_add(normal[2], hn::Sub(corner[c][2], origin[2]), distance[c]);
    }
    low = hn::Min(hn::Min(distance[0], distance[1]), distance[2]);
    high = hn::Max(hn::Max(distance[0], distance[1]), distance[2]);
  }
};

/// Calls take(lane, pair) for the pairs of triangles whose bits are set, but for lanes without a triangle.
template <class Take>
HWY_INLINE void for_each_pair(std::uint32_t bits, Tree::Child leaf_a, Tree::Child leaf_b, const Take& take) {
  for (; bits != 0; bits &= bits - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
    const std::uint32_t t = lane / k_leaf, u = lane % k_leaf;
    if (t < leaf_a.count() && u < leaf_b.count()) take(lane, TrianglePair{leaf_a.first() + t, leaf_b.first() + u});
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::candidates
HWY_AFTER_NAMESPACE();

#endif
