#include <sixdof/oracle/candidates.h>

#include <algorithm>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/candidates.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Pairs of nodes are descended depth first. Of each pair of nodes, all 8 x 8 pairs of children are tested at once, one
// child of A per SIMD lane, by boxes in both frames and by both slabs. Pairs of leaves go on to a test of their 4 x 4
// pairs of triangles, one pair per lane: boxes, then both triangles' planes.
//
// Everything is in floats relative to the centre of A's tree, with room for rounding: a test may only say that two
// things are apart. So instruction sets differ in the pairs that they let through in vain, in nothing else.

HWY_BEFORE_NAMESPACE();
namespace sixdof {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, Tree::k_width>;
using V = hn::Vec<Lanes>;
using M = hn::Mask<Lanes>;

constexpr Lanes k_lanes;
constexpr std::size_t k_width = Tree::k_width;
constexpr std::size_t k_leaf = Tree::k_leaf_triangles;
constexpr std::size_t k_pairs = k_leaf * k_leaf;

/// No lane.
HWY_INLINE M none() { return hn::Lt(hn::Zero(k_lanes), hn::Zero(k_lanes)); }

/// X_AB as seen by the trees: p_A - center_A = rotation (p_B - center_B) + shift.
struct Placement {
  float rotation[3][3];
  float shift[3];
  float slack;  ///< Largest error of a placed coordinate.

  Placement(const Tree& a, const Tree& b, const Pose& X_AB) {
    const Eigen::Vector3d d = X_AB.R * b.center() + X_AB.t - a.center();
    // A coordinate is the sum of seven products and sums of lengths of this size, each rounded by 6e-8.
    constexpr double k_float_rounding = 6e-7;
    // Rounding of the doubles themselves where the bodies are far from their origins.
    constexpr double k_double_rounding = 1e-14;
    slack =
        static_cast<float>(k_float_rounding * (a.radius() + b.radius() + d.lpNorm<Eigen::Infinity>()) +
                           k_double_rounding * (X_AB.t.lpNorm<1>() + b.center().lpNorm<1>() + a.center().lpNorm<1>()));
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) rotation[i][k] = static_cast<float>(X_AB.R(i, k));
      shift[i] = static_cast<float>(d[i]);
    }
  }
};

/// Volumes of a node's children in their own frame and seen from the other's: boxes as centre and half extents.
struct alignas(64) Children {
  float center[3][k_width], half[3][k_width];              // own frame
  float other_center[3][k_width], other_half[3][k_width];  // box around it in the other frame, half with slack
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
      from[k] = to_a ? c[k] : hn::Sub(c[k], hn::Set(k_lanes, x.shift[k]));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      V center = to_a ? hn::Set(k_lanes, x.shift[k]) : hn::Zero(k_lanes);
      V extent = slack;
      V normal = hn::Zero(k_lanes);
      for (std::size_t j = 0; j < 3; ++j) {
        const V r = hn::Set(k_lanes, to_a ? x.rotation[k][j] : x.rotation[j][k]);
        center = hn::MulAdd(r, from[j], center);
        extent = hn::MulAdd(hn::Abs(r), h[j], extent);
        normal = hn::MulAdd(r, n[j], normal);
      }
      hn::Store(center, k_lanes, out.other_center[k] + i);
      hn::Store(extent, k_lanes, out.other_half[k] + i);
      hn::Store(normal, k_lanes, out.normal[k] + i);
    }
    // Three products of a normal with coordinates that are off by the slack.
    const V slab_slack = hn::Mul(hn::Set(k_lanes, 3.0f), slack);
    V lower = hn::Sub(hn::Load(k_lanes, node.slab_lower + i), slab_slack);
    V upper = hn::Add(hn::Load(k_lanes, node.slab_upper + i), slab_slack);
    if (to_a) {
      for (std::size_t k = 0; k < 3; ++k) {
        const V along = hn::Mul(hn::Load(k_lanes, out.normal[k] + i), hn::Set(k_lanes, x.shift[k]));
        lower = hn::Add(lower, along);
        upper = hn::Add(upper, along);
      }
    }
    hn::Store(lower, k_lanes, out.slab_lower + i);
    hn::Store(upper, k_lanes, out.slab_upper + i);
  }
}

