#include <sixdof/algorithm/vps/surface_index.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace sixdof::vps {
namespace {

constexpr std::size_t k_stack = 128;  // two entries per level of a balanced tree of 2^32 triangles, doubled

Eigen::Vector3d closest_point_on_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double length2 = ab.squaredNorm();
  return length2 > 0.0 ? Eigen::Vector3d(a + std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) * ab) : a;
}

/// Solid angle of a triangle seen from the origin (van Oosterom and Strackee 1983), positive if it turns its back.
double solid_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace

Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                          const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return closest_point_on_segment(p, a, b);
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return closest_point_on_segment(p, a, c);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return closest_point_on_segment(p, b, c);
  const double sum = va + vb + vc;
  if (!(sum > 0.0)) {
    const Eigen::Vector3d on_ab = closest_point_on_segment(p, a, b), on_ac = closest_point_on_segment(p, a, c);
    return (p - on_ab).squaredNorm() <= (p - on_ac).squaredNorm() ? on_ab : on_ac;
  }
  return a + (vb / sum) * ab + (vc / sum) * ac;
}

SurfaceIndex::SurfaceIndex(const Mesh& mesh) : mesh_(&mesh), order_(mesh.triangles().size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  middles_.reserve(order_.size());
  for (const std::uint32_t t : order_) {
    const auto [a, b, c] = corners(t);
    middles_.push_back((a + b + c) / 3.0);
  }
  nodes_.reserve(order_.size());
  build(0, static_cast<std::uint32_t>(order_.size()));
  middles_ = {};
}

std::array<Eigen::Vector3d, 3> SurfaceIndex::corners(std::uint32_t triangle) const {
  const Triangle& t = mesh_->triangles()[triangle];
  return {mesh_->vertices()[t[0]], mesh_->vertices()[t[1]], mesh_->vertices()[t[2]]};
}

std::uint32_t SurfaceIndex::build(std::uint32_t begin, std::uint32_t end) {
  const auto here = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Node node;
  node.begin = begin;
  node.end = end;
  Eigen::AlignedBox3d middles;
  double area = 0.0;
  for (std::uint32_t i = begin; i < end; ++i) {
    const auto [a, b, c] = corners(order_[i]);
    node.box.extend(a).extend(b).extend(c);
    middles.extend(middles_[order_[i]]);
    const Eigen::Vector3d area_vector = 0.5 * (b - a).cross(c - a);
    node.area_vector += area_vector;
    node.center += area_vector.norm() * middles_[order_[i]];
    area += area_vector.norm();
  }
  node.center = area > 0.0 ? Eigen::Vector3d(node.center / area) : node.box.center();
  for (std::uint32_t i = begin; i < end; ++i) {
    for (const Eigen::Vector3d& corner : corners(order_[i])) {
      node.radius = std::max(node.radius, (corner - node.center).norm());
    }
  }
  if (end - begin > k_leaf_triangles) {
    int axis = 0;
    middles.sizes().maxCoeff(&axis);
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto less = [&](std::uint32_t i, std::uint32_t j) {
      return middles_[i][axis] != middles_[j][axis] ? middles_[i][axis] < middles_[j][axis] : i < j;
    };
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, less);
    build(begin, middle);
    node.second = build(middle, end);
  }
  nodes_[here] = node;
  return here;
}

SurfaceIndex::Closest SurfaceIndex::closest(const Eigen::Vector3d& p, std::uint32_t guess) const {
  const auto measure = [&](std::uint32_t t) {
    const auto [a, b, c] = corners(t);
    const Eigen::Vector3d point = closest_point_on_triangle(p, a, b, c);
    return Closest{point, t, (point - p).squaredNorm()};
  };
  Closest best = measure(guess);
  std::array<std::pair<double, std::uint32_t>, k_stack> stack;
  std::size_t top = 0;
  stack[top++] = {nodes_[0].box.squaredExteriorDistance(p), 0};
  while (top > 0) {
    const auto [bound, n] = stack[--top];
    if (bound >= best.squared_distance) continue;
    const Node& node = nodes_[n];
    if (node.leaf()) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const Closest candidate = measure(order_[i]);
        if (candidate.squared_distance < best.squared_distance) best = candidate;
      }
      continue;
    }
    std::pair<double, std::uint32_t> near{nodes_[n + 1].box.squaredExteriorDistance(p), n + 1};
    std::pair<double, std::uint32_t> far{nodes_[node.second].box.squaredExteriorDistance(p), node.second};
    if (far.first < near.first) std::swap(near, far);
    stack[top++] = far;
    stack[top++] = near;
  }
  return best;
}

double SurfaceIndex::winding_number(const Eigen::Vector3d& p) const {
  double angle = 0.0;
  std::array<std::uint32_t, k_stack> stack;
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::uint32_t n = stack[--top];
    const Node& node = nodes_[n];
    const Eigen::Vector3d offset = node.center - p;
    const double distance = offset.norm();
    if (distance > k_far_ratio * node.radius) {
      angle += node.area_vector.dot(offset) / (distance * distance * distance);
    } else if (node.leaf()) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const auto [a, b, c] = corners(order_[i]);
        angle += solid_angle(a - p, b - p, c - p);
      }
    } else {
      stack[top++] = node.second;
      stack[top++] = n + 1;
    }
  }
  return angle / (4.0 * std::numbers::pi);
}

}  // namespace sixdof::vps
