// Part of distance_search.cpp, which includes it once per instruction set: it has no include guard.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include <hwy/highway.h>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/cross_axes.h>
#include <sixdof/oracle/lanes-inl.h>

// Lower bounds on the distances of one volume (the fixed one) from the eight children of a node (the expanded one),
// one child per SIMD lane.
//
// N is the frame of the expanded node's tree, F that of the fixed volume's tree, both with the origin at the tree's
// centre. w is a unit vector from the body of N to the body of F. Bounds are the gaps between the projections of both
// volumes on an axis:
//   - w, the direction between the closest points so far: on smooth surfaces it is close to the normals of all pairs
//     that are nearly as close;
//   - the line through the centres of the boxes: it turns with a pair that lies aside of the closest points, as the
//     direction between its own closest points does;
//   - the normals of the slabs;
//   - the axes of N and of F; where these are apart, the distance of two boxes aligned with N's, or with F's;
//   - where volumes cross (CrossAxesUse), the nine axes across an axis of N and one of F.
// A volume's projection is bounded by its box, and by its slab for the part of the axis along the slab's normal and its
// box for the rest (Reach). On a smooth surface the second shrinks with the square of the volume's size where the axis
// is close to its normal, the first only linearly.
//
// Bounds are floats; Slack lowers them by more than their rounding, so they are bounds on every instruction set. The
// answer does not depend on which bounds were computed: it is the smallest of triangle_triangle_distance() over all
// pairs.

HWY_BEFORE_NAMESPACE();
namespace sixdof::detail {
namespace HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;

/// Rounding of a bound, relative to the lengths that enter it: fewer than 30 roundings of 6e-8 each.
constexpr float k_slack = 4e-6f;

struct Frame {
  float rotation[3][3];  // p_N = rotation p_F + translation
  float translation[3];
  double translation_along;  // translation . w
  float direction[3];        // w in N
  float direction_fixed[3];  // w in F
};

/// By how much a bound is lowered (lengths).
struct Slack {
  float local;  // where only coordinates relative to the centres enter
  float all;    // where the translation enters as well
};

/// The pose of one query between the frames of both trees.
struct Frames {
  Eigen::Vector3d shift;  // from A's centre to B's, in A's frame
  Eigen::Matrix3d R;
  Frame expand_a;  // N = A, F = B
  Frame expand_b;  // N = B, F = A
  Slack slack;

  Frames(const Tree& a, const Tree& b, const Pose& X_AB) : shift(X_AB * b.center() - a.center()), R(X_AB.R) {
    const Eigen::Vector3d back = -(R.transpose() * shift);
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        expand_a.rotation[i][k] = static_cast<float>(R(i, k));
        expand_b.rotation[i][k] = static_cast<float>(R(k, i));
      }
      expand_a.translation[i] = static_cast<float>(shift[i]);
      expand_b.translation[i] = static_cast<float>(back[i]);
    }
    const double sizes = a.radius() + b.radius();
    // Rounding of the doubles, which matters where poses or vertices are far from the origins.
    const double offsets = 1e-14 * (a.center().norm() + b.center().norm() + X_AB.t.norm());
    slack.local = static_cast<float>(k_slack * sizes + offsets);
    slack.all = static_cast<float>(k_slack * (sizes + shift.norm()) + offsets);
  }

  /// Sets w to the direction from A to B given by a vector of any length in A's frame.
  void set_direction(const Eigen::Vector3d& direction) {
    const double length = direction.norm();
    const Eigen::Vector3d w = length > 0.0 ? Eigen::Vector3d(direction / length) : Eigen::Vector3d::UnitX();
    const Eigen::Vector3d in_b = R.transpose() * w;
    for (int i = 0; i < 3; ++i) {
      expand_a.direction[i] = static_cast<float>(w[i]);
      expand_a.direction_fixed[i] = static_cast<float>(in_b[i]);
      expand_b.direction[i] = static_cast<float>(-in_b[i]);
      expand_b.direction_fixed[i] = static_cast<float>(-w[i]);
    }
    expand_a.translation_along = w.dot(shift);
    expand_b.translation_along = w.dot(shift);  // (-R^T w) . (-R^T shift)
  }
};

