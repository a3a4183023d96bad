// Part of ray_cast_search.cpp, which includes it once per instruction set: it has no include guard.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/oracle/ray_cast_search.h>
#include <sixdof/proximity/expansion-inl.h>
#include <sixdof/proximity/frames.h>
#include <sixdof/proximity/leaf_pairs-inl.h>
#include <sixdof/proximity/volumes-inl.h>

// Separating-axis bounds for volumes of one tree, x, against a volume of the other, y, one of x per SIMD lane, and for
// the triangles of two leaves. Notation: see ray_cast_search.h, and volumes-inl.h for volumes and axes. For a unit
// vector n from A to B, the gap along n at t0 = ray.translation is a lower bound on the distance there, and n . u is
// its slope. Where the gap exceeds the target and the slope is not negative, the pair is farther apart than the target
// at t0 and at every larger t. No ray parameter is divided by n . u, so grazing rays are no special case.
//
// The axes are those of volumes-inl.h but for the nine across, each with the sign for which its slope is not negative.
// w is the axis of the best hit. Where the centres of two volumes come nearer as t grows beyond t0, the line through
// them and the axis between their boxes are those at the t where they are nearest, t0 + `later`, and the gap there is
// lowered by later times the slope, to t0.
//
// Nothing here uses fused multiply-add, and all operations (+ - * / sqrt min max) are rounded by IEEE rules lane by
// lane. So which pairs are expanded, and in what order, is the same on every instruction set.

HWY_BEFORE_NAMESPACE();
namespace sixdof::ray_cast {
namespace HWY_NAMESPACE {

using namespace volumes::HWY_NAMESPACE;
using namespace leaf_pairs::HWY_NAMESPACE;

constexpr Rounding k_rounding = Rounding::unfused;

/// Length of axes. They are shorter than unit vectors by more than their rounding, so that a gap along them never
/// exceeds the distance.
constexpr double k_axis_length = 1.0 - 4e-7;

/// The ray in single precision.
struct Ray {
  /// How y moves against x as t grows, in the frames of x and of y.
  struct Velocity {
    float in_x[3];
    float in_y[3];
  };

  Frames frames;  ///< At t0; w is k_axis_length long.
  Velocity of_b;  ///< x = A
  Velocity of_a;  ///< x = B
  float target;
  /// What gaps are lowered by, k_slack of Cast::size(). Lengths that enter a bound are at most twice that size, but
  /// most roundings are of volumes, which are smaller: with the rounding of slopes, up to eight, times a translation of
  /// at most that size, and that of a bound from where it is made to where it is read they come to three quarters of
  /// the slack.
  float slack;
  float translation;  ///< Of the best hit: t0.
  float reach;        ///< Cast::reach()
  float axis_slope;   ///< w . u

  explicit Ray(const Cast& cast)
      : frames(cast.R),
        target(static_cast<float>(cast.target)),
        slack(static_cast<float>(static_cast<double>(k_slack) * cast.size())),
        reach(static_cast<float>(cast.reach())) {
    const Eigen::Vector3d in_b = cast.R.transpose() * cast.direction;
    for (int k = 0; k < 3; ++k) {
      of_b.in_x[k] = static_cast<float>(cast.direction[k]);
      of_b.in_y[k] = static_cast<float>(in_b[k]);
      of_a.in_x[k] = -of_b.in_y[k];
      of_a.in_y[k] = -of_b.in_x[k];
    }
    set_best(cast);
  }

  void set_best(const Cast& cast) {
    frames.set_shift(cast.offset + cast.best.translation * cast.direction);
    frames.set_direction(k_axis_length * cast.best.axis);
    translation = static_cast<float>(cast.best.translation);
    axis_slope = static_cast<float>(k_axis_length * cast.best.axis.dot(cast.direction));
  }
};

/// The largest gaps so far, one per lane, and their slopes.
struct Gaps {
  const Ray& ray;
  const V u[3];    ///< How y moves against x, in x's frame.
  const V enough;  ///< A gap above this is not replaced.
  V gap, slope;

