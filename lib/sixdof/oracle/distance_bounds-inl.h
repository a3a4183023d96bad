// Part of distance_search.cpp, which includes it once per instruction set: it has no include guard.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include <hwy/highway.h>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/proximity/cross_axes.h>
#include <sixdof/proximity/expansion-inl.h>
#include <sixdof/proximity/frames.h>
#include <sixdof/proximity/leaf_pairs-inl.h>
#include <sixdof/proximity/volumes-inl.h>

// Lower bounds on distances: of volumes of two trees (volumes-inl.h), and of the triangles of two leaves.
//
// Bounds are floats; Slack lowers them by more than their rounding, so they are bounds on every instruction set. The
// answer does not depend on which bounds were computed: it is the smallest of triangle_triangle_distance() over all
// pairs.

HWY_BEFORE_NAMESPACE();
namespace sixdof::detail {
namespace HWY_NAMESPACE {

using namespace volumes::HWY_NAMESPACE;
using namespace leaf_pairs::HWY_NAMESPACE;

constexpr Rounding k_rounding = Rounding::fused;

/// By how much a bound is lowered (lengths).
struct Slack {
  float local;  // where only coordinates relative to the centres enter
  float all;    // where the translation enters as well

  Slack(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& shift) {
    const double sizes = a.radius() + b.radius();
    // Rounding of the doubles, which matters where poses or vertices are far from the origins.
    const double offsets = 1e-14 * (a.center().norm() + b.center().norm() + X_AB.t.norm());
    local = static_cast<float>(k_slack * sizes + offsets);
    all = static_cast<float>(k_slack * (sizes + shift.norm()) + offsets);
  }
};

/// The pose of one query.
struct QueryFrames : Frames {
  Slack slack;

  QueryFrames(const Tree& tree_a, const Tree& tree_b, const Pose& X_AB)
      : Frames(X_AB.R), slack(tree_a, tree_b, X_AB, X_AB * tree_b.center() - tree_a.center()) {
    set_shift(X_AB * tree_b.center() - tree_a.center());
  }

  /// Sets w to the direction from A to B given by a vector of any length in A's frame.
  void set_direction(const Eigen::Vector3d& direction) {
    const double length = direction.norm();
    Frames::set_direction(length > 0.0 ? Eigen::Vector3d(direction / length) : Eigen::Vector3d::UnitX());
  }
};

/// Lower bounds on the distances of the volumes x from volume j of y; negative where they may overlap. Returns a bit
/// for each whose bound is not above `best`.
/// @param f whose N is the frame of x
HWY_INLINE std::uint32_t bound_volumes(const Volumes& x, const Volumes& y, std::size_t j, const Frame& f,
                                       double shift_along, const Slack& slack, float best, float* HWY_RESTRICT bounds) {
  std::uint32_t kept = 0;
  const V y_along = set(static_cast<float>(shift_along - static_cast<double>(y.front[j])) - slack.local);
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    const VolumePairs<k_rounding> pairs{x, y, i, j};
    const V gap_along = hn::Sub(y_along, load(x.front + i));  // w
    V gap = set(-Tree::k_empty);
    const auto bound = [&] { return hn::Max(gap_along, hn::Sub(gap, set(slack.all))); };
    const auto all_exceed_best = [&] { return hn::AllTrue(k_lanes, hn::Gt(bound(), set(best))); };
    if (all_exceed_best()) continue;

    V offset[3];
    V squared_x = hn::Zero(k_lanes), squared_y = hn::Zero(k_lanes);  // of the distances of the boxes
    const auto keep = [&gap](V along_axis, V& squared_distance) {
      gap = hn::Max(gap, along_axis);
      const V positive = hn::Max(along_axis, hn::Zero(k_lanes));
      squared_distance = hn::MulAdd(positive, positive, squared_distance);
    };
    for (std::size_t k = 0; k < 3; ++k) {
      offset[k] = pairs.offset_in_x(k);
      keep(hn::Sub(hn::Abs(offset[k]), pairs.extent_in_x(k)), squared_x);
      keep(hn::Sub(hn::Abs(pairs.offset_in_y(k)), pairs.extent_in_y(k)), squared_y);
    }
    gap = hn::IfThenElse(hn::Gt(gap, hn::Zero(k_lanes)), hn::Sqrt(hn::Max(squared_x, squared_y)), gap);
    if (all_exceed_best()) continue;

    const V squared = dot<k_rounding>(offset, offset);
    const V inverse = hn::Div(set(1.0f), hn::Sqrt(hn::Max(squared, set(k_smallest_square))));
    const V line[3] = {hn::Mul(offset[0], inverse), hn::Mul(offset[1], inverse), hn::Mul(offset[2], inverse)};
    gap = hn::Max(gap, hn::Sub(hn::Mul(squared, inverse), pairs.reach_along(line, f)));
    if (all_exceed_best()) continue;

    const auto normals = pairs.along_normals(offset);
    gap = hn::Max(gap, hn::Max(normals.of_x.gap(), normals.of_y.gap()));
    hn::Store(bound(), k_lanes, bounds + i);
    kept |= bits_of(hn::Le(bound(), set(best)), i);
  }
  return kept;
}

/// Volumes of y (bits) that neither w nor boxes separate from all volumes of x by more than `best`.
/// @param whole around the volumes of x
HWY_INLINE std::uint32_t near_volumes(const Volumes& x, const Tree::Volume& whole, const Volumes& y, double shift_along,
                                      const Slack& slack, float best) {
  constexpr float k_still[3] = {};
  V front = set(-Tree::k_empty);
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) front = hn::Max(front, load(x.front + i));
  const auto front_x = static_cast<double>(hn::GetLane(hn::MaxOfLanes(k_lanes, front)));
  const V along = set(static_cast<float>(shift_along - front_x) - slack.all);
  std::uint32_t near = near_boxes<k_rounding>(whole, y, best + slack.all, k_still);
  for (std::size_t j = 0; j < k_width; j += hn::Lanes(k_lanes)) {
    near &= ~bits_of(hn::Gt(hn::Sub(along, load(y.front + j)), set(best)), j);
  }
  return near;
}