HWY_INLINE V dot_fused(const V (&x)[3], const V (&y)[3]) {
  return hn::MulAdd(x[2], y[2], hn::MulAdd(x[1], y[1], hn::Mul(x[0], y[0])));
}

/// How far volumes reach from the centres of their boxes along an axis x and against it.
struct Reach {
  V up, down;

  /// @param box, rest half widths along x of the box, and along x - (normal . x) normal
  /// @param along normal . x
  /// @param slab_lower, slab_upper of the slab, from the centre of the box
  HWY_INLINE Reach(V box, V rest, V along, V slab_lower, V slab_upper) {
    const V to_lower = hn::Mul(along, slab_lower), to_upper = hn::Mul(along, slab_upper);
    up = hn::Min(box, hn::Add(rest, hn::Max(to_lower, to_upper)));
    down = hn::Min(box, hn::Sub(rest, hn::Min(to_lower, to_upper)));
  }
};

/// The fixed volume.
struct FixedVolume {
  float center[3];          // of the box, in N
  float axis[3][3];         // axis[k]: half extent along F's axis k, in N
  float half[3];            // half extents of the axis-aligned box around it in N
  float half_fixed[3];      // half extents in F
  float normal[3];          // of the slab, in N
  float normal_on_axis[3];  // normal . axis[k]
  float slab_lower;         // from the centre of the box
  float slab_upper;
  float least_along;  // smallest p . w over the volume, p in F

  FixedVolume(const Tree::Volume& v, const Frame& f) {
    float center_fixed[3];
    float on_normal = 0.0f;  // the centre of the box
    for (std::size_t k = 0; k < 3; ++k) {
      center_fixed[k] = 0.5f * (v.lower[k] + v.upper[k]);
      half_fixed[k] = 0.5f * (v.upper[k] - v.lower[k]);
      normal_on_axis[k] = v.normal[k] * half_fixed[k];
      on_normal += v.normal[k] * center_fixed[k];
    }
    slab_lower = v.slab_lower - on_normal;
    slab_upper = v.slab_upper - on_normal;
    for (std::size_t i = 0; i < 3; ++i) {
      const float* r = f.rotation[i];
      center[i] = f.translation[i] + r[0] * center_fixed[0] + r[1] * center_fixed[1] + r[2] * center_fixed[2];
      normal[i] = r[0] * v.normal[0] + r[1] * v.normal[1] + r[2] * v.normal[2];
      half[i] = 0.0f;
      for (std::size_t k = 0; k < 3; ++k) {
        axis[k][i] = r[k] * half_fixed[k];
        half[i] += std::abs(axis[k][i]);
      }
    }
    // As Reach, but from the origin: the rounding of the slab's distance from the centre of the box would blur layers.
    const float* w = f.direction_fixed;
    const float along = w[0] * v.normal[0] + w[1] * v.normal[1] + w[2] * v.normal[2];
    float over_box = 0.0f;
    float over_rest = std::min(along * v.slab_lower, along * v.slab_upper);
    for (std::size_t k = 0; k < 3; ++k) {
      over_box += w[k] * center_fixed[k] - std::abs(w[k]) * half_fixed[k];
      const float rest = w[k] - along * v.normal[k];
      over_rest += rest * center_fixed[k] - std::abs(rest) * half_fixed[k];
    }
    least_along = std::max(over_box, over_rest);
  }

  /// @param along normal . x
  HWY_INLINE Reach reach(const V (&x)[3], V along) const {
    V box = hn::Zero(k_lanes);
    V rest = hn::Zero(k_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      V on_axis = hn::Zero(k_lanes);
      for (std::size_t j = 0; j < 3; ++j) on_axis = hn::MulAdd(set(axis[k][j]), x[j], on_axis);
      box = hn::Add(box, hn::Abs(on_axis));
      rest = hn::Add(rest, hn::Abs(hn::NegMulAdd(along, set(normal_on_axis[k]), on_axis)));
    }
    return {box, rest, along, set(slab_lower), set(slab_upper)};
  }
};

/// Children i, i + 1, ... of the expanded node, in N.
struct ChildVolumes {
  V center[3], half[3];      // of the boxes
  V normal[3];               // of the slabs
  V slab_lower, slab_upper;  // from the origin
  V below, above;            // from the centres of the boxes

