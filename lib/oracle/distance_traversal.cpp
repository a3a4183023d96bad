#include <sixdof/oracle/distance_traversal.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <Eigen/Geometry>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/distance_traversal.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Depth-first branch and bound over pairs of volumes, the closest pair first. Of two volumes the larger is opened: its
// eight children are bounded against the other volume ("the fixed one") at once, one child per SIMD lane.
//
// Every bound is the gap between projections on an axis, or the distance of two axis-aligned boxes:
//   - the direction of the closest points so far: where surfaces are smooth it is close to the normal of every pair
//     that matters, and the children's slabs make it tight;
//   - boxes in the frame of the one tree, and in that of the other;
//   - the normals of the slabs;
//   - the line through the centres.
// Bounds are floats and rounded; k_slack lowers them so far that they stay bounds. Hence which instruction set computed
// them, and in what order pairs are met, has no influence on the result: it is the smallest of the distances that
// triangle_triangle_distance() gives for all pairs.

HWY_BEFORE_NAMESPACE();
namespace sixdof::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, Tree::k_width>;
using V = hn::Vec<Lanes>;

constexpr Lanes k_lanes;
constexpr std::size_t k_width = Tree::k_width;

/// A bound is made of fewer than 30 roundings (6e-8 each) of numbers not larger than the sizes that it is scaled by.
constexpr float k_slack = 4e-6f;

struct Frame {
  float rotation[3][3];  // p_N = R p_F + t: from the fixed tree's frame to that of the opened one
  float translation[3];
  double translation_along;  // t . w
  float toward[3];           // w: unit vector from the opened tree's body to the fixed one's, in N
  float toward_fixed[3];     // the same in F
};

/// Square of a box's diagonal.
float size_of(const Tree::Volume& v) {
  const float x = v.upper[0] - v.lower[0];
  const float y = v.upper[1] - v.lower[1];
  const float z = v.upper[2] - v.lower[2];
  return x * x + y * y + z * z;
}

/// The fixed volume, seen from the opened tree's frame N.
struct Fixed {
  float center[3];
  float axis[3][3];       // axis[k]: half extent along F's axis k, in N
  float half[3];          // of the box around it in N
  float center_fixed[3];  // in F
  float half_fixed[3];    // in F
  float normal[3];
  float slab_lower;
  float slab_upper;
  float lowest;  // smallest p . w over the volume, without the translation's part

  Fixed(const Tree::Volume& v, const Frame& f) {
    for (std::size_t k = 0; k < 3; ++k) {
      center_fixed[k] = 0.5f * (v.lower[k] + v.upper[k]);
      half_fixed[k] = 0.5f * (v.upper[k] - v.lower[k]);
    }
    float normal_shift = 0.0f;
    for (std::size_t i = 0; i < 3; ++i) {
      const float* r = f.rotation[i];
      center[i] = f.translation[i] + r[0] * center_fixed[0] + r[1] * center_fixed[1] + r[2] * center_fixed[2];
      normal[i] = r[0] * v.normal[0] + r[1] * v.normal[1] + r[2] * v.normal[2];
      normal_shift += normal[i] * f.translation[i];
      half[i] = 0.0f;
      for (std::size_t k = 0; k < 3; ++k) {
        axis[k][i] = r[k] * half_fixed[k];
        half[i] += std::abs(axis[k][i]);
      }
    }
    slab_lower = v.slab_lower + normal_shift;
    slab_upper = v.slab_upper + normal_shift;

    // Smallest p . w over the box, and over the slab with the rest of w over the box.
    const float* w = f.toward_fixed;
    const float along = w[0] * v.normal[0] + w[1] * v.normal[1] + w[2] * v.normal[2];
    float over_box = 0.0f;
    float over_rest = 0.0f;
    for (std::size_t k = 0; k < 3; ++k) {
      over_box += w[k] * center_fixed[k] - std::abs(w[k]) * half_fixed[k];
      const float rest = w[k] - along * v.normal[k];
      over_rest += rest * center_fixed[k] - std::abs(rest) * half_fixed[k];
    }
    over_rest += std::min(along * v.slab_lower, along * v.slab_upper);
    lowest = std::max(over_box, over_rest);
  }
};

