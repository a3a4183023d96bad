// Compiled once per instruction set: part of candidates.cpp and swept_candidates.cpp, included by nothing else.
#if defined(SIXDOF_ORACLE_CANDIDATES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_ORACLE_CANDIDATES_INL_H_
#undef SIXDOF_ORACLE_CANDIDATES_INL_H_
#else
#define SIXDOF_ORACLE_CANDIDATES_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <Eigen/Core>

#include <hwy/highway.h>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/candidates.h>

// Pairs of nodes are descended depth first. Of each pair of nodes, all 8 x 8 pairs of children are tested at once, one
// child of A per SIMD lane, by boxes in both frames and by both slabs. Pairs of leaves go on to a test of their 4 x 4
// pairs of triangles, one pair per lane.
//
// B may move along a straight way meanwhile: its volumes are then grown to hold all places.
//
// Everything is in floats relative to the centre of A's tree, with room for rounding: a test may only say that two
// things are apart. Nothing is fused or summed across lanes, so every instruction set lets the same pairs through. The
// order of pairs is that of the trees, whatever is let through.

HWY_BEFORE_NAMESPACE();
namespace sixdof::candidates {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, Tree::k_width>;
using LeafLanesTag = hn::CappedTag<float, Tree::k_leaf_triangles>;
using V = hn::Vec<Lanes>;
using LeafV = hn::Vec<LeafLanesTag>;
using M = hn::Mask<Lanes>;

constexpr Lanes k_lanes;
constexpr LeafLanesTag k_leaf_lanes;
constexpr std::size_t k_width = Tree::k_width;
constexpr std::size_t k_leaf = Tree::k_leaf_triangles;
constexpr std::size_t k_pairs = k_leaf * k_leaf;

/// Not fused: the same bits on every instruction set. For leaves' lanes, too.
template <class Vec>
HWY_INLINE Vec mul_add(Vec x, Vec y, Vec z) {
  return hn::Add(hn::Mul(x, y), z);
}

/// No lane.
HWY_INLINE M none() { return hn::Lt(hn::Zero(k_lanes), hn::Zero(k_lanes)); }

/// X_AB as seen by the trees, while B moves: p_A - center_A = rotation (p_B - center_B) + shift + x way, x in 0 .. 1.
struct Placement {
  float rotation[3][3];
  float shift[3];
  float way[3];
  float slack;          ///< Largest error of a placed coordinate.
  float middle[3];      ///< shift + way / 2
  float half_way[3];    ///< Half of the way.
  float reach_in_a[3];  ///< How far volumes reach beyond their place at the middle: half of the way.
  float reach_in_b[3];  ///< The same along B's axes.
  float per_way[3];     ///< Shares of the way per length along each axis of A.
  float room[3];  ///< Lengths added along axes on which B hardly moves, where the shares are of the slack instead.

  Placement(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& way_A) {
    const Eigen::Vector3d d = X_AB.R * b.center() + X_AB.t - a.center();
    // A coordinate is the sum of seven products and sums of lengths of this size, each rounded by 6e-8.
    constexpr double k_float_rounding = 6e-7;
    // Rounding of the doubles themselves where the bodies are far from their origins.
    constexpr double k_double_rounding = 1e-14;
    const double size = a.radius() + b.radius() + d.lpNorm<Eigen::Infinity>() + way_A.lpNorm<Eigen::Infinity>();
    slack =
        static_cast<float>(k_float_rounding * size +
                           k_double_rounding * (X_AB.t.lpNorm<1>() + b.center().lpNorm<1>() + a.center().lpNorm<1>()));
    const Eigen::Vector3d way_B = X_AB.R.transpose() * way_A;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) rotation[i][k] = static_cast<float>(X_AB.R(i, k));
      shift[i] = static_cast<float>(d[i]);
      way[i] = static_cast<float>(way_A[i]);
      half_way[i] = 0.5f * way[i];
      middle[i] = static_cast<float>(d[i] + 0.5 * way_A[i]);
      reach_in_a[i] = std::abs(half_way[i]);
      reach_in_b[i] = static_cast<float>(0.5 * std::abs(way_B[i]));
      const bool moves = std::abs(way[i]) > slack;
      per_way[i] = 1.0f / (moves ? way[i] : slack);
      room[i] = moves ? 0.0f : slack;
    }
  }
};