/// Raises bounds of bound_volumes() by the axes across an axis of each frame. Returns a bit for each volume of `kept`
/// whose bound is still not above `best`. Bounds that stay negative are not changed: they say how deep volumes overlap,
/// which orders the search, and compare with those of pairs that are not asked.
/// @param axes_x, axes_y CrossAxes in both frames
inline HWY_NOINLINE std::uint32_t bound_across_axes(const Volumes& x, const Volumes& y, std::size_t j,
                                                    const float (&axes_x)[CrossAxes::k_count][3],
                                                    const float (&axes_y)[CrossAxes::k_count][3], const Slack& slack,
                                                    float best, std::uint32_t kept, float* HWY_RESTRICT bounds) {
  constexpr float k_still[3] = {};
  std::uint32_t near = 0;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    const V gap = VolumePairs<k_rounding>{x, y, i, j}.gap_across_axes(axes_x, axes_y, k_still);
    const V before = load(bounds + i);
    const V across = hn::Sub(gap, set(slack.all));
    const V bound = hn::IfThenElse(hn::Gt(across, hn::Zero(k_lanes)), hn::Max(before, across), before);
    hn::Store(bound, k_lanes, bounds + i);
    near |= bits_of(hn::Le(bound, set(best)), i);
  }
  return kept & near;
}

/// The shortest difference b - a of points of two triangles found so far, one pair of triangles per lane.
struct Shortest {
  V x[3];
  V squared;

  HWY_INLINE Shortest() : x{hn::Zero(k_lanes), hn::Zero(k_lanes), hn::Zero(k_lanes)}, squared(set(Tree::k_empty)) {}

  HWY_INLINE void update(const V (&other)[3], M valid) {
    const V d = dot<k_rounding>(other, other);
    const M shorter = hn::And(valid, hn::Lt(d, squared));
    squared = hn::IfThenElse(shorter, d, squared);
    for (std::size_t k = 0; k < 3; ++k) x[k] = hn::IfThenElse(shorter, other[k], x[k]);
  }
};