struct Slack {
  float sizes;  // where only coordinates relative to the centres enter
  float far;    // where the translation enters as well
};

/// Bounds on the distance of each child of `node` from `fixed`: a gap where positive. Returns a bit for each child
/// whose bound is not above `best`.
HWY_INLINE unsigned bound_children(const Tree::Node& node, const Fixed& fixed, const Frame& f, const Slack& slack,
                                   float best, float* HWY_RESTRICT bounds) {
  unsigned kept = 0;
  const V half = hn::Set(k_lanes, 0.5f);
  const V zero = hn::Zero(k_lanes);
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    V c[3], e[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const V lower = hn::Load(k_lanes, node.lower[k] + i);
      const V upper = hn::Load(k_lanes, node.upper[k] + i);
      c[k] = hn::Mul(half, hn::Add(lower, upper));
      e[k] = hn::Mul(half, hn::Sub(upper, lower));
    }
    const V n[3] = {hn::Load(k_lanes, node.normal[0] + i), hn::Load(k_lanes, node.normal[1] + i),
                    hn::Load(k_lanes, node.normal[2] + i)};
    const V slab_lower = hn::Load(k_lanes, node.slab_lower + i);
    const V slab_upper = hn::Load(k_lanes, node.slab_upper + i);

    // Along w: the children's largest p . w, over the box, and over the slab with the rest of w over the box.
    V along = zero;
    V over_box = zero;
    for (std::size_t k = 0; k < 3; ++k) {
      const V w = hn::Set(k_lanes, f.toward[k]);
      along = hn::MulAdd(w, n[k], along);
      over_box = hn::MulAdd(w, c[k], hn::MulAdd(hn::Abs(w), e[k], over_box));
    }
    V over_rest = hn::Max(hn::Mul(along, slab_lower), hn::Mul(along, slab_upper));
    for (std::size_t k = 0; k < 3; ++k) {
      const V rest = hn::NegMulAdd(along, n[k], hn::Set(k_lanes, f.toward[k]));
      over_rest = hn::MulAdd(rest, c[k], hn::MulAdd(hn::Abs(rest), e[k], over_rest));
    }
    const V gap_toward = hn::Sub(
        hn::Set(k_lanes, static_cast<float>(static_cast<double>(fixed.lowest) + f.translation_along) - slack.sizes),
        hn::Min(over_box, over_rest));

    // Boxes in N.
    V m[3];
    V widest = hn::Set(k_lanes, -Tree::k_empty);
    V squared = zero;
    for (std::size_t k = 0; k < 3; ++k) {
      m[k] = hn::Sub(hn::Set(k_lanes, fixed.center[k]), c[k]);
      const V gap = hn::Sub(hn::Abs(m[k]), hn::Add(e[k], hn::Set(k_lanes, fixed.half[k])));
      widest = hn::Max(widest, gap);
      const V positive = hn::Max(gap, zero);
      squared = hn::MulAdd(positive, positive, squared);
    }
    // Boxes in F: m and e turned by the transposed rotation.
    V widest_fixed = hn::Set(k_lanes, -Tree::k_empty);
    V squared_fixed = zero;
    for (std::size_t k = 0; k < 3; ++k) {
      V center = zero;
      V extent = hn::Set(k_lanes, fixed.half_fixed[k]);
      for (std::size_t j = 0; j < 3; ++j) {
        const V r = hn::Set(k_lanes, f.rotation[j][k]);
        center = hn::MulAdd(r, m[j], center);
        extent = hn::MulAdd(hn::Abs(r), e[j], extent);
      }
      const V gap = hn::Sub(hn::Abs(center), extent);
      widest_fixed = hn::Max(widest_fixed, gap);
      const V positive = hn::Max(gap, zero);
      squared_fixed = hn::MulAdd(positive, positive, squared_fixed);
    }
    V gap = hn::Max(widest, widest_fixed);
    gap = hn::Max(gap, hn::Sub(hn::Sqrt(hn::Max(squared, squared_fixed)),
                               hn::IfThenZeroElse(hn::Gt(gap, zero), hn::Set(k_lanes, Tree::k_empty))));

    // The fixed volume's slab.
    {
      V middle = zero;
      V radius = zero;
      for (std::size_t k = 0; k < 3; ++k) {
        const V axis = hn::Set(k_lanes, fixed.normal[k]);
        middle = hn::MulAdd(axis, c[k], middle);
        radius = hn::MulAdd(hn::Abs(axis), e[k], radius);
      }
      const V above = hn::Sub(hn::Sub(middle, radius), hn::Set(k_lanes, fixed.slab_upper));
      const V below = hn::Sub(hn::Set(k_lanes, fixed.slab_lower), hn::Add(middle, radius));
      gap = hn::Max(gap, hn::Max(above, below));
    }
    // The children's slabs, and the line through the centres.
    V middle = zero;
    V length2 = zero;
    V reach = zero;
    for (std::size_t k = 0; k < 3; ++k) {
      middle = hn::MulAdd(n[k], hn::Set(k_lanes, fixed.center[k]), middle);
      length2 = hn::MulAdd(m[k], m[k], length2);
      reach = hn::MulAdd(hn::Abs(m[k]), e[k], reach);
    }
    V radius = zero;
    for (std::size_t k = 0; k < 3; ++k) {
      V on_normal = zero;
      V on_line = zero;
      for (std::size_t j = 0; j < 3; ++j) {
        const V axis = hn::Set(k_lanes, fixed.axis[k][j]);
        on_normal = hn::MulAdd(axis, n[j], on_normal);
        on_line = hn::MulAdd(axis, m[j], on_line);
      }
      radius = hn::Add(radius, hn::Abs(on_normal));
      reach = hn::Add(reach, hn::Abs(on_line));
    }
    gap = hn::Max(gap,
                  hn::Max(hn::Sub(hn::Sub(middle, radius), slab_upper), hn::Sub(slab_lower, hn::Add(middle, radius))));
    const V length = hn::Sqrt(hn::Max(length2, hn::Set(k_lanes, 1e-36f)));
    gap = hn::Max(gap, hn::Sub(length, hn::Div(reach, length)));

    const V bound = hn::Max(gap_toward, hn::Sub(gap, hn::Set(k_lanes, slack.far)));
    hn::Store(bound, k_lanes, bounds + i);
    std::uint8_t bits[8];  // as many as StoreMaskBits may write
    hn::StoreMaskBits(k_lanes, hn::Le(bound, hn::Set(k_lanes, best)), bits);
    kept |= static_cast<unsigned>(bits[0]) << i;
  }
  return kept & ((1u << node.child_count) - 1);
}

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