/// Volumes of a node's children in their own frame and seen from the other's: boxes as centre and half extents.
struct alignas(64) Children {
  float center[3][k_width], half[3][k_width];              // own frame
  float other_center[3][k_width], other_half[3][k_width];  // box around it in the other frame on the whole way
  float still_half[3][k_width];                            // the same without the way; half extents have the slack
  float normal[3][k_width];                                // in the other frame
  float slab_lower[k_width], slab_upper[k_width];          // along the normals, from the centre of A's tree, with slack
};

/// @param to_a true for children of B (the other frame is A's), false for those of A.
template <bool to_a>
HWY_INLINE void see(const Tree::Node& node, const Placement& x, Children& out) {
  const V half = hn::Set(k_lanes, 0.5f);
  const V slack = hn::Set(k_lanes, x.slack);
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    V c[3], h[3], n[3], from[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const V lower = hn::Load(k_lanes, node.lower[k] + i), upper = hn::Load(k_lanes, node.upper[k] + i);
      c[k] = hn::Mul(half, hn::Add(lower, upper));
      h[k] = hn::Mul(half, hn::Sub(upper, lower));
      n[k] = hn::Load(k_lanes, node.normal[k] + i);
      hn::Store(c[k], k_lanes, out.center[k] + i);
      hn::Store(h[k], k_lanes, out.half[k] + i);
      from[k] = to_a ? c[k] : hn::Sub(c[k], hn::Set(k_lanes, x.middle[k]));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      V center = to_a ? hn::Set(k_lanes, x.middle[k]) : hn::Zero(k_lanes);
      V extent = slack;
      V normal = hn::Zero(k_lanes);
      for (std::size_t j = 0; j < 3; ++j) {
        const V r = hn::Set(k_lanes, to_a ? x.rotation[k][j] : x.rotation[j][k]);
        center = mul_add(r, from[j], center);
        extent = mul_add(hn::Abs(r), h[j], extent);
        normal = mul_add(r, n[j], normal);
      }
      hn::Store(center, k_lanes, out.other_center[k] + i);
      hn::Store(extent, k_lanes, out.still_half[k] + i);
      const V grown = hn::Add(extent, hn::Set(k_lanes, to_a ? x.reach_in_a[k] : x.reach_in_b[k]));
      hn::Store(grown, k_lanes, out.other_half[k] + i);
      hn::Store(normal, k_lanes, out.normal[k] + i);
    }
    // Three products of a normal with coordinates that are off by the slack, and half of the way along the normal.
    V along_way = hn::Zero(k_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      const V normal = to_a ? hn::Load(k_lanes, out.normal[k] + i) : n[k];
      along_way = mul_add(normal, hn::Set(k_lanes, x.half_way[k]), along_way);
    }
    const V slab_slack = mul_add(hn::Set(k_lanes, 3.0f), slack, hn::Abs(along_way));
    V lower = hn::Sub(hn::Load(k_lanes, node.slab_lower + i), slab_slack);
    V upper = hn::Add(hn::Load(k_lanes, node.slab_upper + i), slab_slack);
    if (to_a) {
      for (std::size_t k = 0; k < 3; ++k) {
        const V along = hn::Mul(hn::Load(k_lanes, out.normal[k] + i), hn::Set(k_lanes, x.middle[k]));
        lower = hn::Add(lower, along);
        upper = hn::Add(upper, along);
      }
    }
    hn::Store(lower, k_lanes, out.slab_lower + i);
    hn::Store(upper, k_lanes, out.slab_upper + i);
  }
}

/// Children of A (bits) whose boxes B's moving box j passes by: apart across the way, along the three axes that are
/// perpendicular to it and to an axis of A.
HWY_INLINE M passed_by(const Children& a, const Children& b, std::size_t j, std::size_t i, const Placement& x) {
  M apart = none();
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
    const V way_l = hn::Set(k_lanes, x.way[l]), way_m = hn::Set(k_lanes, x.way[m]);
    const V l_off = hn::Sub(hn::Load(k_lanes, a.center[l] + i), hn::Set(k_lanes, b.other_center[l][j]));
    const V m_off = hn::Sub(hn::Load(k_lanes, a.center[m] + i), hn::Set(k_lanes, b.other_center[m][j]));
    const V l_half = hn::Add(hn::Load(k_lanes, a.half[l] + i), hn::Set(k_lanes, b.still_half[l][j]));
    const V m_half = hn::Add(hn::Load(k_lanes, a.half[m] + i), hn::Set(k_lanes, b.still_half[m][j]));
    const V across = hn::Sub(hn::Mul(l_off, way_m), hn::Mul(m_off, way_l));
    const V reach = mul_add(l_half, hn::Abs(way_m), hn::Mul(m_half, hn::Abs(way_l)));
    apart = hn::Or(apart, hn::Gt(hn::Abs(across), reach));
  }
  return apart;
}