  HWY_INLINE ChildVolumes(const Tree::Node& node, std::size_t i) {
    V on_normal = hn::Zero(k_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      const V lower = load(node.lower[k] + i);
      const V upper = load(node.upper[k] + i);
      center[k] = hn::Mul(set(0.5f), hn::Add(lower, upper));
      half[k] = hn::Mul(set(0.5f), hn::Sub(upper, lower));
      normal[k] = load(node.normal[k] + i);
      on_normal = hn::MulAdd(normal[k], center[k], on_normal);
    }
    slab_lower = load(node.slab_lower + i);
    slab_upper = load(node.slab_upper + i);
    below = hn::Sub(slab_lower, on_normal);
    above = hn::Sub(slab_upper, on_normal);
  }

  /// The largest p . w over the volumes: as reach(), but from the origin.
  HWY_INLINE V greatest_along(const V (&w)[3]) const {
    const V along = dot_fused(w, normal);
    V over_box = hn::Zero(k_lanes);
    V over_rest = hn::Max(hn::Mul(along, slab_lower), hn::Mul(along, slab_upper));
    for (std::size_t k = 0; k < 3; ++k) {
      over_box = hn::MulAdd(w[k], center[k], hn::MulAdd(hn::Abs(w[k]), half[k], over_box));
      const V rest = hn::NegMulAdd(along, normal[k], w[k]);
      over_rest = hn::MulAdd(rest, center[k], hn::MulAdd(hn::Abs(rest), half[k], over_rest));
    }
    return hn::Min(over_box, over_rest);
  }

  /// @param along normal . x
  HWY_INLINE Reach reach(const V (&x)[3], V along) const {
    V box = hn::Zero(k_lanes);
    V rest = hn::Zero(k_lanes);
    for (std::size_t k = 0; k < 3; ++k) {
      box = hn::MulAdd(hn::Abs(x[k]), half[k], box);
      rest = hn::MulAdd(hn::Abs(hn::NegMulAdd(along, normal[k], x[k])), half[k], rest);
    }
    return {box, rest, along, below, above};
  }
};

/// Lower bounds on the distances of the children of `node` from `fixed`; negative where they may overlap. Returns a bit
/// for each child whose bound is not above `best`.
HWY_INLINE std::uint32_t bound_children(const Tree::Node& node, const FixedVolume& fixed, const Frame& f,
                                        const Slack& slack, float best, float* HWY_RESTRICT bounds) {
  std::uint32_t kept = 0;
  const V w[3] = {set(f.direction[0]), set(f.direction[1]), set(f.direction[2])};
  const V normal_fixed[3] = {set(fixed.normal[0]), set(fixed.normal[1]), set(fixed.normal[2])};
  const V least_along =
      set(static_cast<float>(static_cast<double>(fixed.least_along) + f.translation_along) - slack.local);
  const auto all_exceed_best = [&](V bound) { return hn::AllTrue(k_lanes, hn::Gt(bound, set(best))); };
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    const ChildVolumes child(node, i);
    const V gap_along = hn::Sub(least_along, child.greatest_along(w));
    if (all_exceed_best(gap_along)) continue;

    // Boxes. m: from the children's centres to the fixed volume's.
    V m[3];
    V gap = set(-Tree::k_empty);
    V squared_n = hn::Zero(k_lanes), squared_f = hn::Zero(k_lanes);  // of the distances of the boxes
    const auto keep = [&gap](V along_axis, V& squared_distance) {
      gap = hn::Max(gap, along_axis);
      const V positive = hn::Max(along_axis, hn::Zero(k_lanes));
      squared_distance = hn::MulAdd(positive, positive, squared_distance);
    };
    for (std::size_t k = 0; k < 3; ++k) {
      m[k] = hn::Sub(set(fixed.center[k]), child.center[k]);
      keep(hn::Sub(hn::Abs(m[k]), hn::Add(child.half[k], set(fixed.half[k]))), squared_n);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      V middle = hn::Zero(k_lanes);
      V extent = set(fixed.half_fixed[k]);
      for (std::size_t j = 0; j < 3; ++j) {
        const V r = set(f.rotation[j][k]);
        middle = hn::MulAdd(r, m[j], middle);
        extent = hn::MulAdd(hn::Abs(r), child.half[j], extent);
      }
      keep(hn::Sub(hn::Abs(middle), extent), squared_f);
    }
    gap = hn::IfThenElse(hn::Gt(gap, hn::Zero(k_lanes)), hn::Sqrt(hn::Max(squared_n, squared_f)), gap);

    // The line through the centres.
    const V squared = dot_fused(m, m);
    const V inverse = hn::Div(set(1.0f), hn::Sqrt(hn::Max(squared, set(k_smallest_square))));
    const V u[3] = {hn::Mul(m[0], inverse), hn::Mul(m[1], inverse), hn::Mul(m[2], inverse)};
    const Reach own = child.reach(u, dot_fused(u, child.normal)), other = fixed.reach(u, dot_fused(u, normal_fixed));
    gap = hn::Max(gap, hn::Sub(hn::Mul(squared, inverse), hn::Add(own.up, other.down)));
    if (all_exceed_best(hn::Max(gap_along, hn::Sub(gap, set(slack.all))))) continue;

    // Normals of the slabs.
    const V normals = dot_fused(normal_fixed, child.normal);
    const V on_child = dot_fused(child.normal, m);
    const V on_fixed = dot_fused(normal_fixed, m);
    const Reach of_fixed = fixed.reach(child.normal, normals);
    const Reach of_child = child.reach(normal_fixed, normals);
    gap = hn::Max(gap, hn::Sub(hn::Sub(on_child, of_fixed.down), child.above));
    gap = hn::Max(gap, hn::Sub(child.below, hn::Add(on_child, of_fixed.up)));
    gap = hn::Max(gap, hn::Sub(hn::Add(on_fixed, set(fixed.slab_lower)), of_child.up));
    gap = hn::Max(gap, hn::Sub(hn::Neg(hn::Add(on_fixed, set(fixed.slab_upper))), of_child.down));

    const V bound = hn::Max(gap_along, hn::Sub(gap, set(slack.all)));
    hn::Store(bound, k_lanes, bounds + i);
    kept |= bits_of(hn::Le(bound, set(best)), i);
  }
  return kept & ((1u << node.child_count) - 1);
}