struct Descent {
  Traversal& traversal;
  const Tree& tree_a;
  const Tree& tree_b;
  const bool only_intersection;
  Eigen::Vector3d shift;  // B's centre from A's, in A's frame
  Frame open_a;           // N = A, F = B
  Frame open_b;           // N = B, F = A
  Slack slack;
  float best;  // cut-off, rounded up

  Descent(Traversal& t, bool intersection) : traversal(t), tree_a(*t.a), tree_b(*t.b), only_intersection(intersection) {
    shift = t.X_AB * tree_b.center() - tree_a.center();
    const Eigen::Matrix3d& R = t.X_AB.R;
    const Eigen::Vector3d back = -(R.transpose() * shift);
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        open_a.rotation[i][k] = static_cast<float>(R(i, k));
        open_b.rotation[i][k] = static_cast<float>(R(k, i));
      }
      open_a.translation[i] = static_cast<float>(shift[i]);
      open_b.translation[i] = static_cast<float>(back[i]);
    }
    const double sizes = tree_a.radius() + tree_b.radius();
    // Poses and vertices far from the origins round in double before they come here.
    const double offsets = 1e-14 * (tree_a.center().norm() + tree_b.center().norm() + t.X_AB.t.norm());
    slack.sizes = static_cast<float>(k_slack * sizes + offsets);
    slack.far = static_cast<float>(k_slack * (sizes + shift.norm()) + offsets);
    if (traversal.direction.squaredNorm() == 0.0) traversal.direction = shift;
    set_direction();
    set_best();
  }

  void set_direction() {
    const double length = traversal.direction.norm();
    const Eigen::Vector3d w = length > 0.0 ? Eigen::Vector3d(traversal.direction / length) : Eigen::Vector3d::UnitX();
    const Eigen::Vector3d in_b = traversal.X_AB.R.transpose() * w;
    for (int i = 0; i < 3; ++i) {
      open_a.toward[i] = static_cast<float>(w[i]);
      open_a.toward_fixed[i] = static_cast<float>(in_b[i]);
      open_b.toward[i] = static_cast<float>(-in_b[i]);
      open_b.toward_fixed[i] = static_cast<float>(-w[i]);
    }
    open_a.translation_along = w.dot(shift);
    open_b.translation_along = w.dot(shift);  // (-R^T w) . (-R^T shift)
  }

  void set_best() {
    best = only_intersection ? 0.0f
                             : std::nextafter(static_cast<float>(std::min(traversal.best, 1e30)),
                                              std::numeric_limits<float>::infinity());
  }

  /// Exact test of two triangles. Returns true if the search is over.
  bool measure(TrianglePair pair) {
    const Tree::Corners& a = tree_a.corners()[pair.a];
    const Tree::Corners& fixed = tree_b.corners()[pair.b];
    const TriangleCorners b{traversal.X_AB * fixed[0], traversal.X_AB * fixed[1], traversal.X_AB * fixed[2]};
    ++traversal.counts.triangles;
    if (only_intersection) {
      if (!triangles_intersect(a, b)) return false;
      traversal.found = true;
      traversal.pair = pair;
      return true;
    }
    if (offer_pair(traversal, pair, a, b)) {
      if (traversal.best == 0.0) return true;
      traversal.direction = traversal.closest.on_b - traversal.closest.on_a;
      set_direction();
      set_best();
    }
    return false;
  }

  /// Pairs of triangles of two leaves. Returns true if the search is over.
  bool measure(const Tree::Leaf& leaf_a, const Tree::Leaf& leaf_b) {
    ++traversal.counts.leaf_pairs;
    LeafPair pairs;
    if (!bound_toward(leaf_a, leaf_b, open_a, slack, best, pairs.bounds)) return false;
    lay_out(leaf_a, leaf_b, open_a, pairs);
    bound_triangles(pairs, slack.far, best);
    // Pairs that certainly improve on the best, or that may intersect, are measured now, the most promising first. The
    // others wait: most of them will have become irrelevant.
    for (;;) {
      std::uint32_t next = LeafPair::k_pairs;
      for (std::uint32_t i = 0; i < leaf_a.child.count(); ++i) {
        for (std::uint32_t j = 0; j < leaf_b.child.count(); ++j) {
          const std::uint32_t lane = k_leaf * i + j;
          if (pairs.bounds[lane] > best || (pairs.bounds[lane] > 0.0f && pairs.reached[lane] >= best)) continue;
          if (next == LeafPair::k_pairs || pairs.reached[lane] < pairs.reached[next]) next = lane;
        }
      }
      if (next == LeafPair::k_pairs) break;
      pairs.bounds[next] = Tree::k_empty;
      if (measure({leaf_a.child.first() + next / k_leaf, leaf_b.child.first() + next % k_leaf})) return true;
    }
    for (std::uint32_t i = 0; i < leaf_a.child.count(); ++i) {
      for (std::uint32_t j = 0; j < leaf_b.child.count(); ++j) {
        const float bound = pairs.bounds[k_leaf * i + j];
        if (bound > best) continue;
        traversal.deferred.push_back({{leaf_a.child.first() + i, leaf_b.child.first() + j}, bound});
      }
    }
    return false;
  }

  void run() {
    traversal.deferred.clear();
    if (descend()) return;
    std::vector<DeferredPair>& rest = traversal.deferred;
    std::erase_if(rest, [this](const DeferredPair& x) { return x.lower > best; });
    std::sort(rest.begin(), rest.end(), [](const DeferredPair& x, const DeferredPair& y) { return x.lower < y.lower; });
    for (const DeferredPair& x : rest) {
      if (x.lower > best || measure(x.pair)) return;
    }
  }

  /// Returns true if the search is over.
  bool descend() {
    std::vector<OpenPair>& open = traversal.open;
    open.clear();
    open.push_back({0, 0, -Tree::k_empty});
    while (!open.empty()) {
      const OpenPair top = open.back();
      open.pop_back();
      if (top.lower > best) continue;
      const bool leaf_a = (top.a & OpenPair::k_leaf) != 0;
      const bool leaf_b = (top.b & OpenPair::k_leaf) != 0;
      if (leaf_a && leaf_b) {
        if (measure(tree_a.leaves()[top.a - OpenPair::k_leaf], tree_b.leaves()[top.b - OpenPair::k_leaf])) return true;
        continue;
      }
      const Tree::Volume& volume_a =
          leaf_a ? tree_a.leaves()[top.a - OpenPair::k_leaf].volume : tree_a.nodes()[top.a].volume;
      const Tree::Volume& volume_b =
          leaf_b ? tree_b.leaves()[top.b - OpenPair::k_leaf].volume : tree_b.nodes()[top.b].volume;
      const bool opens_a = leaf_b || (!leaf_a && size_of(volume_a) >= size_of(volume_b));
      const Tree::Node& node = opens_a ? tree_a.nodes()[top.a] : tree_b.nodes()[top.b];
      const Frame& frame = opens_a ? open_a : open_b;
      HWY_ALIGN float bounds[k_width];
      ++traversal.counts.nodes;
      unsigned kept = bound_children(node, Fixed(opens_a ? volume_b : volume_a, frame), frame, slack, best, bounds);

      const std::size_t first = open.size();
      for (; kept != 0; kept &= kept - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(kept));
        OpenPair next{top.a, top.b, bounds[i]};
        (opens_a ? next.a : next.b) = node.child[i].is_leaf() ? OpenPair::k_leaf + node.leaf[i] : node.child[i].node();
        std::size_t at = open.size();
        open.push_back(next);
        for (; at > first && open[at - 1].lower < next.lower; --at) open[at] = open[at - 1];
        open[at] = next;
      }
    }
    return false;
  }
};

