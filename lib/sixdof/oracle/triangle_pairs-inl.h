// Part of candidates.cpp, which includes it once per instruction set: it has no include guard.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include <hwy/highway.h>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/lanes-inl.h>
#include <sixdof/oracle/overlap_tests-inl.h>
#include <sixdof/oracle/tree_motion.h>

// Separating-axis tests of the 4 x 4 pairs of triangles of two leaves, one pair per lane: lane 4 i + j is that of
// triangle i of A's leaf and triangle j of B's. Boxes, both planes and, where they pay, the nine directions across two
// edges.
//
// Coordinates are floats relative to the centre of A's tree. A test never separates triangles that intersect. No
// multiplication is fused and nothing is summed across lanes, so every instruction set finds the same pairs.

HWY_BEFORE_NAMESPACE();
namespace sixdof::triangle_pairs {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using detail::TreeMotion;
using lanes::HWY_NAMESPACE::unfused_mul_add;

constexpr std::size_t k_leaf = Tree::k_leaf_triangles;
constexpr std::size_t k_pairs = k_leaf * k_leaf;

/// All pairs of two leaves. Where a vector holds fewer lanes, loops take several.
using Lanes = hn::CappedTag<float, k_pairs>;
using V = hn::Vec<Lanes>;
using M = hn::Mask<Lanes>;
constexpr Lanes k_lanes;

HWY_INLINE V set(float x) { return hn::Set(k_lanes, x); }

/// x . y, unfused.
HWY_INLINE V dot(const V (&x)[3], const V (&y)[3]) {
  return unfused_mul_add(x[2], y[2], unfused_mul_add(x[1], y[1], hn::Mul(x[0], y[0])));
}

/// The bits of the lanes of `mask`, from bit `i` on.
HWY_INLINE std::uint32_t bits_of(M mask, std::size_t i) {
  HWY_ALIGN std::uint8_t stored[8] = {};  // as many as StoreMaskBits may write
  hn::StoreMaskBits(k_lanes, mask, stored);
  return (stored[0] | static_cast<std::uint32_t>(stored[1]) << 8) << i;
}

using LeafLanesTag = hn::CappedTag<float, Tree::k_leaf_triangles>;
using LeafV = hn::Vec<LeafLanesTag>;

constexpr LeafLanesTag k_leaf_lanes;

/// A leaf's triangles in A's frame, relative to the centre of A's tree. Missing triangles repeat the last.
struct alignas(64) LeafLanes {
  float corner[3][3][k_leaf];  // [corner][axis]
  float normal[3][k_leaf];     // (c1 - c0) x (c2 - c0)
  float offset[k_leaf];        // normal . c0
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
    LeafV offset = hn::Zero(k_leaf_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
      const LeafV normal = hn::Sub(hn::Mul(u[l], v[m]), hn::Mul(u[m], v[l]));
      hn::Store(normal, k_leaf_lanes, leaf.normal[k] + i);
      offset = unfused_mul_add(normal, corner[0][k], offset);
    }
    hn::Store(offset, k_leaf_lanes, leaf.offset + i);
  }
}