/// Corners, [corner][axis].
using Triangles = V[3][3];

HWY_INLINE void subtract(const V (&p)[3], const V (&q)[3], V (&difference)[3]) {
  for (std::size_t k = 0; k < 3; ++k) difference[k] = hn::Sub(p[k], q[k]);
}
HWY_INLINE V clamp(V x) { return hn::Min(hn::Max(x, hn::Zero(k_lanes)), set(1.0f)); }
HWY_INLINE V inverse_of(V x) { return hn::Div(set(1.0f), hn::Max(x, set(k_smallest_square))); }

/// From faces to the corners of the other triangles above them.
/// @param sign 1 for faces of A, -1 for those of B
HWY_INLINE void update_above_faces(const Triangles& face, const Triangles& corners, float sign, Shortest& shortest) {
  V u[3], v[3], p[3], d[3];
  subtract(face[1], face[0], u);
  subtract(face[2], face[0], v);
  const V uu = dot<k_rounding>(u, u), uv = dot<k_rounding>(u, v), vv = dot<k_rounding>(v, v);
  const V whole = hn::NegMulAdd(uv, uv, hn::Mul(uu, vv)), inverse = inverse_of(whole);
  for (const V(&corner)[3] : corners) {
    subtract(corner, face[0], p);
    const V on_u = dot<k_rounding>(p, u), on_v = dot<k_rounding>(p, v);
    // The foot s u + t v is a point of the face whatever the rounding: the length is an upper bound.
    const V s = hn::NegMulAdd(uv, on_v, hn::Mul(vv, on_u)), t = hn::NegMulAdd(uv, on_u, hn::Mul(uu, on_v));
    const M is_above = hn::And(hn::Gt(hn::Min(s, t), hn::Zero(k_lanes)), hn::Lt(hn::Add(s, t), whole));
    for (std::size_t k = 0; k < 3; ++k) {
      const V foot = hn::MulAdd(hn::Mul(s, inverse), u[k], hn::Mul(hn::Mul(t, inverse), v[k]));
      d[k] = hn::Mul(set(sign), hn::Sub(p[k], foot));
    }
    shortest.update(d, is_above);
  }
}

/// Between all edges. (C. Ericson, "Real-Time Collision Detection", 2005, 5.1.9.)
HWY_INLINE void update_between_edges(const Triangles& a, const Triangles& b, Shortest& shortest) {
  constexpr float k_parallel = 1e-6f;  // square of a sine; raised to this, nothing is divided by zero
  const M all = hn::Ge(shortest.squared, hn::Zero(k_lanes));
  V v[3][3], inverse_vv[3];
  for (std::size_t j = 0; j < 3; ++j) {
    subtract(b[(j + 1) % 3], b[j], v[j]);
    inverse_vv[j] = inverse_of(dot<k_rounding>(v[j], v[j]));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    V u[3], r[3], d[3];
    subtract(a[(i + 1) % 3], a[i], u);
    const V uu = dot<k_rounding>(u, u), inverse_uu = inverse_of(uu);
    for (std::size_t j = 0; j < 3; ++j) {
      // r + t v - s u: shortest on both lines, then with t and with s on the edges.
      subtract(b[j], a[i], r);
      const V ur = dot<k_rounding>(u, r), vr = dot<k_rounding>(v[j], r), uv = dot<k_rounding>(u, v[j]);
      const V along = hn::Mul(uv, inverse_vv[j]);
      const V across = hn::Max(hn::NegMulAdd(along, uv, uu), hn::MulAdd(set(k_parallel), uu, set(k_smallest_square)));
      const V on_line = clamp(hn::Div(hn::NegMulAdd(along, vr, ur), across));
      const V t = clamp(hn::Mul(hn::MulSub(on_line, uv, vr), inverse_vv[j]));
      const V s = clamp(hn::Mul(hn::MulAdd(t, uv, ur), inverse_uu));
      for (std::size_t k = 0; k < 3; ++k) d[k] = hn::NegMulAdd(s, u[k], hn::MulAdd(t, v[j][k], r[k]));
      shortest.update(d, all);
    }
  }
}

