#include <sixdof/oracle/ray_cast_pair.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <sixdof/base/simd_targets.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/ray_cast_pair.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/proximity/double_lanes-inl.h>

// The distance of two triangles that do not intersect is the least of the distances of 3 x 3 pairs of edges and of 6
// corners from the faces that they lie over. Whatever the parameters s and r of a feature, both points are points of
// the triangles; so where edges are nearly parallel, and the positions of the closest points are ill-conditioned, their
// distance is not. Triangles that are farther apart along the line through the closest points than the rounding do not
// intersect.

HWY_BEFORE_NAMESPACE();
namespace sixdof::ray_cast {
namespace HWY_NAMESPACE {

using namespace double_lanes::HWY_NAMESPACE;

HWY_INLINE V clamp(V x) { return hn::Min(hn::Max(x, hn::Zero(k_lanes)), set(1.0)); }

/// x / y for y >= 0; whatever it is where both are zero, it is finite.
HWY_INLINE V quotient(V x, V y) { return hn::Div(x, hn::Max(y, set(std::numeric_limits<double>::min()))); }

/// Sets w to the shortest vector from A to B by their features. Returns whether it shows that they are disjoint.
bool closest_by_features(const MovingPair::Features (&pairs)[2], const Eigen::Vector3d& shift, Eigen::Vector3d& w) {
  struct alignas(64) {
    double w[3][k_batch], squared[k_batch];
  } found[2];
  const V3 move{set(shift[0]), set(shift[1]), set(shift[2])};
  for (std::size_t half = 0; half < 2; ++half) {
    const MovingPair::Features& pair = pairs[half];
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
      const V3 from = load(pair.from, i) + move, u = load(pair.u, i), v = load(pair.v, i);
      const V c = dot(u, from), f = dot(v, from), uu = dot(u, u), vv = dot(v, v), uv = dot(u, v);
      // Closest points of two lines, then of each segment to the other's point. Of parallel lines any points will do.
      const V first =
          clamp(quotient(hn::Sub(hn::Mul(c, vv), hn::Mul(uv, f)), hn::Sub(hn::Mul(uu, vv), hn::Mul(uv, uv))));
      const V r = clamp(quotient(hn::Sub(hn::Mul(uv, first), f), vv));
      const V s = clamp(quotient(hn::Add(hn::Mul(uv, r), c), uu));
      const V3 to = from + r * v - s * u;
      const M possible = hn::Le(hn::Add(s, r), hn::Load(k_lanes, pair.most + i));
      store(to, found[half].w, i);
      hn::Store(select(possible, dot(to, to), set(std::numeric_limits<double>::max())), k_lanes,
                found[half].squared + i);
    }
  }
  std::size_t closest = 0;
  for (std::size_t n = 1; n < 2 * k_batch; ++n) {
    if (found[n / k_batch].squared[n % k_batch] < found[closest / k_batch].squared[closest % k_batch]) closest = n;
  }
  w = point(found[closest / k_batch].w, closest % k_batch);
  // `from` has all differences of two corners.
  const V3 axis{set(w[0]), set(w[1]), set(w[2])};
  V least = set(std::numeric_limits<double>::max()), farthest = hn::Zero(k_lanes);
  for (std::size_t half = 0; half < 2; ++half) {
    for (std::size_t i = 0; i < k_batch; i += hn::Lanes(k_lanes)) {
      const V3 from = load(pairs[half].from, i) + move;
      least = hn::Min(least, dot(axis, from));
      farthest = hn::Max(farthest, dot(from, from));
    }
  }
  return hn::GetLane(hn::MinOfLanes(k_lanes, least)) >
         detail::k_safe_gap * std::sqrt(w.squaredNorm() * hn::GetLane(hn::MaxOfLanes(k_lanes, farthest)));
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ray_cast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::ray_cast {

HWY_EXPORT(closest_by_features);

namespace {

using Eigen::Vector3d;

/// Triangles whose edges meet at a smaller sine are left to triangle_triangle_distance().
constexpr double k_least_sine = 1e-6;

Vector3d edge(const TriangleCorners& t, std::size_t i) { return t[(i + 1) % 3] - t[i]; }

bool is_degenerate(const TriangleCorners& t) {
  const Vector3d u = edge(t, 0), v = edge(t, 1);
  return u.cross(v).squaredNorm() <= k_least_sine * k_least_sine * u.squaredNorm() * v.squaredNorm();
}

}  // namespace

MovingPair::MovingPair(const TriangleCorners& a, const TriangleCorners& b, const Vector3d& direction)
    : a_(a), b_(b), direction_(direction), degenerate_(is_degenerate(a) || is_degenerate(b)) {
  std::size_t n = 0;
  const auto add = [&](const Vector3d& from, const Vector3d& u, const Vector3d& v, double most) {
    Features& features = features_[n / Features::k_count];
    const std::size_t lane = n++ % Features::k_count;
    for (int k = 0; k < 3; ++k) {
      features.from[k][lane] = from[k];
      features.u[k][lane] = u[k];
      features.v[k][lane] = v[k];
    }
    features.most[lane] = most;
  };
  const Vector3d edges_a[3] = {edge(a, 0), edge(a, 1), edge(a, 2)}, edges_b[3] = {edge(b, 0), edge(b, 1), edge(b, 2)};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) add(b[j] - a[i], edges_a[i], edges_b[j], 2.0);
    add(b[0] - a[i], edges_b[2], edges_b[0], 1.0);
    add(b[i] - a[0], edges_a[0], edges_a[2], 1.0);
  }
  add(b[2] - a[2], edges_a[2], edges_b[2], 2.0);
}

MovingPair::Distance MovingPair::distance_at(double t) const {
  const Vector3d move = t * direction_;
  Distance closest;
  const bool disjoint = HWY_DYNAMIC_DISPATCH(closest_by_features)(features_, move, closest.axis) && !degenerate_;
  if (!disjoint) {
    const ClosestPoints points = triangle_triangle_distance(a_, {b_[0] + move, b_[1] + move, b_[2] + move});
    closest.axis = points.on_b - points.on_a;
    closest.value = points.distance;
  }
  const double length = closest.axis.norm();
  if (disjoint) closest.value = length;
  if (length > 0.0) closest.axis /= length;
  closest.slope = closest.axis.dot(direction_);
  return closest;
}

namespace {

/// Limit of Newton steps. Where the ray grazes, each halves the error; elsewhere it squares it.
constexpr int k_most_steps = 100;

/// |distance - target| at which Newton's method ends, in units of Cast::size(): the rounding of the corners.
constexpr double k_converged = 2e-16;

/// Targets below this, in units of Cast::size(), take their axis from sharp_axis(). Of buckets this is only contact.
constexpr double k_small_target = 1e-3;

/// Cosine of the largest angle (1.4e-4) between the axis from rounded points and the exact one: at contact they differ
/// by some 1e-5.
constexpr double k_least_cosine = 1.0 - 1e-8;

TriangleCorners moved(const TriangleCorners& t, const Vector3d& move) {
  return {t[0] + move, t[1] + move, t[2] + move};
}

/// The least axis . (q - p) of the points p of one triangle and q of another.
double gap_along(const Vector3d& axis, const TriangleCorners& a, const TriangleCorners& b) {
  return std::min({axis.dot(b[0]), axis.dot(b[1]), axis.dot(b[2])}) -
         std::max({axis.dot(a[0]), axis.dot(a[1]), axis.dot(a[2])});
}

/// The axis between the closest points of two triangles that nearly touch, without the rounding of these points: at
/// distance d the difference of two points of size L has an angular error of 1e-16 L / d.
/// @param axis unit vector between the points
/// @param tolerance by which the triangles may be closer along the new axis
/// @return the normal of a triangle or cross product of two edges near `axis` along which the triangles are farthest
/// apart; `axis` if there is none
Vector3d sharp_axis(const TriangleCorners& a, const TriangleCorners& b, const Vector3d& axis, double tolerance) {
  Vector3d best = axis;
  double best_gap = gap_along(axis, a, b) - tolerance;
  const auto try_cross_product = [&](const Vector3d& u, const Vector3d& v) {
    const Vector3d product = u.cross(v);
    const double along = product.dot(axis);
    const double length = product.norm();
    if (!(std::abs(along) >= k_least_cosine * length) || !(length > 0.0)) return;
    const Vector3d n = product / std::copysign(length, along);
    const double gap = gap_along(n, a, b);
    if (!(gap > best_gap)) return;
    best_gap = gap;
    best = n;
  };
  try_cross_product(edge(a, 0), edge(a, 1));
  try_cross_product(edge(b, 0), edge(b, 1));
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) try_cross_product(edge(a, i), edge(b, j));
  }
  return best;
}

