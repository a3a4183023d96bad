// Part of ray_cast_search.cpp, which includes it once per instruction set: it has no include guard.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <sixdof/generation/ray_cast_search.h>
#include <sixdof/generation/ray_cast_tree.h>
#include <sixdof/oracle/pair_bounds-inl.h>

// Separating-axis bounds for one volume against the eight children of a node, one child per SIMD lane, and for the
// triangles of two leaves. Notation: see ray_cast_search.h, and pair_bounds-inl.h for frames and volumes. For a unit
// vector n from A to B, the gap along n at t0 = ray.translation is a lower bound on the distance there, and n . u is
// its slope. Where the gap exceeds the target and the slope is not negative, the pair is farther apart than the target
// at t0 and at every larger t. No ray parameter is divided by n . u, so grazing rays are no special case.
//
// The axes are those of pair_bounds-inl.h, each with the sign for which its slope is not negative. w is the axis of the
// best hit.
// Where the centres of two volumes come nearer as t grows beyond t0, the line through them and the axis between their
// boxes are those at the t where they are nearest, t0 + `later`, and the gap there is lowered by later times the slope,
// to t0. At that t the line through the centres has n . u = 0 up to rounding: if rounding makes it negative, the gap is
// lowered by what that takes up to the largest t.
//
// Nothing here uses fused multiply-add, and all operations (+ - * / sqrt min max) are rounded by IEEE rules lane by
// lane. So which pairs are expanded, and in what order, is the same on every instruction set.

HWY_BEFORE_NAMESPACE();
namespace sixdof::ray_cast {
namespace HWY_NAMESPACE {

using namespace pair_bounds::HWY_NAMESPACE;

constexpr Rounding k_rounding = Rounding::unfused;
using FixedVolume = pair_bounds::HWY_NAMESPACE::FixedVolume<k_rounding>;
using ChildVolumes = pair_bounds::HWY_NAMESPACE::ChildVolumes<k_rounding>;

/// Length of axes. They are shorter than unit vectors by more than their rounding, so that a gap along them never
/// exceeds the distance.
constexpr double k_axis_length = 1.0 - 4e-7;

/// The ray in single precision.
struct Ray {
  /// How the fixed volume moves against the expanded node, as t grows: in N and in F.
  struct Velocity {
    float in_n[3];
    float in_f[3];
  };