HWY_INLINE void load_leaf_of_b(const Tree::Leaf& from, const TreeMotion& x, LeafLanes& out) {
  for (std::size_t i = 0; i < k_leaf; i += hn::Lanes(k_leaf_lanes)) {
    for (std::size_t c = 0; c < 3; ++c) {
      LeafV p[3];
      for (std::size_t k = 0; k < 3; ++k) p[k] = hn::Load(k_leaf_lanes, from.corner[c][k] + i);
      for (std::size_t k = 0; k < 3; ++k) {
        LeafV q = hn::Set(k_leaf_lanes, x.start[k]);
        for (std::size_t j = 0; j < 3; ++j) q = unfused_mul_add(hn::Set(k_leaf_lanes, x.frames.a.axis[j][k]), p[j], q);
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

/// The lanes of leaves, made when they are asked for and kept for a while: the leaves of one node do not displace each
/// other.
class LeafCache {
 public:
  explicit LeafCache(const Tree& tree) : tree_(tree) { std::fill_n(index_, k_slots, ~0u); }

  template <class Load>
  HWY_INLINE const LeafLanes& get(std::uint32_t leaf, const Load& load_leaf) {
    const std::size_t slot = leaf % k_slots;
    if (index_[slot] != leaf) {
      load_leaf(tree_.leaves()[leaf], lanes_[slot]);
      index_[slot] = leaf;
    }
    return lanes_[slot];
  }

 private:
  static constexpr std::size_t k_slots = Tree::k_width;
  const Tree& tree_;
  std::uint32_t index_[k_slots];
  LeafLanes lanes_[k_slots];
};

/// Values of A's and of B's triangles for the lanes i, i + 1, ... of the pairs.
HWY_INLINE V load_of_a(const float* p, std::size_t i) {
#if HWY_TARGET == HWY_SCALAR
  return set(p[i / k_leaf]);
#else
  if constexpr (hn::MaxLanes(k_lanes) <= k_leaf) {
    return set(p[i / k_leaf]);
  } else {
    // Each block of 128 bits repeats one of the four values.
    alignas(64) static constexpr std::uint8_t k_bytes[4 * k_pairs] = {
        0, 1, 2,  3,  0,  1,  2,  3,  0,  1,  2,  3,  0,  1,  2,  3,  4,  5,  6,  7, 4,  5,
        6, 7, 4,  5,  6,  7,  4,  5,  6,  7,  8,  9,  10, 11, 8,  9,  10, 11, 8,  9, 10, 11,
        8, 9, 10, 11, 12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15};
    const hn::Repartition<std::uint8_t, Lanes> bytes;
    const auto four = hn::BitCast(bytes, hn::LoadDup128(k_lanes, p));
    return hn::BitCast(k_lanes, hn::TableLookupBytes(four, hn::Load(bytes, k_bytes + 4 * i)));
  }
#endif
}
HWY_INLINE V load_of_b(const float* p, std::size_t i) {
#if HWY_TARGET == HWY_SCALAR
  return set(p[i % k_leaf]);
#else
  (void)i;
  return hn::LoadDup128(k_lanes, p);
#endif
}

/// Corners and normals for the lanes i, i + 1, ... of the pairs, and the tolerances of their plane distances.
struct PairLanes {
  V corner_a[3][3], corner_b[3][3];  // [corner][axis]
  V normal_a[3], normal_b[3];
  V offset_a, offset_b;
  V tolerance_a, tolerance_b;

  /// Tolerances: errors of normal . (corner of the other triangle) - offset, wherever the boxes overlap. A normal is
  /// a sum of products of edges (size E) whose coordinates are off by twice the slack s: 8 s E. A corner of the other
  /// triangle (size E') is at most E + E' + 6 s away, off by 2 s: together below 16 s E (2 E + E' + 6 s), which
  /// includes the rounding of the products with the normal, below s E^2.
  HWY_INLINE PairLanes(const LeafLanes& a, const LeafLanes& b, std::size_t i, float slack) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        corner_a[c][k] = load_of_a(a.corner[c][k], i);
        corner_b[c][k] = load_of_b(b.corner[c][k], i);
      }
      normal_a[k] = load_of_a(a.normal[k], i);
      normal_b[k] = load_of_b(b.normal[k], i);
    }
    offset_a = load_of_a(a.offset, i);
    offset_b = load_of_b(b.offset, i);
    const V size_a = load_of_a(a.size, i), size_b = load_of_b(b.size, i);
    const V s = set(16.0f * slack);
    const V both = hn::Add(hn::Add(size_a, size_b), set(6.0f * slack));
    tolerance_a = hn::Mul(hn::Mul(s, size_a), hn::Add(both, size_a));
    tolerance_b = hn::Mul(hn::Mul(s, size_b), hn::Add(both, size_b));
  }

  /// Adds the rounding of the products of normals, of up to the square of a size, with differences as long as the
  /// displacement.
  HWY_INLINE void widen(V size_a, V size_b, const V (&displacement)[3]) {
    V rounding = hn::Zero(k_lanes);
    for (const V d : displacement) rounding = hn::Add(rounding, hn::Mul(set(1e-6f), hn::Abs(d)));
    tolerance_a = unfused_mul_add(rounding, hn::Mul(size_a, size_a), tolerance_a);
    tolerance_b = unfused_mul_add(rounding, hn::Mul(size_b, size_b), tolerance_b);
  }
};

/// Range of normal . p over three corners p.
struct Projection {
  V low, high;

  HWY_INLINE Projection(const V (&normal)[3], const V (&corner)[3][3]) {
    const V x = dot(normal, corner[0]), y = dot(normal, corner[1]), z = dot(normal, corner[2]);
    low = hn::Min(hn::Min(x, y), z);
    high = hn::Max(hn::Max(x, y), z);
  }
};

/// Projections of both triangles of a pair on one of the nine directions across an edge of each, and their rounding.
struct EdgeAxis {
  V low_a, high_a, low_b, high_b;
  V speed;  // of B's, per fraction of the displacement
  V tolerance;

  /// Whatever its own rounding, the direction n separates the triangles if their projections on it are apart: corners
  /// are off by the slack along each axis, and the rounding of a scalar product and of the way along the displacement
  /// is less than that. Products that underflow are off by less than the smallest normal float.
  HWY_INLINE EdgeAxis(const PairLanes& p, std::size_t edge, const TreeMotion& x) {
    const auto& a = p.corner_a;
    const auto& b = p.corner_b;
    const std::size_t i = edge % 3, j = edge / 3;
    V u[3], v[3], n[3];
    for (std::size_t k = 0; k < 3; ++k) {
      u[k] = hn::Sub(a[(i + 1) % 3][k], a[i][k]);
      v[k] = hn::Sub(b[(j + 1) % 3][k], b[j][k]);
    }
    V sum = hn::Zero(k_lanes);
    speed = hn::Zero(k_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
      n[k] = hn::Sub(hn::Mul(u[l], v[m]), hn::Mul(u[m], v[l]));
      sum = hn::Add(sum, hn::Abs(n[k]));
      speed = unfused_mul_add(n[k], set(x.of_b.in_x[k]), speed);
    }
    tolerance = unfused_mul_add(sum, set(8.0f * x.slack), set(std::numeric_limits<float>::min()));
    const Projection of_a(n, a), of_b(n, b);
    low_a = of_a.low;
    high_a = of_a.high;
    low_b = of_b.low;
    high_b = of_b.high;
  }
};

using Rate = overlap_tests::HWY_NAMESPACE::Rate<Lanes>;
template <bool moving>
using Overlaps = overlap_tests::HWY_NAMESPACE::Overlaps<Lanes, moving>;

/// Ranges along axes of any length. Where rounding loses their motion, they do not separate.
HWY_INLINE Rate rate_of(V rate) { return Rate::of(rate, 1e-30f, Tree::k_empty); }

/// Pairs of triangles (bits) that may intersect: by their boxes, and by both planes.
/// @param first, last if moving: the fractions between which they may, of all pairs
template <bool moving>
HWY_INLINE std::uint32_t test_triangles(const LeafLanes& a, const LeafLanes& b, const TreeMotion& x, float* first,
                                        float* last) {
  const detail::Passage& passage = x.of_b;
  const V displacement[3] = {set(passage.in_x[0]), set(passage.in_x[1]), set(passage.in_x[2])};
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_pairs; i += hn::Lanes(k_lanes)) {
    Overlaps<moving> overlaps(0.0f);
    for (std::size_t k = 0; k < 3; ++k) {  // B's boxes include the slack
      overlaps.axis(load_of_a(a.lower[k], i), load_of_a(a.upper[k], i), load_of_b(b.lower[k], i),
                    load_of_b(b.upper[k], i), Rate(passage.along_x[k]));
    }
    if (hn::AllFalse(k_lanes, overlaps.store(first + i, last + i))) continue;
    PairLanes p(a, b, i, x.slack);
    if constexpr (moving) p.widen(load_of_a(a.size, i), load_of_b(b.size, i), displacement);
    const Projection on_a(p.normal_a, p.corner_b), on_b(p.normal_b, p.corner_a);
    overlaps.axis(hn::Sub(p.offset_a, p.tolerance_a), hn::Add(p.offset_a, p.tolerance_a), on_a.low, on_a.high,
                  rate_of(dot(p.normal_a, displacement)));
    overlaps.axis(on_b.low, on_b.high, hn::Sub(p.offset_b, p.tolerance_b), hn::Add(p.offset_b, p.tolerance_b),
                  rate_of(dot(p.normal_b, displacement)));
    bits |= bits_of(overlaps.store(first + i, last + i), i);
  }
  return bits;
}