  /// Takes the gap along an axis n at t0, and n . u. Where that is below 0 the gap is what is left at the largest t.
  HWY_INLINE void keep(V along_axis, V rate) {
    const V zero = hn::Zero(k_lanes);
    const V least = hn::Add(hn::Sub(along_axis, set(ray.slack)), hn::Mul(set(ray.reach), hn::Min(rate, zero)));
    const M better = hn::And(hn::Le(gap, enough), hn::Gt(least, gap));
    slope = hn::IfThenElse(better, hn::Max(rate, zero), slope);
    gap = hn::IfThenElse(better, least, gap);
  }
};

/// Estimates when a pair is hit; the search takes the smallest value first. The value is minus the largest t - t0 at
/// which the distance of the centres is the target. Where the centres never come that close, it is computed at their
/// closest approach, and increased by the closest distance minus the target.
/// @param squared of the distance in which the centres pass each other
/// @param along from the centre of x to that of y, along the ray
HWY_INLINE V order_of(V squared, V along, float target) {
  const V zero = hn::Zero(k_lanes);
  const V before = hn::Sqrt(hn::Max(hn::Sub(set(target * target), squared), zero));
  const V aside = hn::Max(hn::Sub(hn::Sqrt(hn::Max(squared, zero)), set(target)), zero);
  return hn::Add(hn::Sub(along, before), aside);
}

/// Takes the axes other than w.
/// @param f whose N is the frame of x
/// @param in_y how y moves, in y's frame
/// @param order set to order_of()
HWY_INLINE void bound_closely(const VolumePairs<k_rounding>& pairs, const Frame& f, const float (&in_y)[3], Gaps& best,
                              float* HWY_RESTRICT order) {
  const V zero = hn::Zero(k_lanes);
  const auto& u = best.u;
  const V m[3] = {pairs.offset_in_x(0), pairs.offset_in_x(1), pairs.offset_in_x(2)};  // at t0
  const V along = dot(m, u);
  hn::Store(order_of(hn::Sub(dot(m, m), hn::Mul(along, along)), along, best.ray.target), k_lanes, order + pairs.i);
  const V later = hn::Max(hn::Neg(along), zero);
  V near[3];
  for (std::size_t k = 0; k < 3; ++k) near[k] = unfused_mul_add(later, u[k], m[k]);
  const auto keep_later = [&](V gap, V rate) { best.keep(unfused_sub_mul(gap, later, rate), rate); };
  {  // The line through the centres.
    const V squared = dot(near, near);
    const V inverse =
        hn::Div(set(static_cast<float>(k_axis_length)), hn::Sqrt(hn::Max(squared, set(k_smallest_square))));
    const V n[3] = {hn::Mul(near[0], inverse), hn::Mul(near[1], inverse), hn::Mul(near[2], inverse)};
    keep_later(hn::Sub(hn::Mul(squared, inverse), pairs.reach_along(n, f)), dot(n, u));
  }
  struct Between {  // boxes: the square of their distance, and the rate times the distance
    V squared, rate;
    HWY_INLINE void add_axis(V offset, V extent, V along_axis) {
      const V apart = hn::Max(hn::Sub(hn::Abs(offset), extent), hn::Zero(k_lanes));
      squared = unfused_mul_add(apart, apart, squared);
      rate = unfused_mul_add(hn::CopySign(apart, offset), along_axis, rate);
    }
  } in_frame_x{zero, zero}, in_frame_y{zero, zero};
  for (std::size_t k = 0; k < 3; ++k) {
    const V u_y = set(in_y[k]);
    in_frame_x.add_axis(near[k], pairs.extent_in_x(k), u[k]);
    in_frame_y.add_axis(unfused_mul_add(later, u_y, pairs.offset_in_y(k)), pairs.extent_in_y(k), u_y);
  }
  for (const Between* boxes : {&in_frame_x, &in_frame_y}) {
    const V length = hn::Sqrt(hn::Max(boxes->squared, set(k_smallest_square)));
    keep_later(length, hn::Div(boxes->rate, length));
  }
  const auto normals = pairs.along_normals(m);
  const auto keep_normal = [&](const AxisRange& range, V rate) {
    best.keep(hn::IfThenElse(hn::Lt(rate, zero), hn::Neg(range.high), range.low), hn::Abs(rate));
  };
  V rate_of_x = zero, rate_of_y = zero;
  for (std::size_t k = 0; k < 3; ++k) {
    rate_of_x = unfused_mul_add(load(pairs.x.normal[k] + pairs.i), u[k], rate_of_x);
    rate_of_y = unfused_mul_add(set(pairs.y.other_normal[k][pairs.j]), u[k], rate_of_y);
  }
  keep_normal(normals.of_x, rate_of_x);
  keep_normal(normals.of_y, rate_of_y);
}

/// What bounds say about the volumes of x.
struct VolumeBounds {
  HWY_ALIGN float gap[k_width];
  HWY_ALIGN float slope[k_width];
  HWY_ALIGN float order[k_width];  ///< order_of(), of volumes that w does not cull.
};

/// Sets gap and slope of each volume x against volume j of y along the best of the axes.
/// @param x_is_a whether x is of tree A
HWY_INLINE void bound_volumes(const Volumes& x, const Volumes& y, std::size_t j, bool x_is_a, const Ray& ray,
                              VolumeBounds& bounds) {
  const V along = set(static_cast<float>(ray.frames.shift_along - static_cast<double>(y.front[j])) - ray.slack);
  // If w culls all, whatever the number of lanes, the others are not tried.
  bool all = true;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    const V gap = hn::Sub(along, load(x.front + i));
    hn::Store(gap, k_lanes, bounds.gap + i);
    hn::Store(set(ray.axis_slope), k_lanes, bounds.slope + i);
    all = all && hn::AllTrue(k_lanes, hn::Gt(gap, set(ray.target)));
  }
  if (all) return;
  const Ray::Velocity& v = x_is_a ? ray.of_b : ray.of_a;
  for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
    Gaps best{ray,
              {set(v.in_x[0]), set(v.in_x[1]), set(v.in_x[2])},
              set(Tree::k_empty),
              load(bounds.gap + i),
              load(bounds.slope + i)};
    bound_closely({x, y, i, j}, x_is_a ? ray.frames.a : ray.frames.b, v.in_y, best, bounds.order);
    hn::Store(best.gap, k_lanes, bounds.gap + i);
    hn::Store(best.slope, k_lanes, bounds.slope + i);
  }
}

