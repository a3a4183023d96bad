// Part of candidates.cpp, which includes it once per instruction set: it has no include guard.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/overlap_tests-inl.h>
#include <sixdof/oracle/tree_motion.h>
#include <sixdof/proximity/lanes-inl.h>

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
using lanes::HWY_NAMESPACE::k_leaf;
using lanes::HWY_NAMESPACE::k_pairs;
using lanes::HWY_NAMESPACE::unfused_mul_add;

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

/// The triangles of one leaf for the lanes of all pairs with another leaf's, in A's frame, relative to the centre of
/// A's tree. Missing triangles repeat the last.
/// @tparam of_a whether the leaf is A's
template <bool of_a>
struct alignas(64) PairSide {
  float corner[3][3][k_pairs];                 // [corner][axis]
  float normal[3][k_pairs];                    // (c1 - c0) x (c2 - c0)
  float low[k_pairs], high[k_pairs];           // range of normal . c of the corners c, with the rounding of both sides
  float lower[3][k_pairs], upper[3][k_pairs];  // of the box; B's is enlarged by the slack
  std::uint32_t first;                         // triangle, in tree order
  std::uint32_t count;

  HWY_NOINLINE void load(const Tree::Leaf& leaf, const TreeMotion& x) {
    first = leaf.child.first();
    count = leaf.child.count();
    for (std::size_t i = 0; i < k_leaf; i += hn::Lanes(k_leaf_lanes)) {
      LeafV p[3][3];
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t k = 0; k < 3; ++k) p[c][k] = hn::Load(k_leaf_lanes, leaf.corner[c][k] + i);
        if constexpr (!of_a) move_to_a(p[c], x);
        for (std::size_t k = 0; k < 3; ++k) write(p[c][k], corner[c][k], i);
      }
      const LeafV slack = hn::Set(k_leaf_lanes, of_a ? 0.0f : x.slack());
      LeafV u[3], v[3], size = hn::Zero(k_leaf_lanes), sum = size, along = size;
      for (std::size_t k = 0; k < 3; ++k) {
        u[k] = hn::Sub(p[1][k], p[0][k]);
        v[k] = hn::Sub(p[2][k], p[0][k]);
        size = hn::Add(size, hn::Add(hn::Abs(u[k]), hn::Abs(v[k])));
        write(hn::Sub(hn::Min(hn::Min(p[0][k], p[1][k]), p[2][k]), slack), lower[k], i);
        write(hn::Add(hn::Max(hn::Max(p[0][k], p[1][k]), p[2][k]), slack), upper[k], i);
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
        const LeafV n = hn::Sub(hn::Mul(u[l], v[m]), hn::Mul(u[m], v[l]));
        write(n, normal[k], i);
        along = unfused_mul_add(n, p[0][k], along);
        sum = hn::Add(sum, hn::Abs(n));
      }
      const LeafV tolerance = plane_tolerance(size, sum, x.slack(4.0f));
      write(hn::Sub(along, tolerance), low, i);
      write(hn::Add(along, tolerance), high, i);
    }
  }

 private:
  /// Whatever its own rounding, the normal n separates two triangles if their projections on it are apart. Corners are
  /// off by the slack along each axis, and scalar products with n are rounded by less than that. The triangle's own
  /// corners have the same projection but for the rounding of n, 2e-7 of the squared size, times an edge. Products that
  /// underflow are off by less than the smallest normal float.
  /// @param size sum of the absolute components of both edges from corner 0
  /// @param sum of the absolute components of n
  static HWY_INLINE LeafV plane_tolerance(LeafV size, LeafV sum, float slack) {
    const auto set = [](float x) { return hn::Set(k_leaf_lanes, x); };
    const LeafV rounding = hn::Mul(hn::Mul(set(1e-6f), size), hn::Mul(size, size));
    return hn::Add(unfused_mul_add(sum, set(slack), rounding), set(std::numeric_limits<float>::min()));
  }

  static HWY_INLINE void move_to_a(LeafV (&p)[3], const TreeMotion& x) {
    const LeafV q[3] = {p[0], p[1], p[2]};
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = hn::Set(k_leaf_lanes, x.start[k]);
      for (std::size_t j = 0; j < 3; ++j) {
        p[k] = unfused_mul_add(hn::Set(k_leaf_lanes, x.frames.a.axis[j][k]), q[j], p[k]);
      }
    }
  }

  /// Writes values of triangles i, i + 1, ... to the lanes of their pairs.
  static HWY_INLINE void write(LeafV x, float* to, std::size_t i) {
#if HWY_TARGET == HWY_SCALAR
    for (std::size_t other = 0; other < k_leaf; ++other) {
      hn::Store(x, k_leaf_lanes, to + (of_a ? k_leaf * i + other : k_leaf * other + i));
    }
#else
    (void)i;
    hn::Store(of_a ? hn::Broadcast<0>(x) : x, k_leaf_lanes, to);
    hn::Store(of_a ? hn::Broadcast<1>(x) : x, k_leaf_lanes, to + k_leaf);
    hn::Store(of_a ? hn::Broadcast<2>(x) : x, k_leaf_lanes, to + 2 * k_leaf);
    hn::Store(of_a ? hn::Broadcast<3>(x) : x, k_leaf_lanes, to + 3 * k_leaf);
#endif
  }
};
using SideA = PairSide<true>;
using SideB = PairSide<false>;