/// A corner of a tree, the closest to some point so far.
struct Corner {
  float squared;
  std::uint32_t leaf;
  std::uint32_t triangle;  // in the leaf
  float point[3];          // relative to the tree's centre
};

/// Finds a corner closer to p than `best.squared`, nearly the closest. Returns whether there is one. Of corners that
/// differ by less than a few leaves' width sideways any will do: to look for the very closest of many nearly equal ones
/// would cost more than it saves.
bool find_corner(const Tree& tree, const float* p, Corner& best, std::vector<OpenPair>& open) {
  constexpr double k_leaves_wide = 32.0;  // square of it; r^2 / leaves is about a leaf's area
  const auto equal =
      static_cast<float>(k_leaves_wide * tree.radius() * tree.radius() / static_cast<double>(tree.leaves().size()));
  bool found = false;
  open.assign(1, {0, 0, 0.0f});
  while (!open.empty()) {
    const OpenPair top = open.back();
    open.pop_back();
    if (top.lower + equal >= best.squared) continue;
    if ((top.a & OpenPair::k_leaf) != 0) {
      const Tree::Leaf& leaf = tree.leaves()[top.a - OpenPair::k_leaf];
      for (std::size_t corner = 0; corner < 3; ++corner) {
        for (std::uint32_t t = 0; t < leaf.child.count(); ++t) {
          float squared = 0.0f;
          for (std::size_t k = 0; k < 3; ++k) {
            const float d = leaf.corner[corner][k][t] - p[k];
            squared += d * d;
          }
          if (squared >= best.squared) continue;
          best = {squared,
                  top.a - OpenPair::k_leaf,
                  t,
                  {leaf.corner[corner][0][t], leaf.corner[corner][1][t], leaf.corner[corner][2][t]}};
          found = true;
        }
      }
      continue;
    }
    const Tree::Node& node = tree.nodes()[top.a];
    HWY_ALIGN float bounds[k_width];
    for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
      V squared = hn::Zero(k_lanes);
      for (std::size_t k = 0; k < 3; ++k) {
        const V at = hn::Set(k_lanes, p[k]);
        const V below = hn::Sub(hn::Load(k_lanes, node.lower[k] + i), at);
        const V above = hn::Sub(at, hn::Load(k_lanes, node.upper[k] + i));
        const V gap = hn::Max(hn::Max(below, above), hn::Zero(k_lanes));
        squared = hn::MulAdd(gap, gap, squared);
      }
      hn::Store(squared, k_lanes, bounds + i);
    }
    const std::size_t first = open.size();
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      if (bounds[i] + equal >= best.squared) continue;
      const OpenPair next{node.child[i].is_leaf() ? OpenPair::k_leaf + node.leaf[i] : node.child[i].node(), 0,
                          bounds[i]};
      std::size_t at = open.size();
      open.push_back(next);
      for (; at > first && open[at - 1].lower < next.lower; --at) open[at] = open[at - 1];
      open[at] = next;
    }
  }
  return found;
}