/// The triangles of two leaves. LeafPair::lower holds their gaps.
struct CastLeafPair : LeafPair {
  HWY_ALIGN float slopes[k_pairs];
};

/// Gaps of pairs of triangles, as take_steps() takes them.
struct TriangleGaps : Gaps {
  V forward;  ///< By how much shift() moved x last.

  TriangleGaps(const Ray& from, V along_w)
      : Gaps{from,
             {set(from.of_b.in_x[0]), set(from.of_b.in_x[1]), set(from.of_b.in_x[2])},
             set(from.target),
             along_w,
             set(from.axis_slope)},
        forward(hn::Zero(k_lanes)) {}

  HWY_INLINE M are_near() const { return hn::Le(gap, enough); }
  HWY_INLINE bool is_enough() const { return hn::AllFalse(k_lanes, are_near()); }

  /// To the point of x + {t u, t >= 0} that is nearest to the origin.
  HWY_INLINE void shift(V (&x)[3]) {
    forward = hn::Max(hn::Neg(dot(x, u)), hn::Zero(k_lanes));
    for (std::size_t k = 0; k < 3; ++k) x[k] = unfused_mul_add(forward, u[k], x[k]);
  }

  using Gaps::keep;
  HWY_INLINE void keep(V value, const V (&x)[3]) {
    const V length = frank_wolfe::length<k_rounding>(x);
    keep(hn::Div(value, length), hn::Div(dot(x, u), length));
  }

