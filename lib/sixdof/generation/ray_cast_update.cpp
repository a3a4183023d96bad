#include <sixdof/generation/ray_cast_update.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <sixdof/generation/ray_cast_pair.h>

namespace sixdof::ray_cast {
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

/// The axis between the closest points of two triangles that nearly touch, without the rounding of these points. At
/// distance d the difference of two points of size L has an angular error of 1e-16 L / d, so that ties along it are not
/// found. The normals of the triangles, and the cross products of two edges, have no such error.
/// @param axis unit vector between the points
/// @param tolerance by which the triangles may be closer along the new axis
/// @return the normal or cross product near `axis` along which the triangles are farthest apart; `axis` if there is
/// none
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
  const double tie = k_cast_tie * size;
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