/// Pairs of triangles (bits), of those in `bits`, that no axis across an edge of each separates; narrows the fractions.
/// With the tests before, by both planes, they intersect but for rounding.
template <bool moving>
HWY_NOINLINE std::uint32_t test_across_edges(const LeafLanes& a, const LeafLanes& b, std::uint32_t bits,
                                             const TreeMotion& x, float* first, float* last) {
  std::uint32_t overlapping = 0;
  for (std::size_t i = 0; i < k_pairs; i += hn::Lanes(k_lanes)) {
    const PairLanes p(a, b, i, x.slack);
    Overlaps<moving> overlaps(0.0f);
    overlaps.take(first + i, last + i);
    for (std::size_t edge = 0; edge < 9; ++edge) {
      const EdgeAxis axis(p, edge, x);
      overlaps.axis(hn::Sub(axis.low_a, axis.tolerance), hn::Add(axis.high_a, axis.tolerance), axis.low_b, axis.high_b,
                    rate_of(axis.speed));
    }
    overlapping |= bits_of(overlaps.store(first + i, last + i), i);
  }
  return bits & overlapping;
}

/// Calls take(pair, lane) for the pairs of triangles whose bits are set, but for lanes without a triangle.
template <class Take>
HWY_INLINE void for_each_pair(std::uint32_t bits, Tree::Child leaf_a, Tree::Child leaf_b, const Take& take) {
  for (; bits != 0; bits &= bits - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
    const std::uint32_t t = lane / k_leaf, u = lane % k_leaf;
    if (t < leaf_a.count() && u < leaf_b.count()) take(TrianglePair{leaf_a.first() + t, leaf_b.first() + u}, lane);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::triangle_pairs
HWY_AFTER_NAMESPACE();
