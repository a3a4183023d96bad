#include <sixdof/configuration/slope_bounds.h>

#include <algorithm>

namespace sixdof {
namespace {

/// Sums of areas and depths are rounded by some 1e-16 of the mesh's size per triangle: far below this share of it.
constexpr double k_rounding = 1e-9;

}  // namespace

std::size_t ReachTable::bin(double depth) const {
  return static_cast<std::size_t>(std::clamp(depth * bins_per_length_, 0.0, static_cast<double>(k_bins - 1)));
}

ReachTable::ReachTable(const Mesh& mesh, std::span<const Eigen::Vector3d> areas, const Eigen::Vector3d& forward) {
  std::vector<double> heights;
  heights.reserve(mesh.vertices().size());
  for (const Eigen::Vector3d& p : mesh.vertices()) heights.push_back(forward.dot(p));
  const auto [back, front] = std::ranges::minmax(heights);
  front_ = front - forward.dot(mesh.center());
  bins_per_length_ = static_cast<double>(k_bins) / std::max(front - back, k_rounding * mesh.diagonal());
  for (std::size_t t = 0; t < areas.size(); ++t) {
    const Triangle& corners = mesh.triangles()[t];
    const double top = std::max({heights[corners[0]], heights[corners[1]], heights[corners[2]]});
    const double projected = areas[t].dot(forward);
    // One rounding's width nearer than it is.
    const std::size_t i = bin(front - top - k_rounding * mesh.diagonal());
    (projected > 0.0 ? leading_ : trailing_)[i] += (1.0 + k_rounding) * std::abs(projected);
  }
  for (std::size_t i = 1; i < k_bins; ++i) {
    leading_[i] += leading_[i - 1];
    trailing_[i] += trailing_[i - 1];
  }
}

std::vector<Eigen::Vector3d> area_vectors(const Mesh& mesh) {
  std::vector<Eigen::Vector3d> areas;
  areas.reserve(mesh.triangles().size());
  for (const Triangle& t : mesh.triangles()) {
    const Eigen::Vector3d& p = mesh.vertices()[t[0]];
    areas.push_back(0.5 * (mesh.vertices()[t[1]] - p).cross(mesh.vertices()[t[2]] - p));
  }
  return areas;
}

SlopeBounds SlopeBounds::at(const ReachTable& a, const ReachTable& b, double depth) {
  return {.rise = std::min(a.leading(depth), b.leading(depth)), .fall = std::min(a.trailing(depth), b.trailing(depth))};
}

double SlopeBounds::peak(double outer, double inner, double way) const {
  // Two lines, rising from the begin and falling to the end, meet at the peak.
  if (!(rise + fall > 0.0)) return std::max(outer, inner);
  const double at = std::clamp((inner + fall * way - outer) / (rise + fall), 0.0, way);
  return std::max({outer, inner, outer + rise * at});
}

}  // namespace sixdof
