// Part of ray_cast_search.cpp, which includes it once per instruction set: it has no include guard.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/generation/ray_cast_search.h>
#include <sixdof/generation/ray_cast_tree.h>
#include <sixdof/oracle/frames.h>
#include <sixdof/oracle/leaf_pairs-inl.h>
#include <sixdof/oracle/volumes-inl.h>

// Separating-axis bounds for volumes of one tree, x, against a volume of the other, y, one of x per SIMD lane, and for
// the triangles of two leaves. Notation: see ray_cast_search.h, and volumes-inl.h for volumes and axes. For a unit
// vector n from A to B, the gap along n at t0 = ray.translation is a lower bound on the distance there, and n . u is
// its slope. Where the gap exceeds the target and the slope is not negative, the pair is farther apart than the target
// at t0 and at every larger t. No ray parameter is divided by n . u, so grazing rays are no special case.
//
// The axes are those of volumes-inl.h but for the nine across, each with the sign for which its slope is not negative.
// w is the axis of the best hit. Where the centres of two volumes come nearer as t grows beyond t0, the line through
// them and the axis between their boxes are those at the t where they are nearest, t0 + `later`, and the gap there is
// lowered by later times the slope, to t0. At that t the line through the centres has n . u = 0 up to rounding: if
// rounding makes it negative, the gap is lowered by what that takes up to the largest t.
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
      : frames(cast.b.matrix()),
        target(static_cast<float>(cast.target)),
        slack(static_cast<float>(static_cast<double>(k_slack) * cast.size())),
        reach(static_cast<float>(cast.reach())) {
    const Eigen::Vector3d in_b = cast.b.matrix().transpose() * cast.direction;
    for (int k = 0; k < 3; ++k) {
      of_b.in_x[k] = static_cast<float>(cast.direction[k]);
      of_b.in_y[k] = static_cast<float>(in_b[k]);
      of_a.in_x[k] = -of_b.in_y[k];
      of_a.in_y[k] = -of_b.in_x[k];
    }
    set_best(cast);
  }

  void set_best(const Cast& cast) {
    frames.set_shift(cast.best.translation * cast.direction);
    frames.set_direction(k_axis_length * cast.best.axis);
    translation = static_cast<float>(cast.best.translation);
    axis_slope = static_cast<float>(k_axis_length * cast.best.axis.dot(cast.direction));
  }
};

/// Gaps along the best axes so far, and their slopes.
struct BestAxes {
  V gap;
  V slope;

  HWY_INLINE void keep_larger(V other_gap, V other_slope) {
    slope = hn::IfThenElse(hn::Gt(other_gap, gap), other_slope, slope);
    gap = hn::Max(gap, other_gap);
  }
};