  /// Takes the cross products of the ray and each edge. Triangles that pass each other, seen along the ray, are
  /// separated along one of them, unless their nearest points are corners.
  HWY_INLINE void keep_across_ray(const LeafPair& pairs, std::size_t i) {
    for (const auto* corners : {pairs.a, pairs.b}) {
      for (std::size_t edge = 0; edge < 3; ++edge) {
        V e[3], n[3];
        for (std::size_t k = 0; k < 3; ++k) {
          e[k] = hn::Sub(load(corners[(edge + 1) % 3][k] + i), load(corners[edge][k] + i));
        }
        for (std::size_t k = 0; k < 3; ++k) {
          const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
          n[k] = unfused_sub_mul(hn::Mul(e[l], u[m]), e[m], u[l]);
        }
        const Projections range = Projections::along<k_rounding>(n, pairs, i);
        const V length = frank_wolfe::length<k_rounding>(n), rate = hn::Div(dot(n, u), length);
        keep(hn::Div(range.low, length), rate);
        keep(hn::Neg(hn::Div(range.high, length)), hn::Neg(rate));
      }
    }
  }
};

/// Raises gaps by Frank-Wolfe steps towards the point of S + {t u, t >= t0} that is nearest to the origin. Where that
/// is one with t > t0 they converge slowly: then axes across the ray are tried at the end.
HWY_INLINE void bound_triangles(CastLeafPair& pairs, const Ray& ray) {
  constexpr int k_steps = 5;
  for (std::size_t i = 0; i < k_pairs; i += hn::Lanes(k_lanes)) {
    TriangleGaps gaps(ray, load(pairs.lower + i));
    V x[3];
    if (!gaps.is_enough()) take_steps<k_rounding, k_steps>(pairs, i, gaps, x);
    const M later = hn::And(gaps.are_near(), hn::Gt(gaps.forward, hn::Zero(k_lanes)));
    TriangleGaps across = gaps;
    if (!hn::AllFalse(k_lanes, later)) across.keep_across_ray(pairs, i);
    // Whatever the number of lanes, a pair has only the axes that it needs.
    hn::Store(hn::IfThenElse(later, across.gap, gaps.gap), k_lanes, pairs.lower + i);
    hn::Store(hn::IfThenElse(later, across.slope, gaps.slope), k_lanes, pairs.slopes + i);
  }
}

/// What bounds say about all pairs of triangles of two leaves.
struct LeafBounds {
  float gap;  ///< Together with the slope a bound for all pairs; CastFront::k_no_bound if one is left.
  float slope;
  std::size_t count = 0;         ///< Pairs that are left,
  std::uint32_t pairs[k_pairs];  ///< 4 i + j each, the smallest gap first.
};

HWY_INLINE LeafBounds bound_leaves(const Tree::Leaf& a, const Tree::Leaf& b, const Ray& ray) {
  LeafBounds result;
  CastLeafPair pairs;
  result.slope = ray.axis_slope;
  result.gap = bound_along_direction<k_rounding>(a, b, ray.frames, ray.slack, ray.target, pairs.lower);
  if (result.gap > ray.target) return result;
  load_pairs<k_rounding>(a, b, ray.frames.a, pairs);
  bound_triangles(pairs, ray);
  const std::uint32_t left = pairs_of(a.child.count(), b.child.count()) & pairs_within(pairs.lower, ray.target);
  result.count = sort_pairs(left, pairs.lower, result.pairs);
  result.gap = CastFront::k_no_bound;
  if (result.count != 0) return result;
  // The line with the least gap and the largest slope bounds all pairs.
  result.gap = CastFront::k_not_in_front;
  for (std::size_t pair = 0; pair < k_pairs; ++pair) {
    result.gap = std::min(result.gap, pairs.lower[pair]);
    result.slope = std::max(result.slope, pairs.slopes[pair]);
  }
  return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ray_cast
HWY_AFTER_NAMESPACE();
