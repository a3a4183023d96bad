#include <sixdof/oracle/distance_traversal.h>

#include <algorithm>
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

/// A child's volume, taken out of its node.
struct Volume {
  float lower[3];
  float upper[3];
  float normal[3];
  float slab_lower;
  float slab_upper;

  float size() const {
    const float x = upper[0] - lower[0];
    const float y = upper[1] - lower[1];
    const float z = upper[2] - lower[2];
    return x * x + y * y + z * z;
  }
};

Volume volume_of(const Tree& tree, std::uint32_t child) {
  Volume v;
  const Tree::Node& node = tree.nodes()[child == OpenPair::k_root ? 0 : child / k_width];
  if (child == OpenPair::k_root) {
    for (std::size_t k = 0; k < 3; ++k) {
      v.lower[k] = *std::min_element(node.lower[k], node.lower[k] + node.child_count);
      v.upper[k] = *std::max_element(node.upper[k], node.upper[k] + node.child_count);
      v.normal[k] = 0.0f;
    }
    v.slab_lower = v.slab_upper = 0.0f;
    return v;
  }
  const std::size_t lane = child % k_width;
  for (std::size_t k = 0; k < 3; ++k) {
    v.lower[k] = node.lower[k][lane];
    v.upper[k] = node.upper[k][lane];
    v.normal[k] = node.normal[k][lane];
  }
  v.slab_lower = node.slab_lower[lane];
  v.slab_upper = node.slab_upper[lane];
  return v;
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

  Fixed(const Volume& v, const Frame& f) {
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

/// Bounds on the distance of each child of `node` from `fixed`: a gap where positive.
HWY_INLINE void bound_children(const Tree::Node& node, const Fixed& fixed, const Frame& f, const Slack& slack,
                               float* HWY_RESTRICT bounds) {
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

    hn::Store(hn::Max(gap_toward, hn::Sub(gap, hn::Set(k_lanes, slack.far))), k_lanes, bounds + i);
  }
}

/// Up to 4 x 4 triangles of two leaves: floats relative to a corner of the first, so that they are exact to a rounding
/// of the leaves' own size. Lane 4 i + j holds pair (i, j).
struct LeafPair {
  static constexpr std::size_t k_pairs = Tree::k_leaf_triangles * Tree::k_leaf_triangles;
  HWY_ALIGN float a[3][3][k_pairs];  // [corner][axis][pair]
  HWY_ALIGN float b[3][3][k_pairs];
  HWY_ALIGN float bounds[k_pairs];
  float slack;
};

/// Bounds on the distances of all pairs, by Frank-Wolfe steps towards the closest points of the triangles' difference.
HWY_INLINE void bound_triangles(LeafPair& pairs, const float* HWY_RESTRICT w, float enough) {
  constexpr int k_steps = 5;
  for (std::size_t i = 0; i < LeafPair::k_pairs; i += hn::Lanes(k_lanes)) {
    const auto load = [i](const float* p) { return hn::Load(k_lanes, p + i); };
    const V slack = hn::Set(k_lanes, pairs.slack);
    const V goal = hn::Set(k_lanes, enough);
    V x[3];  // the direction tried: first w, from a to b, then the closest difference b - a so far
    for (std::size_t k = 0; k < 3; ++k) x[k] = hn::Set(k_lanes, w[k]);
    V best = hn::Set(k_lanes, -Tree::k_empty);
    for (int step = 0; step <= k_steps; ++step) {
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
      const V length = hn::Sqrt(hn::Max(length2, hn::Set(k_lanes, 1e-36f)));
      best = hn::Max(best, hn::Sub(hn::Div(hn::Sub(far_b, far_a), length), slack));
      if (step == k_steps || hn::AllTrue(k_lanes, hn::Gt(best, goal))) break;
      V d[3];
      for (std::size_t k = 0; k < 3; ++k) d[k] = hn::Sub(q[k], p[k]);
      if (step == 0) {  // w is no difference of points of the triangles; d is
        for (std::size_t k = 0; k < 3; ++k) x[k] = d[k];
        continue;
      }
      V down = hn::Zero(k_lanes);
      V norm = hn::Set(k_lanes, 1e-36f);
      for (std::size_t k = 0; k < 3; ++k) {
        d[k] = hn::Sub(d[k], x[k]);
        down = hn::NegMulAdd(x[k], d[k], down);
        norm = hn::MulAdd(d[k], d[k], norm);
      }
      const V t = hn::Min(hn::Max(hn::Div(down, norm), hn::Zero(k_lanes)), hn::Set(k_lanes, 1.0f));
      for (std::size_t k = 0; k < 3; ++k) x[k] = hn::MulAdd(t, d[k], x[k]);
    }
    hn::Store(best, k_lanes, pairs.bounds + i);
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

  static Tree::Child child_of(const Tree& tree, std::uint32_t child) {
    return child == OpenPair::k_root ? Tree::Child::node(0) : tree.nodes()[child / k_width].child[child % k_width];
  }

  /// Exact tests of two leaves. Returns true if the search is over.
  bool measure(Tree::Child leaf_a, Tree::Child leaf_b) {
    ++traversal.counts.leaf_pairs;
    const std::uint32_t count_a = leaf_a.count();
    const std::uint32_t count_b = leaf_b.count();
    const Tree::Corners* const a = tree_a.corners().data() + leaf_a.first();
    TriangleCorners b[Tree::k_leaf_triangles];
    for (std::uint32_t j = 0; j < count_b; ++j) {
      const Tree::Corners& corners = tree_b.corners()[leaf_b.first() + j];
      for (std::size_t k = 0; k < 3; ++k) b[j][k] = traversal.X_AB * corners[k];
    }
    LeafPair pairs;
    const Eigen::Vector3d origin = a[0][0];
    float size = 0.0f;
    for (std::uint32_t i = 0; i < Tree::k_leaf_triangles; ++i) {
      const TriangleCorners& ai = a[std::min(i, count_a - 1)];
      const TriangleCorners& bi = b[std::min(i, count_b - 1)];
      for (std::size_t corner = 0; corner < 3; ++corner) {
        for (int k = 0; k < 3; ++k) {
          const auto x = static_cast<float>(ai[corner][k] - origin[k]);
          const auto y = static_cast<float>(bi[corner][k] - origin[k]);
          size = std::max({size, std::abs(x), std::abs(y)});
          for (std::size_t j = 0; j < Tree::k_leaf_triangles; ++j) {
            pairs.a[corner][k][4 * i + j] = x;
            pairs.b[corner][k][4 * j + i] = y;
          }
        }
      }
    }
    pairs.slack = k_slack * size;
    bound_triangles(pairs, open_a.toward, best);
    for (std::uint32_t i = 0; i < count_a; ++i) {
      for (std::uint32_t j = 0; j < count_b; ++j) {
        if (pairs.bounds[4 * i + j] > best) continue;
        const TrianglePair pair{leaf_a.first() + i, leaf_b.first() + j};
        ++traversal.counts.triangles;
        if (only_intersection) {
          if (!triangles_intersect(a[i], b[j])) continue;
          traversal.found = true;
          traversal.pair = pair;
          return true;
        }
        if (offer_pair(traversal, pair, a[i], b[j])) {
          if (traversal.best == 0.0) return true;
          traversal.direction = traversal.closest.on_b - traversal.closest.on_a;
          set_direction();
          set_best();
        }
      }
    }
    return false;
  }

  void run() {
    std::vector<OpenPair>& open = traversal.open;
    open.clear();
    open.push_back({OpenPair::k_root, OpenPair::k_root, 0.0f});
    while (!open.empty()) {
      const OpenPair top = open.back();
      open.pop_back();
      if (top.lower > best) continue;
      const Tree::Child child_a = child_of(tree_a, top.a);
      const Tree::Child child_b = child_of(tree_b, top.b);
      if (child_a.is_leaf() && child_b.is_leaf()) {
        if (measure(child_a, child_b)) return;
        continue;
      }
      const Volume volume_a = volume_of(tree_a, top.a);
      const Volume volume_b = volume_of(tree_b, top.b);
      const bool opens_a = child_b.is_leaf() || (!child_a.is_leaf() && volume_a.size() >= volume_b.size());
      const std::uint32_t index = opens_a ? child_a.node() : child_b.node();
      const Tree::Node& node = opens_a ? tree_a.nodes()[index] : tree_b.nodes()[index];
      const Frame& frame = opens_a ? open_a : open_b;
      HWY_ALIGN float bounds[k_width];
      ++traversal.counts.nodes;
      bound_children(node, Fixed(opens_a ? volume_b : volume_a, frame), frame, slack, bounds);

      const std::size_t first = open.size();
      for (std::uint32_t i = 0; i < node.child_count; ++i) {
        if (bounds[i] > best) continue;
        OpenPair next{top.a, top.b, bounds[i]};
        (opens_a ? next.a : next.b) = static_cast<std::uint32_t>(index * k_width + i);
        std::size_t at = open.size();
        open.push_back(next);
        for (; at > first && open[at - 1].lower < next.lower; --at) open[at] = open[at - 1];
        open[at] = next;
      }
    }
  }
};

void find_closest(Traversal& traversal) { Descent(traversal, false).run(); }
void find_intersection(Traversal& traversal) { Descent(traversal, true).run(); }

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::detail {

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

void find_closest(Traversal& traversal) { HWY_DYNAMIC_DISPATCH(find_closest)(traversal); }
void find_intersection(Traversal& traversal) { HWY_DYNAMIC_DISPATCH(find_intersection)(traversal); }

}  // namespace sixdof::detail
#endif