void turn(const Frame& f, const float* p, float* out) {
  for (std::size_t k = 0; k < 3; ++k) {
    out[k] = f.translation[k] + f.rotation[k][0] * p[0] + f.rotation[k][1] * p[1] + f.rotation[k][2] * p[2];
  }
}

void offer_seed(Traversal& traversal, const Samples& samples_a, const Samples& samples_b) {
  constexpr int k_turns = 8;  // most searches settle after a few
  const Descent descent(traversal, false);
  const Frame& to_a = descent.open_a;
  const Frame& to_b = descent.open_b;

  HWY_ALIGN float least[k_width];
  HWY_ALIGN float pairs[k_width];  // which: an exact small integer
  float best = std::numeric_limits<float>::infinity();
  std::size_t best_a = 0;
  std::size_t best_b = 0;
  for (std::size_t i = 0; i < Samples::k_count; i += hn::Lanes(k_lanes)) {
    V b[3];
    for (std::size_t k = 0; k < 3; ++k) {
      b[k] = hn::Set(k_lanes, to_a.translation[k]);
      for (std::size_t m = 0; m < 3; ++m) {
        b[k] = hn::MulAdd(hn::Set(k_lanes, to_a.rotation[k][m]), hn::Load(k_lanes, samples_b.point[m] + i), b[k]);
      }
    }
    V closest = hn::Set(k_lanes, std::numeric_limits<float>::infinity());
    V which = hn::Zero(k_lanes);
    for (std::size_t j = 0; j < Samples::k_count; ++j) {
      V squared = hn::Zero(k_lanes);
      for (std::size_t k = 0; k < 3; ++k) {
        const V d = hn::Sub(b[k], hn::Set(k_lanes, samples_a.point[k][j]));
        squared = hn::MulAdd(d, d, squared);
      }
      which = hn::IfThenElse(hn::Lt(squared, closest), hn::Set(k_lanes, static_cast<float>(j)), which);
      closest = hn::Min(closest, squared);
    }
    hn::Store(closest, k_lanes, least);
    hn::Store(which, k_lanes, pairs);
    for (std::size_t lane = 0; lane < hn::Lanes(k_lanes); ++lane) {
      if (least[lane] < best) {
        best = least[lane];
        best_a = static_cast<std::size_t>(pairs[lane]);
        best_b = i + lane;
      }
    }
  }

  Corner a{best, samples_a.leaf[best_a], 0, {}};
  Corner b{best, samples_b.leaf[best_b], 0, {}};
  for (std::size_t k = 0; k < 3; ++k) {
    a.point[k] = samples_a.point[k][best_a];
    b.point[k] = samples_b.point[k][best_b];
  }
  float from[3];
  for (int i = 0; i < k_turns; ++i) {
    const bool search_b = i % 2 == 0;
    turn(search_b ? to_b : to_a, search_b ? a.point : b.point, from);
    Corner& moved = search_b ? b : a;
    moved.squared = best;
    if (!find_corner(search_b ? *traversal.b : *traversal.a, from, moved, traversal.open) && i > 0) break;
    best = moved.squared;
  }
  const TrianglePair pair{traversal.a->leaves()[a.leaf].child.first() + a.triangle,
                          traversal.b->leaves()[b.leaf].child.first() + b.triangle};
  const Tree::Corners& corners = traversal.b->corners()[pair.b];
  if (offer_pair(traversal, pair, traversal.a->corners()[pair.a],
                 {traversal.X_AB * corners[0], traversal.X_AB * corners[1], traversal.X_AB * corners[2]})) {
    traversal.direction = traversal.closest.on_b - traversal.closest.on_a;
  }
}