/// One pair of triangles against the best hit.
class PairUpdate {
 public:
  PairUpdate(Cast& cast, TrianglePair pair) : cast_(cast), pair_(pair), a_(cast.a.triangle(pair.a)) {
    const TriangleCorners b = cast.b.triangle(pair.b);
    b_ = moved({cast.R * b[0], cast.R * b[1], cast.R * b[2]}, cast.offset);
  }

  bool run() {
    Hit& best = cast_.best;
    const double enough = cast_.target - cast_.tie();
    // Triangles around the corners and edges of the closest pair tie with it along its axis.
    const auto separates = [&](const Vector3d& axis) {
      return best.translation * axis.dot(cast_.direction) + gap_along(axis, a_, b_) >= enough;
    };
    if (best.pair && (separates(best.axis) || separates(best.separating_axis))) return false;
    const MovingPair moving(a_, b_, cast_.direction);
    double t = best.translation;
    MovingPair::Distance distance = distance_at(moving, t);
    if (distance.value >= enough && distance.slope >= 0.0) {
      if (best.pair) best.separating_axis = separating_axis(distance.axis, t);
      return false;
    }
    if (!find_hit(moving, t, distance)) return false;
    best.translation = t;
    best.pair = pair_;
    best.axis = best.separating_axis = separating_axis(distance.axis, t);
    return true;
  }