/// Raises bounds of bound_children() by the axes across an axis of N and one of F. Returns a bit for each child of
/// `kept` whose bound is still not above `best`. Bounds that stay negative are not changed: they say how deep volumes
/// overlap, which orders the search, and compare with those of pairs that are not asked.
/// @param axes, axes_fixed CrossAxes in N and in F
inline HWY_NOINLINE std::uint32_t bound_across_axes(const Tree::Node& node, const FixedVolume& fixed,
                                                    const float (&axes)[CrossAxes::k_count][3],
                                                    const float (&axes_fixed)[CrossAxes::k_count][3],
                                                    const Slack& slack, float best, std::uint32_t kept,
                                                    float* HWY_RESTRICT bounds) {
  const V half = set(0.5f);
  std::uint32_t near = 0;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    V m[3], e[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const V lower = load(node.lower[k] + i);
      const V upper = load(node.upper[k] + i);
      m[k] = hn::NegMulAdd(half, hn::Add(lower, upper), set(fixed.center[k]));
      e[k] = hn::Mul(half, hn::Sub(upper, lower));
    }
    V widest = set(-Tree::k_empty);
    for (std::size_t n = 0; n < CrossAxes::k_count; ++n) {
      float radius_fixed = 0.0f;
      for (std::size_t k = 0; k < 3; ++k) radius_fixed += std::abs(axes_fixed[n][k]) * fixed.half_fixed[k];
      V middle = hn::Zero(k_lanes);
      V radius = set(radius_fixed);
      for (std::size_t k = 0; k < 3; ++k) {
        middle = hn::MulAdd(set(axes[n][k]), m[k], middle);
        radius = hn::MulAdd(set(std::abs(axes[n][k])), e[k], radius);
      }
      widest = hn::Max(widest, hn::Sub(hn::Abs(middle), radius));
    }
    const V before = load(bounds + i);
    const V across = hn::Sub(widest, set(slack.all));
    const V bound = hn::IfThenElse(hn::Gt(across, hn::Zero(k_lanes)), hn::Max(before, across), before);
    hn::Store(bound, k_lanes, bounds + i);
    near |= bits_of(hn::Le(bound, set(best)), i);
  }
  return kept & near;
}

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
  namespace fw = frank_wolfe;
  constexpr auto k_fused = fw::Rounding::fused;
  constexpr int k_steps = 5;
  const V goal = set(enough);
  for (std::size_t i = 0; i < LeafPair::k_pairs; i += hn::Lanes(k_lanes)) {
    const auto at = [i](const float* p) { return load(p + i); };
    V lower = at(pairs.lower);
    if (hn::AllTrue(k_lanes, hn::Gt(lower, goal))) {
      hn::Store(set(Tree::k_empty), k_lanes, pairs.upper + i);
      continue;
    }
    V x[3];  // a difference b - a of points of the triangles: first of the centroids, then ever shorter
    for (std::size_t k = 0; k < 3; ++k) {
      const V p = hn::Add(hn::Add(at(pairs.a[0][k]), at(pairs.a[1][k])), at(pairs.a[2][k]));
      const V q = hn::Add(hn::Add(at(pairs.b[0][k]), at(pairs.b[1][k])), at(pairs.b[2][k]));
      x[k] = hn::Mul(set(1.0f / 3.0f), hn::Sub(q, p));
    }
    V length;
    for (int step = 0;; ++step) {
      const auto of_a = fw::support<k_fused, fw::Extreme::greatest>(x, pairs.a, i);
      const auto of_b = fw::support<k_fused, fw::Extreme::least>(x, pairs.b, i);
      length = fw::length<k_fused>(x);
      lower = hn::Max(lower, hn::Sub(hn::Div(hn::Sub(of_b.value, of_a.value), length), set(slack)));
      if (step == k_steps || hn::AllTrue(k_lanes, hn::Gt(lower, goal))) break;
      const V s[3] = {hn::Sub(of_b.point[0], of_a.point[0]), hn::Sub(of_b.point[1], of_a.point[1]),
                      hn::Sub(of_b.point[2], of_a.point[2])};
      fw::step<k_fused>(x, s);
    }
    hn::Store(lower, k_lanes, pairs.lower + i);
    hn::Store(length, k_lanes, pairs.upper + i);
  }
}

