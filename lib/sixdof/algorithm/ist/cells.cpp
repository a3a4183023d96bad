#include <sixdof/algorithm/ist/cells.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include <sixdof/algorithm/ist/sphere_index.h>
#include <sixdof/base/cache.h>
#include <sixdof/base/hash.h>
#include <sixdof/base/parallel.h>
#include <sixdof/geometry/closest_point.h>

namespace sixdof::ist {
namespace {

constexpr std::size_t k_rays = 96;          // per sphere: its volume is then good to some percent
constexpr int k_steps = 24;                 // towards the surface, at most
constexpr double k_near_surface = 0.02;     // of the radius: a ray that comes so close has arrived
constexpr double k_rounding = 1.0 - 1e-12;  // another sphere is nearer if it is so by more than this

/// Near-uniform unit vectors (a Fibonacci lattice), turned by `turn` about z so that spheres do not share them.
Eigen::Vector3d direction(std::size_t i, double turn) {
  constexpr double k_golden_angle = std::numbers::pi * (3.0 - 2.23606797749978969);
  const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(k_rays);
  const double angle = turn + k_golden_angle * static_cast<double>(i);
  const double across = std::sqrt(1.0 - z * z);
  return {across * std::cos(angle), across * std::sin(angle), z};
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
    for (int step = 0; step < k_steps; ++step) {
      // Another sphere is mostly nearer than a radius.
      const auto surface = closest_point(tree_, sphere.center + length * u, sphere.radius);
      const double room = surface ? surface->distance : sphere.radius;
      if (room < k_near_surface * sphere.radius) return length;
      length += room;
      if (const double end = bisector(sphere, u, length); end < length) return end;
    }
    return length;
  }

  /// The least length at which another sphere's surface is as near, at most `length`; that is reached from outside in
  /// a few steps, each to the place midway between this sphere and the one that is nearest.
  double bisector(const Sphere& sphere, const Eigen::Vector3d& u, double length) const {
    while (true) {
      const auto nearest = index_.nearest(sphere.center + length * u, (length - sphere.radius) * k_rounding);
      if (nearest.sphere < 0) return length;
      const Sphere& other = index_.spheres()[static_cast<std::size_t>(nearest.sphere)];
      // |c + l u - c'| - r' = l - r, squared, is linear in l.
      const Eigen::Vector3d across = other.center - sphere.center;
      const double difference = sphere.radius - other.radius;
      const double slope = 2.0 * (across.dot(u) - difference);
      const double shorter = (across.squaredNorm() - difference * difference) / slope;
      if (!(shorter < length)) return length;
      length = std::max(shorter, sphere.radius);
    }
  }

  const Tree& tree_;
  SphereIndex index_;
};

}  // namespace

std::vector<double> cell_shares(const Mesh& mesh, const Tree& tree, std::span<const Sphere> spheres) {
  const Cells cells(mesh, tree, spheres);
  std::vector<double> gaps(spheres.size());
  parallel::for_each(spheres.size(), [&](std::size_t i) { gaps[i] = cells.gap(i); });
  double solid = 0.0, open = 0.0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    solid += spheres[i].volume();
    open += gaps[i];
  }
  const double scale = open > 0.0 ? std::max(0.0, mesh.volume() - solid) / open : 0.0;
  std::vector<double> shares(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) shares[i] = 1.0 + scale * gaps[i] / spheres[i].volume();
  return shares;
}

std::vector<double> cell_shares_cached(const Mesh& mesh, std::span<const Sphere> spheres) {
  constexpr const char* k_kind = "ist-cells";
  ContentHash hash;
  for (const Sphere& s : spheres) {
    const double values[] = {s.center.x(), s.center.y(), s.center.z(), s.radius};
    hash.add_values(std::span<const double>(values));
  }
  // Raise the number whenever the shares of the same mesh and spheres change.
  const std::string key = fmt::format("1 {} spheres={}", mesh.hash(), hash.hex());
  if (auto entry = load_cached(k_kind, key)) {
    std::vector<double> shares = entry->take<double>("shares");
    if (shares.size() == spheres.size()) return shares;
  }
  std::vector<double> shares = cell_shares(mesh, Tree(mesh), spheres);
  CacheEntry entry;
  entry.put("shares", shares);
  store_cached(k_kind, key, entry);
  return shares;
}

}  // namespace sixdof::ist