/// Axes other than w.
/// @param f whose N is the frame of x
HWY_INLINE void bound_closely(const VolumePairs<k_rounding>& pairs, const Frame& f, const Ray::Velocity& velocity,
                              const Ray& ray, BestAxes& best) {
  const V zero = hn::Zero(k_lanes);
  const V slack = set(ray.slack);
  const V u[3] = {set(velocity.in_x[0]), set(velocity.in_x[1]), set(velocity.in_x[2])};
  const V m[3] = {pairs.offset_in_x(0), pairs.offset_in_x(1), pairs.offset_in_x(2)};  // at t0
  const V later = hn::Max(hn::Neg(dot(m, u)), zero);
  V near[3];
  for (std::size_t k = 0; k < 3; ++k) near[k] = unfused_mul_add(later, u[k], m[k]);
  {  // The line through the centres.
    const V squared = dot(near, near);
    const V inverse =
        hn::Div(set(static_cast<float>(k_axis_length)), hn::Sqrt(hn::Max(squared, set(k_smallest_square))));
    const V n[3] = {hn::Mul(near[0], inverse), hn::Mul(near[1], inverse), hn::Mul(near[2], inverse)};
    const V rate = dot(n, u);
    const V drop = hn::Max(hn::Mul(later, rate), hn::Mul(set(ray.reach), hn::Neg(rate)));
    const V gap = hn::Sub(hn::Sub(hn::Mul(squared, inverse), pairs.reach_along(n, f)), drop);
    best.keep_larger(hn::Sub(gap, slack), hn::Max(rate, zero));
  }
  const auto keep_boxes = [&](V squared, V length_times_rate) {
    const V length = hn::Sqrt(hn::Max(squared, set(k_smallest_square)));
    const V rate = hn::Div(length_times_rate, length);
    const V gap = hn::Sub(hn::Sub(length, hn::Mul(later, rate)), slack);
    best.keep_larger(hn::IfThenElse(hn::Ge(length_times_rate, zero), gap, set(CastFront::k_no_bound)), rate);
  };
  V squared_x = zero, rate_x = zero, squared_y = zero, rate_y = zero;  // rates: times the lengths
  const auto add_axis = [&](V offset, V extent, V rate, V& squared, V& length_times_rate) {
    const V apart = hn::Max(hn::Sub(hn::Abs(offset), extent), zero);
    squared = unfused_mul_add(apart, apart, squared);
    length_times_rate = unfused_mul_add(hn::CopySign(apart, offset), rate, length_times_rate);
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const V u_y = set(velocity.in_y[k]);
    add_axis(near[k], pairs.extent_in_x(k), u[k], squared_x, rate_x);
    add_axis(unfused_mul_add(later, u_y, pairs.offset_in_y(k)), pairs.extent_in_y(k), u_y, squared_y, rate_y);
  }
  keep_boxes(squared_x, rate_x);
  keep_boxes(squared_y, rate_y);
  const auto normals = pairs.along_normals(m);
  const auto keep_normal = [&](const AxisRange& range, V rate) {
    best.keep_larger(hn::Sub(hn::IfThenElse(hn::Lt(rate, zero), hn::Neg(range.high), range.low), slack), hn::Abs(rate));
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
  /// Of the vectors from A's volume to B's on w, but for a constant: the volume with the least is the most likely to be
  /// hit first.
  HWY_ALIGN float projection[k_width];
};

/// Sets gap and slope of each child of a node against a volume of the other tree along the best of the axes.
/// @param x_is_a whether the node is A's
/// @param x, y scratch
HWY_INLINE void bound_children(const Tree::Node& node, const Tree::Volume& volume, bool x_is_a, const Ray& ray,
                               Volumes& x, Volumes& y, VolumeBounds& bounds) {
  constexpr std::size_t k_step = hn::MaxLanes(k_lanes);
  const Frame& f = x_is_a ? ray.frames.a : ray.frames.b;
  const Frame& other = x_is_a ? ray.frames.b : ray.frames.a;
  x.load_own<k_rounding>(ChildrenOf{node});
  x.set_front<k_rounding>(ChildrenOf{node}, f);
  y.load_own<k_rounding>(Whole{volume});
  y.set_front<k_rounding>(Whole{volume}, other);
  const V w[3] = {set(f.direction[0]), set(f.direction[1]), set(f.direction[2])};
  const V along = set(static_cast<float>(ray.frames.shift_along - static_cast<double>(y.front[0])) - ray.slack);
  // If w culls all children, whatever the number of lanes, the others are not tried.
  bool all = true;
  for (std::size_t i = 0; i < k_width; i += k_step) {
    const V center[3] = {load(x.center[0] + i), load(x.center[1] + i), load(x.center[2] + i)};
    const V gap = hn::Sub(along, load(x.front + i));
    hn::Store(hn::Neg(dot(w, center)), k_lanes, bounds.projection + i);
    hn::Store(gap, k_lanes, bounds.gap + i);
    hn::Store(set(ray.axis_slope), k_lanes, bounds.slope + i);
    all = all && hn::AllTrue(k_lanes, hn::Gt(gap, set(ray.target)));
  }
  if (all) return;
  x.turn<k_rounding>(other);
  y.turn<k_rounding>(f);
  for (std::size_t i = 0; i < k_width; i += k_step) {
    BestAxes best{load(bounds.gap + i), load(bounds.slope + i)};
    bound_closely({x, y, i, 0}, f, x_is_a ? ray.of_b : ray.of_a, ray, best);
    hn::Store(best.gap, k_lanes, bounds.gap + i);
    hn::Store(best.slope, k_lanes, bounds.slope + i);
  }
}

namespace fw = frank_wolfe;

/// The triangles of two leaves. LeafPair::lower holds their gaps.
struct CastLeafPair : LeafPair {
  HWY_ALIGN float slopes[k_pairs];
};

/// Gaps of pairs of triangles. One that culls is not replaced.
struct BestTriangleAxes {
  V gap;
  V slope;

  /// Takes an axis n of any length.
  /// @param support the least n . (q - p)
  /// @param along n . u; may be below 0 by rounding
  HWY_INLINE void keep_larger(V support, V along, V length, const Ray& ray) {
    const V zero = hn::Zero(k_lanes);
    const V new_slope = hn::Div(along, length);
    const V drop = hn::Mul(set(ray.reach), hn::Min(new_slope, zero));
    const V new_gap = hn::Add(hn::Sub(hn::Div(support, length), set(ray.slack)), drop);
    const M better = hn::And(hn::Le(gap, set(ray.target)), hn::Gt(new_gap, gap));
    slope = hn::IfThenElse(better, hn::Max(new_slope, zero), slope);
    gap = hn::IfThenElse(better, new_gap, gap);
  }
};

/// Applies the cross products of the ray and each edge as axes, for pairs i .. i + Lanes - 1. Triangles that pass each
/// other, seen along the ray, are separated along one of them, unless their nearest points are corners.
HWY_INLINE void bound_across_ray(const LeafPair& pairs, std::size_t i, const V (&u)[3], const Ray& ray,
                                 BestTriangleAxes& best) {
  for (const auto* corners : {pairs.a, pairs.b}) {
    for (std::size_t edge = 0; edge < 3; ++edge) {
      V e[3];
      for (std::size_t k = 0; k < 3; ++k) {
        e[k] = hn::Sub(load(corners[(edge + 1) % 3][k] + i), load(corners[edge][k] + i));
      }
      const V n[3] = {unfused_sub_mul(hn::Mul(e[1], u[2]), e[2], u[1]),
                      unfused_sub_mul(hn::Mul(e[2], u[0]), e[0], u[2]),
                      unfused_sub_mul(hn::Mul(e[0], u[1]), e[1], u[0])};
      const auto value = [&](const auto& support) { return support.value; };
      const V most_a = value(fw::support<k_rounding, fw::Extreme::greatest>(n, pairs.a, i));
      const V least_a = value(fw::support<k_rounding, fw::Extreme::least>(n, pairs.a, i));
      const V most_b = value(fw::support<k_rounding, fw::Extreme::greatest>(n, pairs.b, i));
      const V least_b = value(fw::support<k_rounding, fw::Extreme::least>(n, pairs.b, i));
      const V length = fw::length<k_rounding>(n);
      const V along = dot(n, u);
      best.keep_larger(hn::Sub(least_b, most_a), along, length, ray);
      best.keep_larger(hn::Sub(least_a, most_b), hn::Neg(along), length, ray);
    }
  }
}

/// Raises gaps by Frank-Wolfe steps towards the point of S + {t u, t >= t0} that is nearest to the origin. Each iterate
/// x is an axis. Where the nearest point is one with t > t0 they converge slowly: then axes across the ray are tried at
/// the end.
HWY_INLINE void bound_triangles(CastLeafPair& pairs, const Ray& ray) {
  constexpr int k_steps = 5;
  const Frame& f = ray.frames.a;
  const V u[3] = {set(ray.of_b.in_x[0]), set(ray.of_b.in_x[1]), set(ray.of_b.in_x[2])};
  const V zero = hn::Zero(k_lanes);
  const V target = set(ray.target);
  for (std::size_t i = 0; i < LeafPair::k_pairs; i += hn::Lanes(k_lanes)) {
    BestTriangleAxes best{load(pairs.lower + i), set(ray.axis_slope)};
    V x[3] = {set(f.direction[0]), set(f.direction[1]), set(f.direction[2])};
    V forward = zero;  // the step along u from S to x
    for (int step = 0; !hn::AllTrue(k_lanes, hn::Gt(best.gap, target)); ++step) {
      const auto a = fw::support<k_rounding, fw::Extreme::greatest>(x, pairs.a, i);
      const auto b = fw::support<k_rounding, fw::Extreme::least>(x, pairs.b, i);
      // The first x is w, which gave the gaps so far.
      if (step > 0) best.keep_larger(hn::Sub(b.value, a.value), dot(x, u), fw::length<k_rounding>(x), ray);
      if (step == k_steps) break;
      const V s[3] = {hn::Sub(b.point[0], a.point[0]), hn::Sub(b.point[1], a.point[1]),
                      hn::Sub(b.point[2], a.point[2])};
      if (step == 0) {  // w is no point of S; s is
        for (std::size_t k = 0; k < 3; ++k) x[k] = s[k];
      } else {
        fw::step<k_rounding>(x, s);
      }
      forward = hn::Max(hn::Neg(dot(x, u)), zero);
      for (std::size_t k = 0; k < 3; ++k) x[k] = unfused_mul_add(forward, u[k], x[k]);
    }
    const M later = hn::And(hn::Le(best.gap, target), hn::Gt(forward, zero));
    BestTriangleAxes across = best;
    if (!hn::AllFalse(k_lanes, later)) bound_across_ray(pairs, i, u, ray, across);
    hn::Store(hn::IfThenElse(later, across.gap, best.gap), k_lanes, pairs.lower + i);
    hn::Store(hn::IfThenElse(later, across.slope, best.slope), k_lanes, pairs.slopes + i);
  }
}

/// What bounds say about all pairs of triangles of two leaves.
struct LeafBounds {
  float gap;  ///< Together with the slope a bound for all pairs; CastFront::k_no_bound if one is left.
  float slope;
  std::size_t count = 0;                   ///< Pairs that are left,
  std::uint32_t pairs[LeafPair::k_pairs];  ///< 4 i + j each, the smallest gap first.
};

HWY_INLINE LeafBounds bound_leaves(const Tree::Leaf& a, const Tree::Leaf& b, const Ray& ray) {
  LeafBounds result;
  CastLeafPair pairs;
  result.slope = ray.axis_slope;
  result.gap = bound_along_direction<k_rounding>(a, b, ray.frames, ray.slack, ray.target, pairs.lower);
  if (result.gap > ray.target) return result;
  load_pairs<k_rounding>(a, b, ray.frames.a, pairs);
  bound_triangles(pairs, ray);
  // The line with the least gap and the largest slope bounds all pairs that are culled.
  result.gap = CastFront::k_not_in_front;
  for (std::uint32_t i = 0; i < a.child.count(); ++i) {
    for (std::uint32_t j = 0; j < b.child.count(); ++j) {
      const std::uint32_t pair = k_leaf * i + j;
      if (pairs.lower[pair] > ray.target) {
        result.gap = std::min(result.gap, pairs.lower[pair]);
        result.slope = std::max(result.slope, pairs.slopes[pair]);
        continue;
      }
      std::size_t at = result.count++;
      for (; at > 0 && pairs.lower[result.pairs[at - 1]] > pairs.lower[pair]; --at) {
        result.pairs[at] = result.pairs[at - 1];
      }
      result.pairs[at] = pair;
    }
  }
  if (result.count != 0) result.gap = CastFront::k_no_bound;
  return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ray_cast
HWY_AFTER_NAMESPACE();