void find_closest(Traversal& traversal) { Descent(traversal, false).run(); }
void find_intersection(Traversal& traversal) { Descent(traversal, true).run(); }

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::detail {

HWY_EXPORT(offer_seed);
HWY_EXPORT(find_closest);
HWY_EXPORT(find_intersection);

bool offer_pair(Traversal& traversal, TrianglePair pair, const TriangleCorners& a, const TriangleCorners& b) {
  const ClosestPoints closest = triangle_triangle_distance(a, b);
  if (closest.distance > traversal.best) return false;
  const bool closer = closest.distance < traversal.best;
  if (!closer && traversal.found) {
    const auto rank = [&](const TrianglePair& p) {
      return std::pair(traversal.a->mesh_triangle()[p.a], traversal.b->mesh_triangle()[p.b]);
    };
    if (rank(traversal.pair) <= rank(pair)) return false;
  }
  traversal.best = closest.distance;
  traversal.found = true;
  traversal.pair = pair;
  traversal.closest = closest;
  return closer;
}

Samples::Samples(const Tree& tree) {
  for (std::size_t i = 0; i < k_count; ++i) {
    leaf[i] = static_cast<std::uint32_t>((2 * i + 1) * tree.leaves().size() / (2 * k_count));
    for (std::size_t k = 0; k < 3; ++k) point[k][i] = tree.leaves()[leaf[i]].corner[0][k][0];
  }
}

void offer_seed(Traversal& traversal, const Samples& a, const Samples& b) {
  HWY_DYNAMIC_DISPATCH(offer_seed)(traversal, a, b);
}

void find_closest(Traversal& traversal) { HWY_DYNAMIC_DISPATCH(find_closest)(traversal); }
void find_intersection(Traversal& traversal) { HWY_DYNAMIC_DISPATCH(find_intersection)(traversal); }

}  // namespace sixdof::detail
#endif
