#include <sixdof/stability/shots.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <sixdof/stability/bodies.h>
#include <sixdof/stability/reference.h>

namespace sixdof::stability {
namespace {

/// Roundings between an ideal body and the triangles that an algorithm sees, in units of the last place: of a vertex,
/// of its motion to a generic frame, of the pose and of its use; three sums of three products each.
constexpr double k_roundings = 64.0;

double reach(const Mesh& mesh) {
  double square = 0.0;
  for (const Eigen::Vector3d& p : mesh.vertices()) square = std::max(square, p.squaredNorm());
  return std::sqrt(square);
}

/// Greatest depth in box A of a point of box B's surface; both along the axes, B's centre at `offset`. On each face of
/// B the depths below the pairs of A's faces are greatest at the same point.
double depth_of_surface(const Eigen::Vector3d& size_a, const Eigen::Vector3d& size_b, const Eigen::Vector3d& offset) {
  const Eigen::Vector3d half_a = 0.5 * size_a, half_b = 0.5 * size_b;
  const Eigen::Vector3d nearest = (offset.cwiseAbs() - half_b).cwiseMax(0.0);
  double greatest = 0.0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Eigen::Vector3d from_center = nearest;
      from_center[axis] = std::abs(offset[axis] + side * half_b[axis]);
      greatest = std::max(greatest, (half_a - from_center).minCoeff());
    }
  }
  return greatest;
}

Placement product(const Placement& x, const Placement& y) { return {x.pose() * y.t, (x.q * y.q).normalized()}; }

Placement inverse(const Placement& x) { return {x.pose().inverse().t, x.q.conjugate()}; }

}  // namespace

double Shot::rounding() const {
  const double t = raw ? 0.0 : X_AB.t.norm();
  return k_roundings * std::numeric_limits<double>::epsilon() * (reach(*a) + reach(*b) + t);
}

Shot above_face(const MeshPointer& a, double height, const MeshPointer& b, const Eigen::Quaterniond& q, double x,
                double y, double gap) {
  Shot shot{.a = a, .b = b, .X_AB = {Eigen::Vector3d::Zero(), q.normalized()}};
  const Eigen::Matrix3d R = shot.X_AB.pose().R;
  const auto& points = b->vertices();
  const auto lowest = *std::ranges::min_element(points, {}, [&](const Eigen::Vector3d& p) { return R.row(2).dot(p); });
  shot.X_AB.t = Eigen::Vector3d(x, y, height + gap) - R * lowest;
  const Pose X = shot.X_AB.pose();
  long double least = std::numeric_limits<long double>::infinity();
  for (const Eigen::Vector3d& p : points) {
    long double z = static_cast<long double>(X.t.z()) - height;
    for (Eigen::Index k = 0; k < 3; ++k) z += static_cast<long double>(X.R(2, k)) * p[k];
    least = std::min(least, z);
  }
  shot.truth.gap = static_cast<double>(least);
  shot.truth.distance = std::max(0.0, shot.truth.gap);
  if (shot.truth.gap < 0.0) shot.truth.push = Eigen::Vector3d::UnitZ();
  return shot;
}