/// Children of A (bits) that may meet child j of B.
template <bool moving>
HWY_INLINE std::uint32_t meeting(const Children& a, const Tree::Node& node_a, const Children& b, std::size_t j,
                                 const Placement& x) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    M apart = none();
    V middle_a = hn::Zero(k_lanes), radius_a = hn::Zero(k_lanes);  // of A's boxes along the normal of j
    V middle_b = hn::Zero(k_lanes), radius_b = hn::Zero(k_lanes);  // of j's box along A's normals
    for (std::size_t k = 0; k < 3; ++k) {
      const V other = hn::Load(k_lanes, a.other_center[k] + i);
      const V gap_in_a =
          hn::Sub(hn::Abs(hn::Sub(hn::Load(k_lanes, a.center[k] + i), hn::Set(k_lanes, b.other_center[k][j]))),
                  hn::Load(k_lanes, a.half[k] + i));
      const V gap_in_b =
          hn::Sub(hn::Abs(hn::Sub(other, hn::Set(k_lanes, b.center[k][j]))), hn::Load(k_lanes, a.other_half[k] + i));
      apart = hn::Or(apart, hn::Gt(gap_in_a, hn::Set(k_lanes, b.other_half[k][j])));
      apart = hn::Or(apart, hn::Gt(gap_in_b, hn::Set(k_lanes, b.half[k][j])));
      const V normal_a = hn::Load(k_lanes, a.normal[k] + i);  // of A's child, in B's frame
      const V normal_b = hn::Set(k_lanes, b.normal[k][j]);    // of j, in A's frame
      middle_a = mul_add(normal_b, hn::Load(k_lanes, a.center[k] + i), middle_a);
      radius_a = mul_add(hn::Abs(normal_b), hn::Load(k_lanes, a.half[k] + i), radius_a);
      middle_b = mul_add(hn::Load(k_lanes, node_a.normal[k] + i), hn::Set(k_lanes, b.other_center[k][j]), middle_b);
      radius_b = mul_add(hn::Abs(normal_a), hn::Set(k_lanes, b.half[k][j]), radius_b);
    }
    apart = hn::Or(apart, hn::Gt(hn::Sub(middle_b, radius_b), hn::Load(k_lanes, a.slab_upper + i)));
    apart = hn::Or(apart, hn::Lt(hn::Add(middle_b, radius_b), hn::Load(k_lanes, a.slab_lower + i)));
    apart = hn::Or(apart, hn::Gt(hn::Sub(middle_a, radius_a), hn::Set(k_lanes, b.slab_upper[j])));
    apart = hn::Or(apart, hn::Lt(hn::Add(middle_a, radius_a), hn::Set(k_lanes, b.slab_lower[j])));
    if constexpr (moving) apart = hn::Or(apart, passed_by(a, b, j, i, x));
    HWY_ALIGN std::uint8_t stored[8] = {};
    hn::StoreMaskBits(k_lanes, hn::Not(apart), stored);
    bits |= static_cast<std::uint32_t>(stored[0]) << i;
  }
  return bits;
}

/// A leaf's triangles in A's frame, relative to the centre of A's tree. Missing triangles repeat the last.
struct alignas(64) LeafLanes {
  float corner[3][3][k_leaf];  // [corner][axis]
  float normal[3][k_leaf];     // (c1 - c0) x (c2 - c0)
  float lower[3][k_leaf], upper[3][k_leaf];
  float size[k_leaf];  // sum of the absolute components of both edges from corner 0
};