  Frames frames;  ///< At t0; w is k_axis_length long.
  Velocity expand_a, expand_b;
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
      expand_a.in_n[k] = static_cast<float>(cast.direction[k]);
      expand_a.in_f[k] = static_cast<float>(in_b[k]);
      expand_b.in_n[k] = -expand_a.in_f[k];
      expand_b.in_f[k] = -expand_a.in_n[k];
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

/// Axes other than w, for some children.
/// @param f, velocity of the expanded node
HWY_INLINE void bound_closely(const ChildVolumes& child, const FixedVolume& fixed, const Frame& f,
                              const Ray::Velocity& velocity, const Ray& ray, BestAxes& best) {
  const V zero = hn::Zero(k_lanes);
  const V slack = set(ray.slack);
  const V u[3] = {set(velocity.in_n[0]), set(velocity.in_n[1]), set(velocity.in_n[2])};
  const V normal_fixed[3] = {set(fixed.normal[0]), set(fixed.normal[1]), set(fixed.normal[2])};
  V m[3];  // from the children's centres to the fixed volume's, at t0
  for (std::size_t k = 0; k < 3; ++k) m[k] = hn::Sub(set(fixed.center[k]), child.center[k]);
  const V later = hn::Max(hn::Neg(dot(m, u)), zero);
  V near[3];
  for (std::size_t k = 0; k < 3; ++k) near[k] = unfused_mul_add(later, u[k], m[k]);
  {  // The line through the centres.
    const V squared = dot(near, near);
    const V inverse =
        hn::Div(set(static_cast<float>(k_axis_length)), hn::Sqrt(hn::Max(squared, set(k_smallest_square))));
    const V n[3] = {hn::Mul(near[0], inverse), hn::Mul(near[1], inverse), hn::Mul(near[2], inverse)};
    const Reach own = child.reach(n, dot(n, child.normal)), other = fixed.reach(n, dot(n, normal_fixed));
    const V rate = dot(n, u);
    const V drop = hn::Max(hn::Mul(later, rate), hn::Mul(set(ray.reach), hn::Neg(rate)));
    const V gap = hn::Sub(hn::Sub(hn::Mul(squared, inverse), hn::Add(own.up, other.down)), drop);
    best.keep_larger(hn::Sub(gap, slack), hn::Max(rate, zero));
  }
  const auto keep_boxes = [&](V squared, V length_times_rate) {
    const V length = hn::Sqrt(hn::Max(squared, set(k_smallest_square)));
    const V rate = hn::Div(length_times_rate, length);
    const V gap = hn::Sub(hn::Sub(length, hn::Mul(later, rate)), slack);
    best.keep_larger(hn::IfThenElse(hn::Ge(length_times_rate, zero), gap, set(CastFront::k_no_bound)), rate);
  };
  V squared = zero, length_times_rate = zero;
  const auto add_axis = [&](V middle, V extent, V rate) {
    const V apart = hn::Max(hn::Sub(hn::Abs(middle), extent), zero);
    squared = unfused_mul_add(apart, apart, squared);
    length_times_rate = unfused_mul_add(hn::CopySign(apart, middle), rate, length_times_rate);
  };
  for (std::size_t k = 0; k < 3; ++k) add_axis(near[k], hn::Add(child.half[k], set(fixed.half[k])), u[k]);
  keep_boxes(squared, length_times_rate);
  squared = length_times_rate = zero;
  for (std::size_t k = 0; k < 3; ++k) {
    V middle = zero;
    V extent = set(fixed.half_fixed[k]);
    for (std::size_t j = 0; j < 3; ++j) {
      const V r = set(f.axis[k][j]);
      middle = unfused_mul_add(r, near[j], middle);
      extent = unfused_mul_add(hn::Abs(r), child.half[j], extent);
    }
    add_axis(middle, extent, set(velocity.in_f[k]));
  }
  keep_boxes(squared, length_times_rate);
  // The normals of both slabs.
  const V normals = dot(normal_fixed, child.normal);
  const auto keep_normal = [&](V up, V down, V rate) {
    best.keep_larger(hn::Sub(hn::IfThenElse(hn::Lt(rate, zero), down, up), slack), hn::Abs(rate));
  };
  const V on_child = dot(child.normal, m), on_fixed = dot(normal_fixed, m);
  const Reach of_fixed = fixed.reach(child.normal, normals), of_child = child.reach(normal_fixed, normals);
  keep_normal(hn::Sub(hn::Sub(on_child, of_fixed.down), child.above),
              hn::Sub(child.below, hn::Add(on_child, of_fixed.up)), dot(child.normal, u));
  keep_normal(hn::Sub(hn::Add(on_fixed, set(fixed.slab_lower)), of_child.up),
              hn::Sub(hn::Neg(hn::Add(on_fixed, set(fixed.slab_upper))), of_child.down), dot(normal_fixed, u));
}

/// Sets gap and slope of each child of a node against the fixed volume along the best of the axes.
/// @param f, velocity of the expanded node
/// @param projections of the vectors from A's volume to B's on w, but for a constant: the child with the least is the
/// most likely to be hit first
HWY_INLINE void bound_children(const Tree::Node& node, const Tree::Volume& fixed_volume, const Frame& f,
                               const Ray::Velocity& velocity, const Ray& ray, float* HWY_RESTRICT gaps,
                               float* HWY_RESTRICT slopes, float* HWY_RESTRICT projections) {
  constexpr std::size_t k_step = hn::MaxLanes(k_lanes);
  const V w[3] = {set(f.direction[0]), set(f.direction[1]), set(f.direction[2])};
  const auto along = static_cast<double>(least_along(fixed_volume, f)) + f.translation_along;
  const V fixed_along = set(static_cast<float>(along) - ray.slack);
  // If w culls all children, whatever the number of lanes, the others are not tried.
  bool all = true;
  for (std::size_t i = 0; i < k_width; i += k_step) {
    const ChildVolumes child(node, i);
    const V gap = hn::Sub(fixed_along, child.greatest_along(w));
    hn::Store(hn::Neg(dot(w, child.center)), k_lanes, projections + i);
    hn::Store(gap, k_lanes, gaps + i);
    hn::Store(set(ray.axis_slope), k_lanes, slopes + i);
    all = all && hn::AllTrue(k_lanes, hn::Gt(gap, set(ray.target)));
  }
  if (all) return;
  const FixedVolume fixed(fixed_volume, f);
  for (std::size_t i = 0; i < k_width; i += k_step) {
    BestAxes best{load(gaps + i), load(slopes + i)};
    bound_closely(ChildVolumes(node, i), fixed, f, velocity, ray, best);
    hn::Store(best.gap, k_lanes, gaps + i);
    hn::Store(best.slope, k_lanes, slopes + i);
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
  const Frame& f = ray.frames.expand_a;
  const V u[3] = {set(ray.expand_a.in_n[0]), set(ray.expand_a.in_n[1]), set(ray.expand_a.in_n[2])};
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
  const Frame& f = ray.frames.expand_a;
  result.slope = ray.axis_slope;
  result.gap = bound_along_direction<k_rounding>(a, b, f, ray.slack, ray.target, pairs.lower);
  if (result.gap > ray.target) return result;
  load_pairs<k_rounding>(a, b, f, pairs);
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
