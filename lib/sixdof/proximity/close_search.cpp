#include <sixdof/proximity/close_search.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <sixdof/geometry/closest_point.h>
#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/proximity/sorted_stack.h>

namespace sixdof::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Rounding of a bound, relative to the sizes and the distance of the bodies: about 20 roundings of 1.1e-16 in
/// projections, and k_triangle_distance_error of the distances that it bounds.
constexpr double k_rounding = 6e-15;
/// Rounding of transformed corners and of the shift, relative to the distances from the origins: 16 for each.
constexpr double k_offset_rounding = 4e-15;

bool is_leaf(const CloseVolume& v) { return (v.volume & CloseVolume::k_leaf) != 0; }
bool is_triangle(const CloseVolume& v) { return v.triangle != CloseVolume::k_whole; }

const Tree::Leaf& leaf_of(const Tree& tree, const CloseVolume& v) {
  return tree.leaves()[v.volume - CloseVolume::k_leaf];
}

const Tree::Volume& volume_of(const Tree& tree, const CloseVolume& v) {
  return is_leaf(v) ? leaf_of(tree, v).volume : tree.nodes()[v.volume].volume;
}

/// In the axes of its own mesh, relative to the centre of its tree.
CloseShape shape_of(const Tree::Volume& v) {
  CloseShape shape;
  Vector3d half;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    const auto lower = static_cast<double>(v.lower[k]), upper = static_cast<double>(v.upper[k]);
    shape.center[axis] = 0.5 * (lower + upper);
    half[axis] = 0.5 * (upper - lower);
    shape.normal[axis] = static_cast<double>(v.normal[k]);
  }
  const double along = shape.normal.dot(shape.center);
  shape.slab_lower = static_cast<double>(v.slab_lower) - along;
  shape.slab_upper = static_cast<double>(v.slab_upper) - along;
  shape.squared_size = 4.0 * half.squaredNorm();
  shape.arms = half.asDiagonal();
  shape.arms_on_normal = half.cwiseProduct(shape.normal);
  return shape;
}

CloseShape shape_of(const TriangleCorners& corners) {
  CloseShape shape;
  shape.is_triangle = true;
  shape.center = (corners[0] + corners[1] + corners[2]) / 3.0;
  for (int i = 0; i < 3; ++i) shape.arms.col(i) = corners[static_cast<std::size_t>(i)] - shape.center;
  const Vector3d u = corners[1] - corners[0], v = corners[2] - corners[0];
  shape.normal = u.cross(v);
  const double length = shape.normal.norm();
  // Normalized once more: the first quotient of a needle may be off by more than a rounding.
  shape.normal = length > 0.0 ? Vector3d((shape.normal / length).normalized()) : Vector3d(Vector3d::Zero());
  shape.squared_size = std::max({u.squaredNorm(), v.squaredNorm(), (v - u).squaredNorm()});
  return shape;
}

/// From where two boxes, given by the difference d of their centres and the sum of their half extents, are closest;
/// zero if they overlap.
Vector3d between_boxes(const Vector3d& d, const Vector3d& half) {
  Vector3d gap;
  for (int k = 0; k < 3; ++k) gap[k] = std::copysign(std::max(std::abs(d[k]) - half[k], 0.0), d[k]);
  return gap;
}

}  // namespace

double CloseShape::reach(const Vector3d& n) const {
  const Vector3d along_arms = arms.transpose() * n;
  if (is_triangle) return along_arms.maxCoeff();
  const double along = n.dot(normal);
  const double in_slab =
      std::max(along * slab_lower, along * slab_upper) + (along_arms - along * arms_on_normal).cwiseAbs().sum();
  return std::min(along_arms.cwiseAbs().sum(), in_slab);
}

CloseShape shape_in_own_axes(const Tree& tree, const CloseVolume& v) { return shape_of(volume_of(tree, v)); }

CloseBounds::CloseBounds(const Tree& a, const Tree& b, const Pose& X_AB, const Vector3d& sweep)
    : a_(a), b_(b), X_AB_(X_AB), shift_(X_AB * b.center() - a.center()), sweep_(sweep) {
  // Slabs of B are rotated as if R were exactly orthogonal.
  const double defect = (X_AB.R.transpose() * X_AB.R - Matrix3d::Identity()).cwiseAbs().sum();
  slack_ = k_rounding * (a.radius() + b.radius() + shift_.norm() + sweep.norm()) + defect * b.radius() +
           k_offset_rounding * (a.center().norm() + b.center().norm() + X_AB.t.norm());
}

CloseShape CloseBounds::shape_of_a(const CloseVolume& v) const {
  if (!is_triangle(v)) return shape_in_own_axes(a_, v);
  const Tree::Corners& c = a_.corners()[v.triangle];
  return shape_of(TriangleCorners{c[0] - a_.center(), c[1] - a_.center(), c[2] - a_.center()});
}

CloseShape CloseBounds::shape_of_b(const CloseVolume& v) const {
  if (is_triangle(v)) {
    const Tree::Corners& c = b_.corners()[v.triangle];
    TriangleCorners corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = X_AB_.R * (c[i] - b_.center()) + shift_;
    return shape_of(corners);
  }
  CloseShape shape = shape_in_own_axes(b_, v);
  shape.center = X_AB_.R * shape.center + shift_;
  shape.arms = X_AB_.R * shape.arms;
  shape.normal = X_AB_.R * shape.normal;
  return shape;
}

