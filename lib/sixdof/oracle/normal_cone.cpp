#include <sixdof/oracle/normal_cone.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <sixdof/geometry/closest_point.h>

namespace sixdof {
namespace {

using Eigen::Vector3d;

constexpr double k_degrees = 180.0 / std::numbers::pi;

/// Of angles and of components that should be zero.
constexpr double k_rounding = 1e-12;

double angle(const Vector3d& u, const Vector3d& v) { return k_degrees * std::atan2(u.cross(v).norm(), u.dot(v)); }

/// Distance of a point (relative to the tree's centre) from the box of a child.
double box_distance(const Tree::Node& node, std::size_t i, const Vector3d& p) {
  double squared = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double out =
        std::max({static_cast<double>(node.lower[k][i]) - p[k], p[k] - static_cast<double>(node.upper[k][i]), 0.0});
    squared += out * out;
  }
  return std::sqrt(squared);
}

void add_normal(const Tree::Corners& corners, std::vector<Vector3d>& normals, std::size_t first) {
  const Vector3d area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double size = area.stableNorm();
  if (!(size > 0.0)) return;
  const Vector3d normal = area / size;
  const bool known = std::any_of(normals.begin() + static_cast<std::ptrdiff_t>(first), normals.end(),
                                 [&](const Vector3d& each) { return (each - normal).norm() < k_same_normal; });
  if (!known) normals.push_back(normal);
}

/// Whether q is the projection of n on the cone: n - q leads away from all of it.
bool is_projection(const Vector3d& n, const Vector3d& q, std::span<const Vector3d> generators) {
  return std::ranges::all_of(generators, [&](const Vector3d& g) { return (n - q).dot(g) <= k_rounding; });
}

}  // namespace

void normals_near(const Tree& tree, const Vector3d& p, double slack, std::vector<Vector3d>& normals) {
  const std::optional<SurfacePoint> nearest = closest_point(tree, p);
  if (!nearest) return;
  const std::size_t first = normals.size();
  const double within = nearest->distance + slack;
  const Vector3d local = p - tree.center();
  const auto expand = [&](auto&& self, const Tree::Node& node) -> void {
    for (std::size_t i = 0; i < node.child_count; ++i) {
      if (box_distance(node, i, local) > within) continue;
      const Tree::Child child = node.child[i];
      if (!child.is_leaf()) {
        self(self, tree.nodes()[child.node()]);
        continue;
      }
      for (std::uint32_t k = child.first(); k < child.first() + child.count(); ++k) {
        const Tree::Corners& corners = tree.corners()[k];
        if ((closest_point_on_triangle(p, corners) - p).norm() <= within) add_normal(corners, normals, first);
      }
    }
  };
  expand(expand, tree.nodes()[0]);
}

double angle_to_cone(const Vector3d& n, std::span<const Vector3d> generators) {
  double nearest = 180.0;
  bool is_behind = true;  // of all generators: then the nearest direction is one of them
  for (const Vector3d& g : generators) {
    nearest = std::min(nearest, angle(n, g));
    is_behind = is_behind && n.dot(g) <= 0.0;
  }
  if (is_behind) return nearest;
  for (const Vector3d& g : generators) {
    if (const Vector3d on_ray = std::max(0.0, n.dot(g)) * g; is_projection(n, on_ray, generators)) return angle(n, g);
  }
  // On the face between two generators g and h, at x g + y h.
  for (std::size_t i = 0; i < generators.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vector3d &g = generators[i], &h = generators[j];
      const double c = g.dot(h), determinant = 1.0 - c * c;
      if (determinant < k_rounding) continue;
      const double x = (n.dot(g) - c * n.dot(h)) / determinant, y = (n.dot(h) - c * n.dot(g)) / determinant;
      if (x < 0.0 || y < 0.0) continue;
      if (const Vector3d q = x * g + y * h; is_projection(n, q, generators)) return angle(n, q);
    }
  }
  return 0.0;
}

}  // namespace sixdof
