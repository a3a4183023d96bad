#include <sixdof/generation/ray_cast_pair.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/generation/ray_cast_pair.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// The distance of two triangles that do not intersect is the least of the distances of 3 x 3 pairs of edges and of 6
// corners from the faces that they lie over. The loops over both have no branches, so that the compiler vectorizes
// them for each instruction set; it fuses no operations. Where edges are nearly parallel, the positions of the closest
// points along them are ill-conditioned, but their distance is not: whatever the parameters s and r in 0 .. 1, both are
// points of the triangles.

HWY_BEFORE_NAMESPACE();
namespace sixdof::ray_cast {
namespace HWY_NAMESPACE {

HWY_INLINE double clamp(double x) {
  x = x > 0.0 ? x : 0.0;
  return x < 1.0 ? x : 1.0;
}

void separate(const MovingPair::Features& HWY_RESTRICT pair, double t, const Eigen::Vector3d& direction,
              MovingPair::Separations& HWY_RESTRICT out) {
  const double shift[3] = {t * direction[0], t * direction[1], t * direction[2]};
  for (std::size_t n = 0; n < MovingPair::k_edges; ++n) {
    const double x = pair.from[0][n] + shift[0];
    const double y = pair.from[1][n] + shift[1];
    const double z = pair.from[2][n] + shift[2];
    const double c = pair.u[0][n] * x + pair.u[1][n] * y + pair.u[2][n] * z;
    const double f = pair.v[0][n] * x + pair.v[1][n] * y + pair.v[2][n] * z;
    // Closest points of two lines, then of each segment to the other's point.
    double s = clamp((c * pair.vv[n] - pair.uv[n] * f) * pair.per_nn[n]);
    const double r = clamp((pair.uv[n] * s - f) * pair.per_vv[n]);
    s = clamp((c + pair.uv[n] * r) * pair.per_uu[n]);
    out.w[0][n] = x + r * pair.v[0][n] - s * pair.u[0][n];
    out.w[1][n] = y + r * pair.v[1][n] - s * pair.u[1][n];
    out.w[2][n] = z + r * pair.v[2][n] - s * pair.u[2][n];
    out.squared[n] = out.w[0][n] * out.w[0][n] + out.w[1][n] * out.w[1][n] + out.w[2][n] * out.w[2][n];
  }
  for (std::size_t n = 0; n < MovingPair::k_corners; ++n) {
    const double x = pair.offset[0][n] + t * pair.velocity[0][n];
    const double y = pair.offset[1][n] + t * pair.velocity[1][n];
    const double z = pair.offset[2][n] + t * pair.velocity[2][n];
    out.signed_distance[n] = pair.normal[0][n] * x + pair.normal[1][n] * y + pair.normal[2][n] * z;
    const double first = pair.dual_1[0][n] * x + pair.dual_1[1][n] * y + pair.dual_1[2][n] * z;
    const double second = pair.dual_2[0][n] * x + pair.dual_2[1][n] * y + pair.dual_2[2][n] * z;
    out.outside[n] = std::max(std::max(-first, -second), first + second - 1.0);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ray_cast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::ray_cast {

HWY_EXPORT(separate);

namespace {

using Eigen::Vector3d;

/// Triangles whose edges meet at a smaller sine are left to triangle_triangle_distance(): rounding may rotate their
/// normal by more than 1e-10.
constexpr double k_least_sine = 1e-6;
/// Error of a corner's signed distance from a plane, in units of the longest edge: ten times that of the normal.
constexpr double k_plane_error = 1e-9;

double inverse(double x) { return x > 0.0 ? 1.0 / x : 0.0; }

}  // namespace

MovingPair::MovingPair(const TriangleCorners& a, const TriangleCorners& b, const Vector3d& direction)
    : a_(a), b_(b), direction_(direction) {
  Features& f = features_;
  const TriangleCorners edge_a{a[1] - a[0], a[2] - a[1], a[0] - a[2]};
  const TriangleCorners edge_b{b[1] - b[0], b[2] - b[1], b[0] - b[2]};
  for (std::size_t n = 0; n < k_edges; ++n) {
    const std::size_t i = n < 9 ? n / 3 : 2;
    const std::size_t j = n % 3;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      f.from[k][n] = b[j][axis] - a[i][axis];
      f.u[k][n] = edge_a[i][axis];
      f.v[k][n] = edge_b[j][axis];
    }
  }
  for (std::size_t n = 0; n < k_edges; ++n) {
    f.uu[n] = f.u[0][n] * f.u[0][n] + f.u[1][n] * f.u[1][n] + f.u[2][n] * f.u[2][n];
    f.vv[n] = f.v[0][n] * f.v[0][n] + f.v[1][n] * f.v[1][n] + f.v[2][n] * f.v[2][n];
    f.uv[n] = f.u[0][n] * f.v[0][n] + f.u[1][n] * f.v[1][n] + f.u[2][n] * f.v[2][n];
    f.per_uu[n] = inverse(f.uu[n]);
    f.per_vv[n] = inverse(f.vv[n]);
    f.per_nn[n] = inverse(f.uu[n] * f.vv[n] - f.uv[n] * f.uv[n]);
  }
  plane_error_ = k_plane_error *
                 std::sqrt(std::max(*std::max_element(f.uu, f.uu + k_edges), *std::max_element(f.vv, f.vv + k_edges)));
  for (std::size_t n = 0; n < k_corners; ++n) {
    const bool of_a = n < 3;
    const TriangleCorners& face = of_a ? b : a;
    const Vector3d& corner = of_a ? a[n] : b[n - 3];
    const Vector3d first = face[1] - face[0];
    const Vector3d second = face[2] - face[0];
    const Vector3d normal = first.cross(second);
    const double length2 = normal.squaredNorm();
    degenerate_ = degenerate_ || length2 <= k_least_sine * k_least_sine * first.squaredNorm() * second.squaredNorm();
    const double per_length2 = inverse(length2);
    const Vector3d unit = normal * std::sqrt(per_length2);
    const Vector3d dual_1 = second.cross(normal) * per_length2;
    const Vector3d dual_2 = normal.cross(first) * per_length2;
    const Vector3d offset = corner - face[0];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      f.offset[k][n] = offset[axis];
      f.normal[k][n] = unit[axis];
      f.dual_1[k][n] = dual_1[axis];
      f.dual_2[k][n] = dual_2[axis];
      f.velocity[k][n] = of_a ? -direction[axis] : direction[axis];
    }
  }
}

MovingPair::Distance MovingPair::distance_at(double t) const {
  Separations x;
  HWY_DYNAMIC_DISPATCH(separate)(features_, t, direction_, x);
  Distance closest{.value = 0.0, .axis = Vector3d::Zero(), .slope = 0.0};
  // Whether corners n .. n + 2 may lie on both sides of the other triangle's plane.
  const auto straddles = [&](std::size_t n) {
    const auto [low, high] = std::minmax({x.signed_distance[n], x.signed_distance[n + 1], x.signed_distance[n + 2]});
    return low <= plane_error_ && high >= -plane_error_;
  };
  if (degenerate_ || (straddles(0) && straddles(3))) {  // they may intersect
    const Vector3d move = t * direction_;
    const ClosestPoints points = triangle_triangle_distance(a_, {b_[0] + move, b_[1] + move, b_[2] + move});
    closest.value = points.distance;
    closest.axis = points.on_b - points.on_a;
  } else {
    std::size_t best = 0;
    for (std::size_t n = 1; n < k_edges; ++n) best = x.squared[n] < x.squared[best] ? n : best;
    closest.axis = Vector3d(x.w[0][best], x.w[1][best], x.w[2][best]);
    closest.value = std::sqrt(x.squared[best]);
    for (std::size_t n = 0; n < k_corners; ++n) {
      const double distance = std::abs(x.signed_distance[n]);
      if (x.outside[n] > 0.0 || !(distance < closest.value)) continue;
      const double from_a_to_b = n < 3 ? -x.signed_distance[n] : x.signed_distance[n];
      const Vector3d normal(features_.normal[0][n], features_.normal[1][n], features_.normal[2][n]);
      closest.value = distance;
      closest.axis = from_a_to_b * normal;
    }
  }
  const double length = closest.axis.norm();
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

/// The least axis . (q - p) of two triangles.
/// @param reflected A's corners, reflected in the origin
/// @param b B's corners where it stands
double support_value(const TriangleCorners& reflected, const TriangleCorners& b, const Eigen::Vector3d& axis) {
  return std::min({axis.dot(reflected[0]), axis.dot(reflected[1]), axis.dot(reflected[2])}) +
         std::min({axis.dot(b[0]), axis.dot(b[1]), axis.dot(b[2])});
}

/// The axis between the closest points of two triangles that nearly touch, without the rounding of these points: at
/// distance d the difference of two points of size L has an angular error of 1e-16 L / d.
/// @param axis unit vector between the points
/// @param tolerance by which the triangles may be closer along the new axis
/// @return the normal of a triangle or cross product of two edges near `axis` along which the triangles are farthest
/// apart; `axis` if there is none
Eigen::Vector3d sharp_axis(const TriangleCorners& reflected, const TriangleCorners& b, const Eigen::Vector3d& axis,
                           double tolerance) {
  Eigen::Vector3d best = axis;
  double best_value = support_value(reflected, b, axis) - tolerance;
  const auto try_cross_product = [&](const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
    const Eigen::Vector3d product = u.cross(v);
    const double along = product.dot(axis);
    const double length = product.norm();
    if (!(std::abs(along) >= k_least_cosine * length) || !(length > 0.0)) return;
    const Eigen::Vector3d n = product / std::copysign(length, along);
    const double value = support_value(reflected, b, n);
    if (!(value > best_value)) return;
    best_value = value;
    best = n;
  };
  const auto edge = [](const TriangleCorners& t, std::size_t i) -> Eigen::Vector3d { return t[(i + 1) % 3] - t[i]; };
  try_cross_product(edge(reflected, 0), edge(reflected, 1));
  try_cross_product(edge(b, 0), edge(b, 1));
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) try_cross_product(edge(reflected, i), edge(b, j));
  }
  return best;
}

}  // namespace

bool try_update(Cast& cast, TrianglePair pair) {
  const TriangleCorners reflected = cast.a.triangle(pair.a);
  const TriangleCorners a{-reflected[0], -reflected[1], -reflected[2]};
  const TriangleCorners b = cast.b.triangle(pair.b);  // at t = 0
  const double size = cast.size();
  // Below the target, so that triangles that intersect do not tie: contact of a small A with a large B is nearer than
  // a part of both sizes.
  const double tie = std::min(k_cast_tie * size, 0.5 * cast.target);
  Hit& best = cast.best;
  // Triangles around the corners and edges of the closest pair tie with it along its axis.
  const auto distance_along = [&](const Eigen::Vector3d& axis) {
    return best.translation * axis.dot(cast.direction) + support_value(reflected, b, axis);
  };
  const double enough = cast.target - tie;
  if (best.pair && (distance_along(best.axis) >= enough || distance_along(best.separating_axis) >= enough)) {
    return false;
  }
  const MovingPair moving(a, b, cast.direction);
  const auto distance_at = [&](double t) {
    ++cast.counts.distances;
    return moving.distance_at(t);
  };
  const auto separating_axis = [&](const MovingPair::Distance& at, double t) -> Eigen::Vector3d {
    if (cast.target >= k_small_target * size) return at.axis;
    const Eigen::Vector3d move = t * cast.direction;
    const Eigen::Vector3d axis = sharp_axis(reflected, {b[0] + move, b[1] + move, b[2] + move}, at.axis, 0.25 * tie);
    return axis.dot(cast.direction) >= 0.0 ? axis : at.axis;
  };
  double t = best.translation;
  MovingPair::Distance distance = distance_at(t);
  if (distance.value >= cast.target - tie && distance.slope >= 0.0) {
    if (best.pair) best.separating_axis = separating_axis(distance, t);
    return false;
  }
  // The distance is convex in t. If it is the target at some larger t, Newton's method converges to the largest such t:
  // from any t with a positive slope one step ends at or beyond it, and no step from there goes past it.
  if (distance.value >= cast.target || !(distance.slope > 0.0)) {
    // There is no positive slope here: begin where the triangles are apart by the target along the ray.
    double max_a = -std::numeric_limits<double>::infinity();
    double min_b = -max_a;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      max_a = std::max(max_a, a[corner].dot(cast.direction));
      min_b = std::min(min_b, b[corner].dot(cast.direction));
    }
    t = max_a - min_b + cast.target;
    if (t <= best.translation) return false;
    distance = distance_at(t);
  }
  for (int step = 0; step < k_most_steps; ++step) {
    const double excess = distance.value - cast.target;
    if (std::abs(excess) <= k_converged * size) break;
    if (!(distance.slope > 0.0)) return false;  // the least distance is above the target
    const double next = t - excess / distance.slope;
    if (next <= best.translation) return false;
    if (next == t) break;
    t = next;
    distance = distance_at(t);
  }
  if (!(distance.slope >= 0.0)) return false;
  best.translation = t;
  best.pair = pair;
  best.axis = best.separating_axis = separating_axis(distance, t);
  return true;
}

}  // namespace sixdof::ray_cast
#endif  // HWY_ONCE
