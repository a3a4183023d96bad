#include <sixdof/oracle/free_translation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Dense>

namespace sixdof::detail {
namespace {

using Eigen::Vector3d;

/// Violations of a plane that count as rounding, relative to the largest offset.
constexpr double k_plane_rounding = 1e-12;
/// Planes of a slide, at most: the oldest is dropped.
constexpr std::size_t k_most_planes = 10;
constexpr int k_most_slides = 40;
/// Distances from the planes at which a slide moves, over the length of the translation, one slide after the other.
/// Motions along a face that touches it take long; so they keep this margin.
constexpr std::array<double, 3> k_margins{1e-4, 1e-7, 1e-10};
/// A slide starts so many margins farther out: at a contact, motions end at once and normals are those of rounding.
constexpr double k_retreat = 2.0;
/// By how much of a motion its end is drawn back where exact yes/no finds a contact: at first, and how often.
constexpr double k_back = 1e-10;
constexpr int k_most_backs = 8;

/// The shortest vector on the planes; none where they are nearly parallel.
std::optional<Vector3d> on_planes(std::span<const ContactPlane* const> planes) {
  if (planes.size() == 1) return planes[0]->offset * planes[0]->normal;
  Eigen::Matrix3d products = Eigen::Matrix3d::Identity();
  Vector3d offsets = Vector3d::Zero();
  for (std::size_t i = 0; i < planes.size(); ++i) {
    offsets[static_cast<int>(i)] = planes[i]->offset;
    for (std::size_t j = 0; j < planes.size(); ++j) {
      products(static_cast<int>(i), static_cast<int>(j)) = planes[i]->normal.dot(planes[j]->normal);
    }
  }
  if (std::abs(products.determinant()) < k_plane_rounding) return std::nullopt;
  const Vector3d factors = products.partialPivLu().solve(offsets);
  Vector3d x = Vector3d::Zero();
  for (std::size_t i = 0; i < planes.size(); ++i) x += factors[static_cast<int>(i)] * planes[i]->normal;
  return x;
}

}  // namespace

std::optional<Vector3d> shortest_beyond(std::span<const ContactPlane> planes) {
  double scale = 0.0;
  for (const ContactPlane& plane : planes) scale = std::max(scale, std::abs(plane.offset));
  const double slack = k_plane_rounding * scale;
  std::optional<Vector3d> shortest;
  const auto consider = [&](const std::optional<Vector3d>& x) {
    if (!x || (shortest && x->squaredNorm() >= shortest->squaredNorm())) return;
    // Points on three planes that are nearly parallel are off by more than the slack, and fail here.
    if (std::ranges::all_of(planes, [&](const ContactPlane& p) { return p.normal.dot(*x) >= p.offset - slack; })) {
      shortest = x;
    }
  };
  consider(Vector3d(Vector3d::Zero()));
  for (std::size_t i = 0; i < planes.size(); ++i) {
    consider(on_planes(std::array{&planes[i]}));
    for (std::size_t j = 0; j < i; ++j) {
      consider(on_planes(std::array{&planes[i], &planes[j]}));
      for (std::size_t k = 0; k < j; ++k) consider(on_planes(std::array{&planes[i], &planes[j], &planes[k]}));
    }
  }
  return shortest;
}

FreeTranslations::FreeTranslations(const DistanceOracle& oracle)
    : oracle_(oracle), query_(oracle), cast_(oracle.tree_a(), oracle.tree_b()) {}

std::optional<Vector3d> FreeTranslations::crossing(const Pose& X_AB, const Vector3d& d) {
  const Separation closest = query_.distance(moved(X_AB, d), false);
  if (closest.distance > 0.0) return std::nullopt;
  return closest.witness_a;
}

FreeTranslations::Stop FreeTranslations::move(const Pose& X_AB, const Vector3d& from, const Vector3d& to) {
  ++casts_;
  const Vector3d way = to - from;
  const Outcome<Impact> impact = cast_.find({.start = moved(X_AB, from), .translation = way});
  if (!impact.ok()) return {.d = from, .blocked = true};
  const bool hit = impact.value.hit;
  double t = hit ? impact.value.t : 1.0;
  double back = k_back;
  for (int i = 0; i < k_most_backs && t > 0.0; ++i, back *= 8.0) {
    const Vector3d d = t == 1.0 ? to : Vector3d(from + t * way);
    if (is_free(X_AB, d)) return {.d = d, .blocked = hit, .normal = impact.value.normal};
    t -= back;
  }
  return {.d = from, .blocked = true, .normal = impact.value.normal};
}

FreeTranslations::Stop FreeTranslations::approach(const Pose& X_AB, const Vector3d& direction) {
  const Tree &a = oracle_.tree_a(), &b = oracle_.tree_b();
  // The balls around both trees are apart there.
  const double far = 1.01 * (a.radius() + b.radius() + (X_AB * b.center() - a.center()).norm());
  return move(X_AB, far * direction, Vector3d::Zero());
}

Vector3d FreeTranslations::slide(const Pose& X_AB, const Vector3d& d, double margin) {
  Vector3d current = d;
  std::vector<ContactPlane> planes;
  bool moved_since = false;  // since the planes were found
  for (int i = 0; i < k_most_slides; ++i) {
    const std::optional<Vector3d> target = shortest_beyond(planes);
    if (!target || !(target->norm() < current.norm() - margin)) {
      if (!moved_since) break;
      planes.clear();
      moved_since = false;
      continue;
    }
    const Stop stop = move(X_AB, current, *target);
    if (stop.d.norm() <= current.norm()) {
      moved_since = moved_since || (stop.d - current).norm() > margin;
      current = stop.d;
    }
    if (!stop.blocked) continue;
    if (stop.normal.isZero(0.0)) break;
    if (planes.size() == k_most_planes) planes.erase(planes.begin());
    planes.push_back({stop.normal, stop.normal.dot(stop.d) + margin});
  }
  return current;
}

Vector3d FreeTranslations::descend(const Pose& X_AB, const Vector3d& d) {
  Vector3d current = d;
  for (const double margin : k_margins) {
    const Vector3d back = (1.0 + k_retreat * margin) * current;
    const Vector3d next = slide(X_AB, is_free(X_AB, back) ? back : current, margin * current.norm());
    if (next.norm() < current.norm()) current = next;
  }
  const Vector3d last = move(X_AB, current, Vector3d::Zero()).d;
  return last.norm() < current.norm() ? last : current;
}

}  // namespace sixdof::detail