double CloseBounds::lower_bound(const CloseShape& a, const CloseShape& b, const Vector3d& guess, double enough) const {
  const Vector3d start = b.center - a.center;
  const double squared_sweep = sweep_.squaredNorm();
  // Where the centres are closest.
  const double fraction = squared_sweep > 0.0 ? std::clamp(-start.dot(sweep_) / squared_sweep, 0.0, 1.0) : 0.0;
  const Vector3d d = start + fraction * sweep_;
  double lower = -std::numeric_limits<double>::infinity();
  // Returns true if the gap along n, taken with the sign that points from A to B, is enough.
  const auto try_axis = [&](const Vector3d& n) {
    const double length = n.norm();
    if (!(length > std::numeric_limits<double>::min())) return false;
    const Vector3d unit = (d.dot(n) < 0.0 ? -1.0 / length : 1.0 / length) * n;
    const double back = std::min(unit.dot(sweep_), 0.0);
    lower = std::max(lower, unit.dot(start) + back - a.reach(unit) - b.reach(-unit) - slack_);
    return lower > enough;
  };
  if (try_axis(guess)) return lower;
  const auto corners = [](const CloseShape& t) {
    return Tree::Corners{t.center + t.arms.col(0), t.center + t.arms.col(1), t.center + t.arms.col(2)};
  };
  if (a.is_triangle && try_axis(b.center - closest_point_on_triangle(b.center, corners(a)))) return lower;
  if (b.is_triangle && try_axis(closest_point_on_triangle(a.center, corners(b)) - a.center)) return lower;
  if (try_axis(a.normal) || try_axis(b.normal)) return lower;
  if (!a.is_triangle && !b.is_triangle) {
    if (try_axis(d)) return lower;
    const auto half = [](const Matrix3d& arms) { return Vector3d(arms.cwiseAbs().rowwise().sum()); };
    if (try_axis(between_boxes(d, half(a.arms) + half(b.arms)))) return lower;
    const Matrix3d to_b = X_AB_.R.transpose();
    try_axis(X_AB_.R * between_boxes(to_b * d, half(to_b * a.arms) + half(to_b * b.arms)));
  }
  return lower;
}

double CloseBounds::gap_along(const Vector3d& unit, TrianglePair pair) const {
  const auto reach = [](const Tree& tree, std::uint32_t triangle, const Vector3d& n) {
    double greatest = -std::numeric_limits<double>::infinity();
    for (const Vector3d& corner : tree.corners()[triangle])
      greatest = std::max(greatest, n.dot(corner - tree.center()));
    return greatest;
  };
  return unit.dot(shift_) - reach(a_, pair.a, unit) - reach(b_, pair.b, -(X_AB_.R.transpose() * unit)) - slack_;
}

std::uint32_t parts_of(const Tree& tree, const CloseVolume& v, std::array<CloseVolume, Tree::k_width>& parts) {
  std::uint32_t count = 0;
  if (is_leaf(v)) {
    const Tree::Child leaf = leaf_of(tree, v).child;
    for (; count < leaf.count(); ++count) parts[count] = {v.volume, leaf.first() + count};
  } else {
    const Tree::Node& node = tree.nodes()[v.volume];
    for (; count < node.child_count; ++count) parts[count] = CloseVolume::child_of(node, count);
  }
  return count;
}

bool search_closely(const Tree& tree_a, const Tree& tree_b, const CloseBounds& bounds, std::uint32_t a, std::uint32_t b,
                    CloseVisitor& visitor, std::vector<ClosePair>& stack) {
  stack.assign(1, {{a}, {b}, -std::numeric_limits<double>::infinity()});
  std::array<CloseVolume, Tree::k_width> children;
  while (!stack.empty()) {
    const ClosePair top = stack.back();
    stack.pop_back();
    if (top.lower > visitor.largest_of_interest()) continue;
    if (top.is_of_triangles()) {
      if (visitor.visit_triangles({top.a.triangle, top.b.triangle})) return true;
      continue;
    }
    if (visitor.prune_volumes(top.a.volume, top.b.volume)) continue;

    visitor.count_expansion();
    const CloseShape shape_a = bounds.shape_of_a(top.a);
    const CloseShape shape_b = bounds.shape_of_b(top.b);
    const bool expands_a = is_triangle(top.b) || (!is_triangle(top.a) && shape_a.squared_size >= shape_b.squared_size);
    const Tree& tree = expands_a ? tree_a : tree_b;
    const CloseVolume& expanded = expands_a ? top.a : top.b;
    const std::uint32_t count = parts_of(tree, expanded, children);
    const std::size_t first = stack.size();
    for (std::uint32_t i = 0; i < count; ++i) {
      const double limit = visitor.largest_of_interest();
      const double lower =
          expands_a ? bounds.lower_bound(bounds.shape_of_a(children[i]), shape_b, visitor.direction(), limit)
                    : bounds.lower_bound(shape_a, bounds.shape_of_b(children[i]), visitor.direction(), limit);
      if (lower > limit) continue;
      push_sorted(stack, first,
                  expands_a ? ClosePair{children[i], top.b, lower} : ClosePair{top.a, children[i], lower});
    }
  }
  return false;
}

}  // namespace sixdof::detail