/// Fills everything but the corners, from the corners.
HWY_INLINE void complete(LeafLanes& leaf, float slack) {
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

HWY_INLINE void load_leaf_of_b(const Tree::Leaf& from, const Placement& x, LeafLanes& out) {
  for (std::size_t i = 0; i < k_leaf; i += hn::Lanes(k_leaf_lanes)) {
    for (std::size_t c = 0; c < 3; ++c) {
      LeafV p[3];
      for (std::size_t k = 0; k < 3; ++k) p[k] = hn::Load(k_leaf_lanes, from.corner[c][k] + i);
      for (std::size_t k = 0; k < 3; ++k) {
        LeafV q = hn::Set(k_leaf_lanes, x.shift[k]);
        for (std::size_t j = 0; j < 3; ++j) q = mul_add(hn::Set(k_leaf_lanes, x.rotation[k][j]), p[j], q);
        hn::Store(q, k_leaf_lanes, out.corner[c][k] + i);
      }
    }
  }
  complete(out, x.slack);
}

HWY_INLINE void load_leaf_of_a(const Tree::Leaf& from, LeafLanes& out) {
  std::memcpy(out.corner, from.corner, sizeof(out.corner));
  complete(out, 0.0f);
}

/// Shares of the way, per lane, between which two boxes of A's frame meet along an axis.
HWY_INLINE void narrow_to_boxes(V lower_a, V upper_a, V lower_b, V upper_b, std::size_t axis, const Placement& x,
                                V& first, V& last) {
  const V room = hn::Set(k_lanes, x.room[axis]);
  const V per_way = hn::Set(k_lanes, x.per_way[axis]);
  const V low = hn::Mul(hn::Sub(hn::Sub(lower_a, upper_b), room), per_way);
  const V high = hn::Mul(hn::Add(hn::Sub(upper_a, lower_b), room), per_way);
  first = hn::Max(first, x.per_way[axis] < 0.0f ? high : low);
  last = hn::Min(last, x.per_way[axis] < 0.0f ? low : high);
}

/// Some way beyond every share of it.
constexpr float k_beyond = 1e9f;

/// Shares are quotients of rounded differences.
constexpr float k_share_rounding = 2e-6f;

/// Children of A (bits) whose boxes a leaf of B meets on the way.
HWY_INLINE std::uint32_t meeting_boxes(const Tree::Node& node_a, const LeafLanes& b, const Placement& x) {
  float lower[3], upper[3];
  for (std::size_t k = 0; k < 3; ++k) {
    lower[k] = *std::min_element(b.lower[k], b.lower[k] + k_leaf);
    upper[k] = *std::max_element(b.upper[k], b.upper[k] + k_leaf);
  }
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    V first = hn::Zero(k_lanes), last = hn::Set(k_lanes, 1.0f);
    for (std::size_t k = 0; k < 3; ++k) {
      narrow_to_boxes(hn::Load(k_lanes, node_a.lower[k] + i), hn::Load(k_lanes, node_a.upper[k] + i),
                      hn::Set(k_lanes, lower[k]), hn::Set(k_lanes, upper[k]), k, x, first, last);
    }
    HWY_ALIGN std::uint8_t stored[8] = {};
    hn::StoreMaskBits(k_lanes, hn::Le(first, hn::Add(last, hn::Set(k_lanes, 2.0f * k_share_rounding))), stored);
    bits |= static_cast<std::uint32_t>(stored[0]) << i;
  }
  return bits;
}

/// Values of A's and of B's triangles for pairs i ...: pair 4 i + j is that of triangles i and j.
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

/// Errors of the other triangle's corners' heights above A's and above B's triangle, in units of the length of its
/// normal, wherever the boxes meet. A normal is a sum of products of edges (size E) whose coordinates are off by twice
/// the slack s: 8 s E. A corner of the other triangle is then at most E + E' + 6 s away, off by 2 s: together below
/// 16 s E (2 E + E' + 6 s), which leaves room for the rounding of the products.
HWY_INLINE void height_tolerances(V size_a, V size_b, float slack, V& tolerance_a, V& tolerance_b) {
  const V s = hn::Set(k_lanes, 16.0f * slack);
  const V both = hn::Add(hn::Add(size_a, size_b), hn::Set(k_lanes, 6.0f * slack));
  tolerance_a = hn::Mul(hn::Mul(s, size_a), hn::Add(both, size_a));
  tolerance_b = hn::Mul(hn::Mul(s, size_b), hn::Add(both, size_b));
}

