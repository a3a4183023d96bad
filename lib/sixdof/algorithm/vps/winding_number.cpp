#include <sixdof/algorithm/vps/winding_number.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace sixdof::vps {
namespace {

/// Signed solid angle of a triangle seen from p (van Oosterom and Strackee 1983), positive if p is behind it.
double solid_angle(const Tree::Corners& corners, const Eigen::Vector3d& p) {
  const Eigen::Vector3d a = corners[0] - p, b = corners[1] - p, c = corners[2] - p;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace

WindingNumber::WindingNumber(const Tree& tree) : tree_(&tree) {
  dipoles_.reserve(tree.nodes().size());
  for (const Tree::Node& node : tree.nodes()) {
    const auto triangles = tree.corners().subspan(node.first_triangle, node.triangle_count);
    Dipole& dipole = dipoles_.emplace_back();
    double area = 0.0;
    for (const auto& [a, b, c] : triangles) {
      const Eigen::Vector3d area_vector = 0.5 * (b - a).cross(c - a);
      dipole.area_vector += area_vector;
      dipole.center += area_vector.norm() / 3.0 * (a + b + c);
      area += area_vector.norm();
    }
    dipole.center = area > 0.0 ? Eigen::Vector3d(dipole.center / area) : triangles.front()[0];
    for (const Tree::Corners& corners : triangles) {
      for (const Eigen::Vector3d& corner : corners) {
        dipole.radius = std::max(dipole.radius, (corner - dipole.center).norm());
      }
    }
  }
}

double WindingNumber::at(const Eigen::Vector3d& p) const {
  constexpr std::size_t k_max_depth = 64;  // of the tree
  double angle = 0.0;
  std::array<std::uint32_t, k_max_depth * Tree::k_width> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t index = stack[--size];
    const Dipole& dipole = dipoles_[index];
    const Eigen::Vector3d offset = dipole.center - p;
    const double distance = offset.norm();
    if (distance > k_far_ratio * dipole.radius) {
      angle += dipole.area_vector.dot(offset) / (distance * distance * distance);
      continue;
    }
    const Tree::Node& node = tree_->nodes()[index];
    for (std::size_t i = 0; i < node.child_count; ++i) {
      const Tree::Child child = node.child[i];
      if (!child.is_leaf()) {
        stack[size++] = child.node();
        continue;
      }
      for (const Tree::Corners& corners : tree_->corners().subspan(child.first(), child.count())) {
        angle += solid_angle(corners, p);
      }
    }
  }
  return angle / (4.0 * std::numbers::pi);
}

}  // namespace sixdof::vps