Shot aligned_boxes(const Eigen::Vector3d& size_a, const Eigen::Vector3d& size_b, const Eigen::Vector3d& offset) {
  Shot shot{.a = box(size_a), .b = box(size_b), .X_AB = {offset, Eigen::Quaterniond::Identity()}};
  constexpr long double k_same_plane = 1e-12L;
  long double volume = 1.0L, square = 0.0L, depth = std::numeric_limits<long double>::infinity();
  bool b_inside = true, a_inside = true, apart_inside = true;
  Eigen::Index axis = 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const long double a = size_a[k], b = size_b[k];
    const long double overlap = (a + b) / 2 - std::abs(static_cast<long double>(offset[k]));
    if (overlap < depth) axis = k;
    depth = std::min(depth, overlap);
    volume *= std::clamp(overlap, 0.0L, std::min(a, b));
    if (overlap < 0) square += overlap * overlap;
    b_inside = b_inside && overlap >= b - k_same_plane;
    a_inside = a_inside && overlap >= a - k_same_plane;
    apart_inside = apart_inside && overlap > std::min(a, b) + k_same_plane;
  }
  // Inside with room on all sides the surfaces are apart, by what is not computed here.
  const bool inside = a_inside || b_inside;
  shot.truth.volume = static_cast<double>(volume);
  shot.truth.gap = static_cast<double>(square > 0 ? std::sqrt(square) : -depth);
  shot.truth.contained = inside;
  shot.truth.depth_of_a = depth_of_surface(size_b, size_a, -offset);
  shot.truth.depth_of_b = depth_of_surface(size_a, size_b, offset);
  shot.truth.distance = inside && apart_inside ? k_unknown : std::max(0.0, shot.truth.gap);
  // A direction is claimed only where the other ways out are clearly longer, and one body's face lies inside the
  // other's: else the volume decreases sideways, too.
  constexpr double k_inside = 1e-9;
  bool clear = depth > 0 && std::abs(offset[axis]) > k_inside;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double overlap = (size_a[k] + size_b[k]) / 2 - std::abs(offset[k]);
    const double room = std::abs(size_a[k] - size_b[k]) / 2 - std::abs(offset[k]);
    clear = clear && (k == axis || (overlap > 4 * depth && room > k_inside));
  }
  if (clear && !inside) shot.truth.push = std::copysign(1.0, offset[axis]) * Eigen::Vector3d::Unit(axis);
  return shot;
}

Shot apart(const MeshPointer& a, const MeshPointer& b, const Placement& X_AB) {
  Shot shot{.a = a, .b = b, .X_AB = X_AB};
  shot.truth.distance = static_cast<double>(reference_distance(*a, *b, X_AB.pose()));
  shot.truth.gap = shot.truth.distance;
  return shot;
}

Shot overlapping(const MeshPointer& a, const MeshPointer& b, const Placement& X_AB, double depth, double error) {
  Shot shot{.a = a, .b = b, .X_AB = X_AB};
  shot.truth.gap = -depth;
  shot.truth.distance = 0.0;
  shot.truth.error = error;
  return shot;
}

Shot moved(const Shot& shot, const Placement& of_a, const Placement& of_b) {
  Shot result = shot;
  result.a = transformed(*shot.a, of_a);
  result.b = transformed(*shot.b, of_b);
  result.X_AB = product(product(of_a, shot.X_AB), inverse(of_b));
  const Eigen::Matrix3d R = of_a.pose().R;
  if (result.truth.push) result.truth.push = R * *shot.truth.push;
  result.turn = R * shot.turn;
  // The product of three placements rounds at the size of its factors, which may be larger than that of the result.
  result.truth.error += k_roundings * std::numeric_limits<double>::epsilon() * (of_a.t.norm() + of_b.t.norm());
  return result;
}

Shot swapped(const Shot& shot) {
  Shot result = shot;
  std::swap(result.a, result.b);
  std::swap(result.truth.depth_of_a, result.truth.depth_of_b);
  result.X_AB = inverse(shot.X_AB);
  const Eigen::Matrix3d R = result.X_AB.pose().R;
  if (result.truth.push) result.truth.push = -(R * *shot.truth.push);
  result.turn = -R * shot.turn;
  return result;
}

Shot scaled(const Shot& shot, double factor) {
  Shot result = shot;
  result.a = transformed(*shot.a, {}, factor);
  result.b = shot.a == shot.b ? result.a : transformed(*shot.b, {}, factor);
  result.X_AB.t *= factor;
  result.truth.gap *= factor;
  result.truth.distance *= factor;
  result.truth.volume *= factor * factor * factor;
  result.truth.depth_of_a *= factor;
  result.truth.depth_of_b *= factor;
  result.truth.error *= factor;
  result.scale *= factor;
  return result;
}

}  // namespace sixdof::stability