/// Of lanes i, i + 1, ...; longer by rounding or, where triangles intersect, of any length.
HWY_INLINE void shortest_difference(const LeafPair& pairs, std::size_t i, V (&x)[3]) {
  Triangles a, b;
  const V origin[3] = {load(pairs.a[0][0] + i), load(pairs.a[0][1] + i), load(pairs.a[0][2] + i)};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < 3; ++k) {
      a[c][k] = hn::Sub(load(pairs.a[c][k] + i), origin[k]);
      b[c][k] = hn::Sub(load(pairs.b[c][k] + i), origin[k]);
    }
  }
  Shortest shortest;
  update_between_edges(a, b, shortest);
  update_above_faces(a, b, 1.0f, shortest);
  update_above_faces(b, a, -1.0f, shortest);
  for (std::size_t k = 0; k < 3; ++k) x[k] = shortest.x[k];
}

/// Lower bounds on the distances of pairs of triangles, as take_steps() raises them.
struct TriangleBounds {
  const V enough, slack;
  V lower, length;  ///< Length: of the last difference.

  HWY_INLINE bool is_enough() const { return hn::AllTrue(k_lanes, hn::Gt(lower, enough)); }
  HWY_INLINE void shift(V (&)[3]) const {}
  HWY_INLINE void keep(V value, const V (&x)[3]) {
    length = frank_wolfe::length<k_rounding>(x);
    lower = hn::Max(lower, hn::Sub(hn::Div(value, length), slack));
  }
};

/// Raises the lower bounds until they are above `enough` or as good as floats are: first by Frank-Wolfe steps, then
/// along the shortest difference of points of both triangles, whose length is the upper bound.
HWY_INLINE void bound_triangles(LeafPair& pairs, float slack, float enough, float (&difference)[3][k_pairs]) {
  constexpr int k_steps = 2;
  for (std::size_t i = 0; i < k_pairs; i += hn::Lanes(k_lanes)) {
    TriangleBounds bounds{set(enough), set(slack), load(pairs.lower + i), set(Tree::k_empty)};
    V x[3] = {hn::Zero(k_lanes), hn::Zero(k_lanes), hn::Zero(k_lanes)};
    if (!bounds.is_enough()) take_steps<k_rounding, k_steps>(pairs, i, bounds, x);
    if (!bounds.is_enough()) {
      shortest_difference(pairs, i, x);
      bounds.keep(Projections::along<k_rounding>(x, pairs, i).low, x);
    }
    hn::Store(bounds.lower, k_lanes, pairs.lower + i);
    hn::Store(bounds.length, k_lanes, pairs.upper + i);
    for (std::size_t k = 0; k < 3; ++k) hn::Store(x[k], k_lanes, difference[k] + i);
  }
}

/// Raises the lower bounds that are not above `enough` by the nine axes across an edge of each triangle. Of needles
/// that cross, the shortest difference is short next to the needles: rounding turns it away from such an axis.
inline HWY_NOINLINE void bound_across_edges(LeafPair& pairs, float slack, float enough) {
  for (std::size_t i = 0; i < k_pairs; i += hn::Lanes(k_lanes)) {
    TriangleBounds bounds{set(enough), set(slack), load(pairs.lower + i), set(Tree::k_empty)};
    for (std::size_t edge = 0; edge < 9 && !bounds.is_enough(); ++edge) {
      V u[3], v[3], n[3];
      for (std::size_t k = 0; k < 3; ++k) {
        u[k] = hn::Sub(load(pairs.a[(edge + 1) % 3][k] + i), load(pairs.a[edge % 3][k] + i));
        v[k] = hn::Sub(load(pairs.b[(edge / 3 + 1) % 3][k] + i), load(pairs.b[edge / 3][k] + i));
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
        n[k] = hn::NegMulAdd(u[m], v[l], hn::Mul(u[l], v[m]));
      }
      const Projections range = Projections::along<k_rounding>(n, pairs, i);
      bounds.keep(hn::Max(range.low, hn::Neg(range.high)), n);
    }
    hn::Store(bounds.lower, k_lanes, pairs.lower + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::detail
HWY_AFTER_NAMESPACE();