/// A cache of leaves of one tree, filled on demand. Leaves of the same node do not evict each other.
template <bool of_a>
class LeafCache {
 public:
  explicit LeafCache(const Tree& tree) : leaves_(tree.leaves().data()) { std::fill_n(index_, k_slots, ~0u); }

  HWY_INLINE const PairSide<of_a>& get(std::uint32_t leaf, const TreeMotion& motion) {
    const std::size_t slot = leaf % k_slots;
    if (index_[slot] != leaf) {
      index_[slot] = leaf;
      sides_[slot].load(leaves_[leaf], motion);
    }
    return sides_[slot];
  }

 private:
  static constexpr std::size_t k_slots = Tree::k_width;
  const Tree::Leaf* leaves_;
  std::uint32_t index_[k_slots];
  PairSide<of_a> sides_[k_slots];
};

HWY_INLINE V load(const float* p) { return hn::Load(k_lanes, p); }

/// Corners for the lanes i, i + 1, ... of the pairs.
struct PairLanes {
  V corner_a[3][3], corner_b[3][3];  // [corner][axis]

  HWY_INLINE PairLanes(const SideA& a, const SideB& b, std::size_t i) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        corner_a[c][k] = load(a.corner[c][k] + i);
        corner_b[c][k] = load(b.corner[c][k] + i);
      }
    }
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
    tolerance = unfused_mul_add(sum, set(x.slack(8.0f)), set(std::numeric_limits<float>::min()));
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
HWY_INLINE std::uint32_t test_triangles(const SideA& a, const SideB& b, const TreeMotion& x, float* first,
                                        float* last) {
  const detail::Passage& passage = x.of_b;
  const V displacement[3] = {set(passage.in_x[0]), set(passage.in_x[1]), set(passage.in_x[2])};
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_pairs; i += hn::Lanes(k_lanes)) {
    Overlaps<moving> overlaps(0.0f);
    for (std::size_t k = 0; k < 3; ++k) {  // B's boxes include the slack
      overlaps.axis(load(a.lower[k] + i), load(a.upper[k] + i), load(b.lower[k] + i), load(b.upper[k] + i),
                    Rate(passage.along_x[k]));
    }
    if (hn::AllFalse(k_lanes, overlaps.store(first + i, last + i))) continue;
    const PairLanes p(a, b, i);
    const V normal_a[3] = {load(a.normal[0] + i), load(a.normal[1] + i), load(a.normal[2] + i)};
    const V normal_b[3] = {load(b.normal[0] + i), load(b.normal[1] + i), load(b.normal[2] + i)};
    const Projection on_a(normal_a, p.corner_b), on_b(normal_b, p.corner_a);
    overlaps.axis(load(a.low + i), load(a.high + i), on_a.low, on_a.high, rate_of(dot(normal_a, displacement)));
    overlaps.axis(on_b.low, on_b.high, load(b.low + i), load(b.high + i), rate_of(dot(normal_b, displacement)));
    bits |= bits_of(overlaps.store(first + i, last + i), i);
  }
  return bits;
}

/// Of the pairs of triangles in `bits`, those (as bits) that no cross product of two edges separates; narrows the
/// fractions. With the tests before, by both planes, they intersect but for rounding.
template <bool moving>
HWY_NOINLINE std::uint32_t test_across_edges(const SideA& a, const SideB& b, std::uint32_t bits, const TreeMotion& x,
                                             float* first, float* last) {
  std::uint32_t overlapping = 0;
  for (std::size_t i = 0; i < k_pairs; i += hn::Lanes(k_lanes)) {
    const PairLanes p(a, b, i);
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

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::triangle_pairs
HWY_AFTER_NAMESPACE();