/// Calls visit(lane, pair) for the pairs of triangles whose bits are set; bit 4 i + j is triangle i of A's leaf and
/// triangle j of B's. Lanes beyond a leaf's triangles do not count.
template <class Visit>
HWY_INLINE void for_each_pair(std::uint32_t bits, Tree::Child leaf_a, Tree::Child leaf_b, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
    const std::uint32_t t = lane / k_leaf, u = lane % k_leaf;
    if (t < leaf_a.count() && u < leaf_b.count()) visit(lane, CandidatePair{leaf_a.first() + t, leaf_b.first() + u});
  }
}

/// @tparam moving B's way is not zero.
/// @tparam Meet called with two leaves and their lanes: finds the pairs of triangles that may meet.
template <bool moving, class Meet>
class Descent {
 public:
  Descent(const Tree& a, const Tree& b, const Placement& placement, Meet meet)
      : a_(a), b_(b), placement_(placement), meet_(meet) {}

  /// Visits all pairs of the given children (bits) of two nodes.
  void visit(std::uint32_t index_a, std::uint32_t index_b, std::uint32_t lanes_a, std::uint32_t lanes_b) {
    const Tree::Node& node_a = a_.nodes()[index_a];
    const Tree::Node& node_b = b_.nodes()[index_b];
    std::uint32_t meet[k_width] = {};
    std::uint32_t leaves_a = 0;
    {
      Children children_a, children_b;
      see<false>(node_a, placement_, children_a);
      see<true>(node_b, placement_, children_b);
      lanes_a &= (1u << node_a.child_count) - 1;
      lanes_b &= (1u << node_b.child_count) - 1;
      for (std::uint32_t rest = lanes_b; rest != 0; rest &= rest - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(rest));
        meet[j] = meeting<moving>(children_a, node_a, children_b, j, placement_) & lanes_a;
      }
    }
    for (std::size_t i = 0; i < node_a.child_count; ++i) {
      if (node_a.child[i].is_leaf()) leaves_a |= 1u << i;
    }
    meet_leaves(node_a, node_b, leaves_a, lanes_b, meet);
    for (std::uint32_t rest = lanes_b; rest != 0; rest &= rest - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(rest));
      const Tree::Child child_b = node_b.child[j];
      for (std::uint32_t m = child_b.is_leaf() ? meet[j] & ~leaves_a : meet[j]; m != 0; m &= m - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(m));
        const Tree::Child child_a = node_a.child[i];
        if (child_b.is_leaf()) {
          visit(child_a.node(), index_b, ~0u, 1u << j);
        } else if (child_a.is_leaf()) {
          visit(index_a, child_b.node(), 1u << i, ~0u);
        } else {
          visit(child_a.node(), child_b.node(), ~0u, ~0u);
        }
      }
    }
  }

 private:
  HWY_NOINLINE void meet_leaves(const Tree::Node& node_a, const Tree::Node& node_b, std::uint32_t leaves_a,
                                std::uint32_t lanes_b, const std::uint32_t* meet) {
    LeafLanes of_a[k_width], of_b;
    std::uint32_t loaded = 0;
    for (std::uint32_t rest = lanes_b; rest != 0; rest &= rest - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(rest));
      const Tree::Child leaf_b = node_b.child[j];
      if (!leaf_b.is_leaf() || (meet[j] & leaves_a) == 0) continue;
      load_leaf_of_b(b_.leaves()[node_b.leaf[j]], placement_, of_b);
      std::uint32_t left = meet[j] & leaves_a;
      if constexpr (moving) left &= meeting_boxes(node_a, of_b, placement_);
      for (std::uint32_t m = left; m != 0; m &= m - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(m));
        const Tree::Child leaf_a = node_a.child[i];
        if ((loaded & 1u << i) == 0) load_leaf_of_a(a_.leaves()[node_a.leaf[i]], of_a[i]);
        loaded |= 1u << i;
        meet_(leaf_a, of_a[i], leaf_b, of_b);
      }
    }
  }

  const Tree& a_;
  const Tree& b_;
  const Placement& placement_;
  Meet meet_;
};

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::candidates
HWY_AFTER_NAMESPACE();

#endif