/// Children of A (bits) that may meet child j of B.
HWY_INLINE std::uint32_t meeting(const Children& a, const Tree::Node& node_a, const Children& b, std::size_t j) {
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
      middle_a = hn::MulAdd(normal_b, hn::Load(k_lanes, a.center[k] + i), middle_a);
      radius_a = hn::MulAdd(hn::Abs(normal_b), hn::Load(k_lanes, a.half[k] + i), radius_a);
      middle_b = hn::MulAdd(hn::Load(k_lanes, node_a.normal[k] + i), hn::Set(k_lanes, b.other_center[k][j]), middle_b);
      radius_b = hn::MulAdd(hn::Abs(normal_a), hn::Set(k_lanes, b.half[k][j]), radius_b);
    }
    apart = hn::Or(apart, hn::Gt(hn::Sub(middle_b, radius_b), hn::Load(k_lanes, a.slab_upper + i)));
    apart = hn::Or(apart, hn::Lt(hn::Add(middle_b, radius_b), hn::Load(k_lanes, a.slab_lower + i)));
    apart = hn::Or(apart, hn::Gt(hn::Sub(middle_a, radius_a), hn::Set(k_lanes, b.slab_upper[j])));
    apart = hn::Or(apart, hn::Lt(hn::Add(middle_a, radius_a), hn::Set(k_lanes, b.slab_lower[j])));
    HWY_ALIGN std::uint8_t stored[8] = {};
    hn::StoreMaskBits(k_lanes, hn::Not(apart), stored);
    bits |= static_cast<std::uint32_t>(stored[0]) << i;
  }
  return bits;
}

/// Triangles of a leaf as lanes, relative to the centre of A's tree, in A's frame. Missing triangles repeat the first.
template <std::size_t lanes>
struct alignas(64) LeafLanes {
  float corner[3][3][lanes];  // [corner][axis]
  float normal[3][lanes];     // (c1 - c0) x (c2 - c0)
  float lower[3][lanes], upper[3][lanes];
  float size[lanes];  // sum of the absolute components of both edges from corner 0
};

/// Fills everything but the corners, from the corners, with operations on 4-lane blocks.
template <std::size_t lanes>
HWY_INLINE void complete(LeafLanes<lanes>& leaf, float slack) {
  for (std::size_t i = 0; i < lanes; ++i) {
    float u[3], v[3];
    leaf.size[i] = 0.0f;
    for (std::size_t k = 0; k < 3; ++k) {
      const float p = leaf.corner[0][k][i], q = leaf.corner[1][k][i], r = leaf.corner[2][k][i];
      u[k] = q - p;
      v[k] = r - p;
      leaf.size[i] += std::abs(u[k]) + std::abs(v[k]);
      leaf.lower[k][i] = std::min(std::min(p, q), r) - slack;
      leaf.upper[k][i] = std::max(std::max(p, q), r) + slack;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
      leaf.normal[k][i] = u[l] * v[m] - u[m] * v[l];
    }
  }
}

using LanesOfA = LeafLanes<k_pairs>;  // lane 4 i + j: triangle i
using LanesOfB = LeafLanes<k_leaf>;   // lane j: triangle j

void load_leaf_of_b(const Tree& tree, Tree::Child leaf, const Placement& x, LanesOfB& out) {
  for (std::size_t j = 0; j < k_leaf; ++j) {
    const Tree::Corners& corners = tree.corners()[leaf.first() + (j < leaf.count() ? j : 0)];
    for (std::size_t c = 0; c < 3; ++c) {
      float p[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        p[k] = static_cast<float>(corners[c][axis] - tree.center()[axis]);
      }
      for (std::size_t k = 0; k < 3; ++k) {
        out.corner[c][k][j] = x.shift[k] + x.rotation[k][0] * p[0] + x.rotation[k][1] * p[1] + x.rotation[k][2] * p[2];
      }
    }
  }
  complete(out, x.slack);
}