/// Raises the lower bounds that are not above `enough` by the nine axes across an edge of each triangle. Needles that
/// cross have their distance along one of them, which Frank-Wolfe steps approach slowly.
inline HWY_NOINLINE void bound_across_edges(LeafPair& pairs, float slack, float enough) {
  namespace fw = frank_wolfe;
  constexpr auto k_fused = fw::Rounding::fused;
  const V goal = set(enough);
  for (std::size_t i = 0; i < LeafPair::k_pairs; i += hn::Lanes(k_lanes)) {
    V lower = load(pairs.lower + i);
    for (std::size_t edge = 0; edge < 9 && !hn::AllTrue(k_lanes, hn::Gt(lower, goal)); ++edge) {
      V u[3], v[3];
      for (std::size_t k = 0; k < 3; ++k) {
        u[k] = hn::Sub(load(pairs.a[(edge + 1) % 3][k] + i), load(pairs.a[edge % 3][k] + i));
        v[k] = hn::Sub(load(pairs.b[(edge / 3 + 1) % 3][k] + i), load(pairs.b[edge / 3][k] + i));
      }
      V n[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
        n[k] = hn::NegMulAdd(u[m], v[l], hn::Mul(u[l], v[m]));
      }
      const auto value = [](const auto& support) { return support.value; };
      const V most_a = value(fw::support<k_fused, fw::Extreme::greatest>(n, pairs.a, i));
      const V least_a = value(fw::support<k_fused, fw::Extreme::least>(n, pairs.a, i));
      const V most_b = value(fw::support<k_fused, fw::Extreme::greatest>(n, pairs.b, i));
      const V least_b = value(fw::support<k_fused, fw::Extreme::least>(n, pairs.b, i));
      const V gap = hn::Max(hn::Sub(least_b, most_a), hn::Sub(least_a, most_b));
      lower = hn::Max(lower, hn::Sub(hn::Div(gap, fw::length<k_fused>(n)), set(slack)));
    }
    hn::Store(lower, k_lanes, pairs.lower + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::detail
HWY_AFTER_NAMESPACE();
