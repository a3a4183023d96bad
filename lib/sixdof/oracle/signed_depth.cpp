#include <sixdof/oracle/signed_depth.h>

#include <algorithm>
#include <cmath>

#include <sixdof/geometry/closest_point.h>
#include <sixdof/oracle/winding.h>

namespace sixdof::detail {
namespace {

/// Above the rounding of distances and of closest points, relative to the lengths that are added.
constexpr double k_slack = 1e-12;

}  // namespace

DepthNode SignedDepth::nearest(const Eigen::Vector3d& p, std::uint32_t triangle) const {
  const Triangle& t = a_->triangles()[triangle];
  const std::vector<Eigen::Vector3d>& v = a_->vertices();
  const Eigen::Vector3d start = closest_point_on_triangle(p, {v[t[0]], v[t[1]], v[t[2]]});
  const double scale = (p - tree_->center()).norm() + tree_->radius();
  const double within = (start - p).norm() * (1.0 + k_slack) + k_slack * scale;
  SurfacePoint found = closest_point(*tree_, p, within).value_or(SurfacePoint{});
  if (std::isinf(found.distance)) found = closest_point(*tree_, p).value_or(found);
  return {.p = p, .to_surface = found.point - p, .s = found.distance, .triangle = found.triangle};
}

bool SignedDepth::is_inside(const Eigen::Vector3d& p) { return winding_of_a(*tree_, p, scratch_) > 0; }

DepthNode SignedDepth::at(const Eigen::Vector3d& p, std::uint32_t triangle) {
  DepthNode node = nearest(p, triangle);
  if (is_inside(p)) node.s = -node.s;
  return node;
}

DepthNode SignedDepth::at(const Eigen::Vector3d& p, const DepthNode& known) {
  DepthNode node = nearest(p, known.triangle);
  const double way = (p - known.p).norm() * (1.0 + k_slack) + k_slack * tree_->radius();
  const bool same = std::max(node.s, std::abs(known.s)) > way;
  if (same ? known.s < 0.0 : is_inside(p)) node.s = -node.s;
  return node;
}

bool SignedDepth::is_outside(const Eigen::Vector3d& p, double radius) {
  const double within = radius * (1.0 + k_slack) + k_slack * ((p - tree_->center()).norm() + tree_->radius());
  return !closest_point(*tree_, p, within) && !is_inside(p);
}

}  // namespace sixdof::detail
