#include <sixdof/algorithm/ist/cells.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>

#include <fmt/format.h>

#include <sixdof/algorithm/ist/sphere_index.h>
#include <sixdof/algorithm/load_or_build.h>
#include <sixdof/base/cache.h>
#include <sixdof/base/hash.h>
#include <sixdof/base/parallel.h>
#include <sixdof/geometry/closest_point.h>
#include <sixdof/geometry/tree.h>

namespace sixdof::ist {
namespace {

constexpr std::size_t k_rays = 96;          // per sphere, for an error of the cell's volume of some percent
constexpr int k_max_steps = 24;             // of a ray towards the surface
constexpr double k_near_surface = 0.02;     // in radii: a ray ends at this distance from the surface
constexpr double k_rounding = 1.0 - 1e-12;  // another sphere is nearer if its distance is smaller by this factor

/// Near-uniform unit vectors (a Fibonacci lattice), rotated by `offset` about z so that spheres have different ones.
Eigen::Vector3d direction(std::size_t i, double offset) {
  constexpr double k_golden_angle = std::numbers::pi * (3.0 - 2.23606797749978969);
  const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(k_rays);
  const double angle = offset + k_golden_angle * static_cast<double>(i);
  const double radius = std::sqrt(1.0 - z * z);
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

class Cells {
 public:
  Cells(const Mesh& mesh, const Tree& tree, std::span<const Sphere> spheres) : tree_(tree), index_(mesh.diagonal()) {
    for (const Sphere& s : spheres) index_.insert(s);
  }

  /// Volume of the cell of sphere `i` without the sphere.
  double gap(std::size_t i) const {
    const Sphere& sphere = index_.spheres()[i];
    const double cube = sphere.radius * sphere.radius * sphere.radius;
    double sum = 0.0;
    for (std::size_t k = 0; k < k_rays; ++k) {
      const double length = ray(sphere, direction(k, static_cast<double>(i)));
      sum += length * length * length - cube;
    }
    return 4.0 / 3.0 * std::numbers::pi * sum / static_cast<double>(k_rays);
  }

 private:
  /// Distance from the sphere's centre to the end of its cell in direction `u`.
  double ray(const Sphere& sphere, const Eigen::Vector3d& u) const {
    double length = sphere.radius;
    for (int step = 0; step < k_max_steps; ++step) {
      // Steps are at most a radius: another sphere is mostly nearer than that.
      const auto surface = closest_point(tree_, sphere.center + length * u, sphere.radius);
      const double clearance = surface ? surface->distance : sphere.radius;
      if (clearance < k_near_surface * sphere.radius) return length;
      length += clearance;
      if (const double end = bisector(sphere, u, length); end < length) return end;
    }
    return length;
  }

  /// The smallest length along the ray at which another sphere's surface is equally near, at most `length`. Every step
  /// finds the sphere nearest to the end of the ray and shortens the ray to the bisector with it.
  double bisector(const Sphere& sphere, const Eigen::Vector3d& u, double length) const {
    while (true) {
      const auto nearest = index_.nearest(sphere.center + length * u, (length - sphere.radius) * k_rounding);
      if (nearest.sphere < 0) return length;
      const Sphere& other = index_.spheres()[static_cast<std::size_t>(nearest.sphere)];
      // |c + l u - c'| - r' = l - r, squared, is linear in l.
      const Eigen::Vector3d offset = other.center - sphere.center;
      const double difference = sphere.radius - other.radius;
      const double slope = 2.0 * (offset.dot(u) - difference);
      const double shorter = (offset.squaredNorm() - difference * difference) / slope;
      if (!(shorter < length)) return length;
      length = std::max(shorter, sphere.radius);
    }
  }

  const Tree& tree_;
  SphereIndex index_;
};

}  // namespace

std::vector<double> cell_weights(const Mesh& mesh, std::span<const Sphere> spheres) {
  const Tree tree(mesh);
  const Cells cells(mesh, tree, spheres);
  std::vector<double> gaps(spheres.size());
  parallel::for_each(spheres.size(), [&](std::size_t i) { gaps[i] = cells.gap(i); });
  double filled = 0.0, unfilled = 0.0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    filled += spheres[i].volume();
    unfilled += gaps[i];
  }
  const double scale = unfilled > 0.0 ? std::max(0.0, mesh.volume() - filled) / unfilled : 0.0;
  std::vector<double> weights(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) weights[i] = 1.0 + scale * gaps[i] / spheres[i].volume();
  return weights;
}

std::vector<double> cached_cell_weights(const Mesh& mesh, std::span<const Sphere> spheres) {
  ContentHash hash;
  for (const Sphere& s : spheres) {
    const double values[] = {s.center.x(), s.center.y(), s.center.z(), s.radius};
    hash.add_values(std::span<const double>(values));
  }
  // Increase the version whenever the weights of the same mesh and spheres change.
  const std::string key = fmt::format("2 {} spheres={}", mesh.hash(), hash.hex());
  const auto pack = [](const std::vector<double>& weights) {
    CacheEntry entry;
    entry.put("weights", weights);
    return entry;
  };
  const auto unpack = [&](CacheEntry entry) -> std::optional<std::vector<double>> {
    std::vector<double> weights = entry.take<double>("weights");
    if (weights.size() != spheres.size()) return std::nullopt;
    return weights;
  };
  return load_or_build(
      "ist-cells", key, [&] { return cell_weights(mesh, spheres); }, pack, unpack);
}

}  // namespace sixdof::ist