void load_leaf_of_a(const Tree& tree, Tree::Child leaf, LanesOfA& out) {
  LanesOfB once;
  for (std::size_t i = 0; i < k_leaf; ++i) {
    const Tree::Corners& corners = tree.corners()[leaf.first() + (i < leaf.count() ? i : 0)];
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        once.corner[c][k][i] = static_cast<float>(corners[c][axis] - tree.center()[axis]);
      }
    }
  }
  complete(once, 0.0f);
  const auto spread = [](const float* from, float* to) {
    for (std::size_t i = 0; i < k_pairs; ++i) to[i] = from[i / k_leaf];
  };
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 3; ++c) spread(once.corner[c][k], out.corner[c][k]);
    spread(once.normal[k], out.normal[k]);
    spread(once.lower[k], out.lower[k]);
    spread(once.upper[k], out.upper[k]);
  }
  spread(once.size, out.size);
}

/// Lanes in which all corners lie strictly on one side of a plane, by more than `tolerance`.
HWY_INLINE M on_one_side(const V (&normal)[3], const V (&origin)[3], const V (&corner)[3][3], V tolerance) {
  V height[3];
  for (std::size_t c = 0; c < 3; ++c) {
    height[c] = hn::Mul(normal[0], hn::Sub(corner[c][0], origin[0]));
    height[c] = hn::MulAdd(normal[1], hn::Sub(corner[c][1], origin[1]), height[c]);
    height[c] = hn::MulAdd(normal[2], hn::Sub(corner[c][2], origin[2]), height[c]);
  }
  const V lowest = hn::Min(hn::Min(height[0], height[1]), height[2]);
  const V highest = hn::Max(hn::Max(height[0], height[1]), height[2]);
  return hn::Or(hn::Gt(lowest, tolerance), hn::Lt(highest, hn::Neg(tolerance)));
}

/// Pairs of triangles that may meet: bit 4 i + j.
HWY_INLINE std::uint32_t meeting_triangles(const LanesOfA& a, const LanesOfB& b, float slack) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < k_pairs; i += hn::Lanes(k_lanes)) {
    const auto of_a = [i](const float* p) { return hn::Load(k_lanes, p + i); };
    const auto of_b = [i](const float* p) {
#if HWY_TARGET == HWY_SCALAR
      return hn::Load(k_lanes, p + i % k_leaf);
#else
      (void)i;
      return hn::LoadDup128(k_lanes, p);
#endif
    };
    M apart = none();
    for (std::size_t k = 0; k < 3; ++k) {
      apart = hn::Or(apart, hn::Gt(of_a(a.lower[k]), of_b(b.upper[k])));
      apart = hn::Or(apart, hn::Gt(of_b(b.lower[k]), of_a(a.upper[k])));
    }
    if (hn::AllTrue(k_lanes, apart)) continue;
    V corner_a[3][3], corner_b[3][3], normal_a[3], normal_b[3];
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        corner_a[c][k] = of_a(a.corner[c][k]);
        corner_b[c][k] = of_b(b.corner[c][k]);
      }
      normal_a[k] = of_a(a.normal[k]);
      normal_b[k] = of_b(b.normal[k]);
    }
    // A normal is a sum of products of edges (size E) whose coordinates are off by twice the slack s: 8 s E. A corner
    // of the other triangle, whose box meets this one's, is at most E + E' + 6 s away, off by 2 s: together below 16 s
    // E (2 E + E' + 6 s), which leaves room for the rounding of the products.
    const V size_a = of_a(a.size), size_b = of_b(b.size);
    const V s = hn::Set(k_lanes, 16.0f * slack);
    const V both = hn::Add(hn::Add(size_a, size_b), hn::Set(k_lanes, 6.0f * slack));
    const V tolerance_a = hn::Mul(hn::Mul(s, size_a), hn::Add(both, size_a));
    const V tolerance_b = hn::Mul(hn::Mul(s, size_b), hn::Add(both, size_b));
    apart = hn::Or(apart, on_one_side(normal_a, corner_a[0], corner_b, tolerance_a));
    apart = hn::Or(apart, on_one_side(normal_b, corner_b[0], corner_a, tolerance_b));
    HWY_ALIGN std::uint8_t stored[8] = {};
    hn::StoreMaskBits(k_lanes, hn::Not(apart), stored);
    bits |= static_cast<std::uint32_t>(stored[0]) << i;
  }
  return bits;
}

