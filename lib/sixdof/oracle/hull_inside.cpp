#include <sixdof/oracle/hull_inside.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <Eigen/Geometry>
#include <boost/container/static_vector.hpp>

namespace sixdof::detail {
namespace {

using Eigen::Vector3d;

constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// Of the search for an axis between a hull and a triangle that its plane does not separate.
constexpr int k_axis_steps = 16;
/// Boxes are enlarged by this part of the lengths that are added: above the rounding to floats.
constexpr double k_float_slack = 4e-7;

struct Interval {
  double low = k_infinity, high = -k_infinity;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

template <class Points>
Interval project(const Points& points, const Vector3d& axis, const Vector3d& origin) {
  Interval interval;
  for (const Vector3d& p : points) interval.add(axis.dot(p - origin));
  return interval;
}

/// Whether the gap between both along the axis exceeds `clearance`; the axis has any length.
bool separates(const Vector3d& axis, const Tree::Corners& triangle, std::span<const Vector3d> points,
               double clearance) {
  const Interval t = project(triangle, axis, triangle[0]), h = project(points, axis, triangle[0]);
  return std::max(h.low - t.high, t.low - h.high) > clearance * axis.norm();
}

/// Towards the point of the difference {hull - triangle} nearest to 0 (Frank and Wolfe 1956), until its direction
/// separates both.
bool finds_axis(const Tree::Corners& triangle, std::span<const Vector3d> points, double clearance) {
  Vector3d x = points[0] - triangle[0];
  for (int i = 0; i < k_axis_steps; ++i) {
    const Vector3d* nearest = &points[0];
    for (const Vector3d& p : points) {
      if (x.dot(p) < x.dot(*nearest)) nearest = &p;
    }
    const Vector3d* farthest = &triangle[0];
    for (const Vector3d& v : triangle) {
      if (x.dot(v) > x.dot(*farthest)) farthest = &v;
    }
    const Vector3d support = *nearest - *farthest, way = support - x;
    if (x.dot(support) > clearance * x.norm()) return true;
    const double length = way.squaredNorm();
    if (!(length > 0.0)) return false;
    x += std::clamp(-x.dot(way) / length, 0.0, 1.0) * way;
  }
  return false;
}

bool crosses_separate(const Tree::Corners& triangle, std::span<const Vector3d> points, double clearance) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d edge = triangle[(k + 1) % 3] - triangle[k];
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = i + 1; j < points.size(); ++j) {
        if (separates(edge.cross(points[j] - points[i]), triangle, points, clearance)) return true;
      }
    }
  }
  return false;
}

/// Along the normals of the hull's faces, which are among those of all triples of points.
bool faces_separate(const Tree::Corners& triangle, std::span<const Vector3d> points, double clearance) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      for (std::size_t k = j + 1; k < points.size(); ++k) {
        const Vector3d normal = (points[j] - points[i]).cross(points[k] - points[i]);
        if (separates(normal, triangle, points, clearance)) return true;
      }
    }
  }
  return false;
}

/// The hull of the points against volumes of the tree.
struct HullBounds {
  std::array<Vector3d, k_most_hull_points> local;  ///< Relative to the tree's centre.
  std::size_t count;
  std::array<float, 3> lower, upper;
  double clearance;

  HullBounds(const Tree& tree, std::span<const Vector3d> points, double distance)
      : count(points.size()), clearance(distance) {
    for (std::size_t i = 0; i < count; ++i) local[i] = points[i] - tree.center();
    for (int k = 0; k < 3; ++k) {
      Interval interval;
      for (std::size_t i = 0; i < count; ++i) interval.add(local[i][k]);
      const double slack = clearance + k_float_slack * (tree.radius() + std::max(-interval.low, interval.high));
      lower[static_cast<std::size_t>(k)] = static_cast<float>(interval.low - slack);
      upper[static_cast<std::size_t>(k)] = static_cast<float>(interval.high + slack);
    }
  }

  bool is_apart(const Tree::Node& node, std::size_t i) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (node.lower[k][i] > upper[k] || node.upper[k][i] < lower[k]) return true;
    }
    const Vector3d normal(static_cast<double>(node.normal[0][i]), static_cast<double>(node.normal[1][i]),
                          static_cast<double>(node.normal[2][i]));
    const Interval h = project(std::span(local.data(), count), normal, Vector3d::Zero());
    return h.low > static_cast<double>(node.slab_upper[i]) + clearance ||
           h.high < static_cast<double>(node.slab_lower[i]) - clearance;
  }
};

}  // namespace

bool is_hull_clear(const Tree::Corners& triangle, std::span<const Vector3d> points, double clearance) {
  const Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  return separates(normal, triangle, points, clearance) || finds_axis(triangle, points, clearance) ||
         crosses_separate(triangle, points, clearance) || faces_separate(triangle, points, clearance);
}

bool is_hull_clear(const Tree& tree, std::span<const Vector3d> points, double clearance) {
  const HullBounds hull(tree, points, clearance);
  constexpr std::size_t k_deepest_tree = 64;
  boost::container::static_vector<std::uint32_t, k_deepest_tree * Tree::k_width> stack;
  stack.push_back(0);
  std::size_t tested = 0;
  while (!stack.empty()) {
    const Tree::Node& node = tree.nodes()[stack.back()];
    stack.pop_back();
    for (std::size_t i = 0; i < node.child_count; ++i) {
      if (hull.is_apart(node, i)) continue;
      const Tree::Child child = node.child[i];
      if (!child.is_leaf()) {
        stack.push_back(child.node());
        continue;
      }
      for (std::uint32_t t = child.first(); t < child.first() + child.count(); ++t) {
        if (++tested > k_most_hull_triangles) return false;
        if (!is_hull_clear(tree.corners()[t], points, clearance)) return false;
      }
    }
  }
  return true;
}

}  // namespace sixdof::detail
