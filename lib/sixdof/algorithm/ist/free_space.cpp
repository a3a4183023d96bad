#include <sixdof/algorithm/ist/free_space.h>

#include <algorithm>
#include <cmath>

#include <sixdof/geometry/closest_point.h>

namespace sixdof::ist {
namespace {

constexpr double k_bound_slack = 1.0 + 1e-12;
constexpr double k_reach = 3.0;               // of a look-up, in bounds of the first query that it serves
constexpr double k_rounding = 1e-9;           // far above that of a distance within the mesh, in radii of its tree
constexpr std::size_t k_most_triangles = 32;  // beyond it a search of the tree is faster

}  // namespace

ClearanceQuery::Clearance ClearanceQuery::operator()(const Eigen::Vector3d& p, double bound) {
  const double within = bound * k_bound_slack;
  double moved = (p - place_).norm();
  if (moved + within > reach_) {
    look_around(p, k_reach * within);
    moved = 0.0;
  }
  const auto sphere = nearest_sphere(p, moved, within);
  Eigen::Vector3d point;
  double distance = 0.0;
  if (nearest_on_surface(p, moved, std::max(0.0, sphere.clearance), point, distance)) {
    const Eigen::Vector3d offset = p - point;
    const Eigen::Vector3d away = distance > 0.0 ? Eigen::Vector3d(offset / distance) : Eigen::Vector3d::Zero();
    return {distance, {point, away, 0.0}};
  }
  if (sphere.sphere < 0) return {bound, {}};
  const Sphere& nearest = space_->spheres.spheres()[static_cast<std::size_t>(sphere.sphere)];
  return {sphere.clearance, {nearest.center, Eigen::Vector3d::Zero(), nearest.radius}};
}

void ClearanceQuery::look_around(const Eigen::Vector3d& p, double reach) {
  const double rounding = k_rounding * space_->tree.radius();
  place_ = p;
  reach_ = reach;
  spheres_.clear();
  space_->spheres.find_near(p, reach + rounding, spheres_);
  std::ranges::sort(spheres_, {}, &SphereIndex::Near::clearance);
  find_triangles(reach + rounding);
}

void ClearanceQuery::find_triangles(double reach) {
  triangles_.clear();
  few_triangles_ = for_triangles_near(space_->tree, place_, reach, [&](std::uint32_t position) {
    const auto& [a, b, c] = space_->tree.corners()[position];
    const Eigen::Vector3d lower = a.cwiseMin(b).cwiseMin(c), upper = a.cwiseMax(b).cwiseMax(c);
    const double least = (place_ - upper).cwiseMax(lower - place_).cwiseMax(0.0).norm();
    if (least < reach) triangles_.push_back({least, position});
    return triangles_.size() <= k_most_triangles;
  });
  std::ranges::sort(triangles_, {}, &NearTriangle::least);
}

SphereIndex::Nearest ClearanceQuery::nearest_sphere(const Eigen::Vector3d& p, double moved, double within) const {
  const double slack = moved + k_rounding * space_->tree.radius();
  SphereIndex::Nearest best{within};
  for (const SphereIndex::Near& s : spheres_) {
    if (s.clearance - slack > best.clearance) break;
    best.consider(s.sphere, p, s.index);
  }
  return best;
}

bool ClearanceQuery::nearest_on_surface(const Eigen::Vector3d& p, double moved, double within, Eigen::Vector3d& point,
                                        double& distance) const {
  if (!few_triangles_) {
    const auto surface = closest_point(space_->tree, p, within);
    if (surface) {
      point = surface->point;
      distance = surface->distance;
    }
    return surface.has_value();
  }
  // As closest_point() does.
  const double slack = moved + k_rounding * space_->tree.radius();
  double best_squared = within * within;
  double best = within;
  bool found = false;
  std::uint32_t best_position = 0;
  for (const NearTriangle& t : triangles_) {
    if (t.least - slack > best) break;
    const Eigen::Vector3d on = closest_point_on_triangle(p, space_->tree.corners()[t.position]);
    const double squared = (on - p).squaredNorm();
    if (squared < best_squared || (found && squared == best_squared && t.position < best_position)) {
      best_squared = squared;
      best = std::sqrt(squared);
      best_position = t.position;
      point = on;
      found = true;
    }
  }
  distance = best;
  return found;
}

}  // namespace sixdof::ist