 private:
  MovingPair::Distance distance_at(const MovingPair& moving, double t) {
    ++cast_.counts.distances;
    return moving.distance_at(t);
  }

  Vector3d separating_axis(const Vector3d& axis, double t) const {
    if (cast_.target >= k_small_target * cast_.size()) return axis;
    const Vector3d sharp = sharp_axis(a_, moved(b_, t * cast_.direction), axis, 0.25 * cast_.tie());
    return sharp.dot(cast_.direction) >= 0.0 ? sharp : axis;
  }

  /// The distance is convex in t. If it is the target at some larger t, Newton's method converges to the largest such
  /// t: from any t with a positive slope one step ends at or beyond it, and no step from there goes past it.
  /// @param t, distance where to begin; set to the hit
  /// @return whether there is a hit beyond the best one
  bool find_hit(const MovingPair& moving, double& t, MovingPair::Distance& distance) {
    const double target = cast_.target;
    const double least = cast_.best.translation;
    if (distance.value >= target || !(distance.slope > 0.0)) {
      // There is no positive slope here: begin where the triangles are apart by the target along the ray.
      t = target - gap_along(cast_.direction, a_, b_);
      if (t <= least) return false;
      distance = distance_at(moving, t);
    }
    for (int step = 0; step < k_most_steps; ++step) {
      const double excess = distance.value - target;
      if (std::abs(excess) <= k_converged * cast_.size()) break;
      if (!(distance.slope > 0.0)) return false;  // the least distance is above the target
      const double next = t - excess / distance.slope;
      if (next <= least) return false;
      if (next == t) break;
      t = next;
      distance = distance_at(moving, t);
    }
    return distance.slope >= 0.0;
  }

  Cast& cast_;
  const TrianglePair pair_;
  const TriangleCorners a_;
  TriangleCorners b_;  // at t = 0
};

}  // namespace

bool try_update(Cast& cast, TrianglePair pair) { return PairUpdate(cast, pair).run(); }

}  // namespace sixdof::ray_cast
#endif  // HWY_ONCE
