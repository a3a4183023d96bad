#include <sixdof/algorithm/ist/coverage.h>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace sixdof::ist {
namespace {

double gap(const Eigen::Vector3d& p, std::span<const Sphere> spheres) {
  double least = std::numeric_limits<double>::infinity();
  for (const Sphere& sphere : spheres) least = std::min(least, (p - sphere.center).norm() - sphere.radius);
  return std::max(0.0, least);
}

}  // namespace

double largest_gap(const Mesh& mesh, std::span<const Sphere> spheres) {
  constexpr std::size_t k_most_distances = 10'000'000, k_fewest_points = 16;
  const auto& points = mesh.vertices();
  const auto& triangles = mesh.triangles();
  const std::size_t all = points.size() + triangles.size();
  const std::size_t affordable = std::max(k_fewest_points, k_most_distances / std::max<std::size_t>(1, spheres.size()));
  const std::size_t step = (all + affordable - 1) / affordable;
  double largest = 0.0;
  for (std::size_t i = 0; i < all; i += step) {
    if (i < points.size()) {
      largest = std::max(largest, gap(points[i], spheres));
    } else {
      const auto [a, b, c] = triangles[i - points.size()];
      largest = std::max(largest, gap((points[a] + points[b] + points[c]) / 3.0, spheres));
    }
  }
  return largest;
}

}  // namespace sixdof::ist