class Descent {
 public:
  Descent(const Tree& a, const Tree& b, const Pose& X_AB, std::vector<CandidatePair>& pairs)
      : a_(a), b_(b), placement_(a, b, X_AB), pairs_(pairs) {}

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
        meet[j] = meeting(children_a, node_a, children_b, j) & lanes_a;
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
    LanesOfA of_a[k_width];
    LanesOfB of_b;
    std::uint32_t loaded = 0;
    for (std::uint32_t rest = lanes_b; rest != 0; rest &= rest - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(rest));
      const Tree::Child leaf_b = node_b.child[j];
      if (!leaf_b.is_leaf() || (meet[j] & leaves_a) == 0) continue;
      load_leaf_of_b(b_, leaf_b, placement_, of_b);
      for (std::uint32_t m = meet[j] & leaves_a; m != 0; m &= m - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(m));
        const Tree::Child leaf_a = node_a.child[i];
        if ((loaded & 1u << i) == 0) load_leaf_of_a(a_, leaf_a, of_a[i]);
        loaded |= 1u << i;
        for (std::uint32_t p = meeting_triangles(of_a[i], of_b, placement_.slack); p != 0; p &= p - 1) {
          const auto pair = static_cast<std::uint32_t>(std::countr_zero(p));
          const std::uint32_t t = pair / k_leaf, u = pair % k_leaf;
          if (t < leaf_a.count() && u < leaf_b.count()) pairs_.push_back({leaf_a.first() + t, leaf_b.first() + u});
        }
      }
    }
  }

  const Tree& a_;
  const Tree& b_;
  const Placement placement_;
  std::vector<CandidatePair>& pairs_;
};

void find_candidates_here(const Tree& a, const Tree& b, const Pose& X_AB, std::vector<CandidatePair>& pairs) {
  Descent(a, b, X_AB, pairs).visit(0, 0, ~0u, ~0u);
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof {

HWY_EXPORT(find_candidates_here);

void find_candidates(const Tree& a, const Tree& b, const Pose& X_AB, std::vector<CandidatePair>& pairs) {
  pairs.clear();
  HWY_DYNAMIC_DISPATCH(find_candidates_here)(a, b, X_AB, pairs);
}

void find_in_box(const Tree& tree, const Eigen::AlignedBox3d& box, std::vector<std::uint32_t>& triangles) {
  triangles.clear();
  // Rounding to float, and of the difference from the tree's centre.
  const double slack = 1e-6 * (tree.radius() + box.diagonal().norm()) + 1e-15 * tree.center().lpNorm<1>();
  float lower[3], upper[3];
  for (int k = 0; k < 3; ++k) {
    lower[k] = static_cast<float>(box.min()[k] - tree.center()[k] - slack);
    upper[k] = static_cast<float>(box.max()[k] - tree.center()[k] + slack);
  }
  const auto visit = [&](auto&& self, const Tree::Node& node) -> void {
    for (std::size_t i = 0; i < node.child_count; ++i) {
      bool apart = false;
      for (std::size_t k = 0; k < 3; ++k) apart = apart || node.lower[k][i] > upper[k] || node.upper[k][i] < lower[k];
      if (apart) continue;
      const Tree::Child child = node.child[i];
      if (!child.is_leaf()) {
        self(self, tree.nodes()[child.node()]);
        continue;
      }
      for (std::uint32_t t = child.first(); t < child.first() + child.count(); ++t) triangles.push_back(t);
    }
  };
  visit(visit, tree.nodes()[0]);
}

}  // namespace sixdof
#endif  // HWY_ONCE
