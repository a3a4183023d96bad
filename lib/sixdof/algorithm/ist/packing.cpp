#include <sixdof/algorithm/ist/packing.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <queue>
#include <random>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <sixdof/algorithm/ist/free_space.h>
#include <sixdof/algorithm/ist/prototype.h>
#include <sixdof/algorithm/preparation.h>
#include <sixdof/base/error.h>
#include <sixdof/base/hash.h>
#include <sixdof/base/parallel.h>
#include <sixdof/geometry/closest_point.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/winding.h>

namespace sixdof::ist {
namespace {

constexpr double k_margin = 1e-9;          // relative gap between a sphere and its obstacles, far above rounding
constexpr double k_start_depth = 1e-7;     // of a start point below the surface, in diagonals
constexpr double k_depth_rounding = 1e-6;  // relative rounding of that depth: coordinates have 1e-16 / 1e-7, with slack
constexpr double k_round_ratio = 0.9;      // a round inserts spheres of at least this fraction of the largest
constexpr std::size_t k_starts_per_sphere = 2;  // start points on the surface per sphere asked for
constexpr std::size_t k_min_starts = 2'000;

/// Start points just below the surface, one per equal part of its area (stratified sampling). min_clearance discards
/// points that may be beyond another wall.
std::vector<Start> surface_starts(const Mesh& mesh, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1.0p-53; };
  std::vector<Start> starts;
  starts.reserve(count);
  const double depth = k_start_depth * mesh.diagonal();
  const double area_per_start = mesh.area() / static_cast<double>(count);
  double passed = 0.0;
  double next = area_per_start * uniform();
  for (const Triangle& t : mesh.triangles()) {
    const Eigen::Vector3d& a = mesh.vertices()[t[0]];
    const Eigen::Vector3d& b = mesh.vertices()[t[1]];
    const Eigen::Vector3d& c = mesh.vertices()[t[2]];
    const Eigen::Vector3d cross = (b - a).cross(c - a);
    const double area = 0.5 * cross.norm();
    for (passed += area; next < passed; next += area_per_start) {
      double u = uniform(), v = uniform();
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      starts.push_back({a + u * (b - a) + v * (c - a) - cross * (depth / (2.0 * area)),
                        depth * (1.0 + k_depth_rounding), depth * (1.0 - k_depth_rounding)});
    }
  }
  return starts;
}

/// Appends start points on the surface of an inserted sphere, in the directions of a cube's corners.
void add_starts_around(const Sphere& sphere, std::vector<Start>& starts) {
  // Half-way into the sphere's margin: outside the sphere, but inside a surface that it touches.
  const double reach = sphere.radius * (1.0 + 0.5 * k_margin) / std::sqrt(3.0);
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d direction((corner & 1) != 0 ? reach : -reach, (corner & 2) != 0 ? reach : -reach,
                                    (corner & 4) != 0 ? reach : -reach);
    starts.push_back({sphere.center + direction, sphere.radius});
  }
}

class Packer {
 public:
  Packer(const Mesh& mesh, const Tree& tree, const PackingOptions& options)
      : mesh_(mesh),
        options_(options),
        min_radius_(options.smallest_radius * mesh.diagonal()),
        space_{tree, SphereIndex(mesh.diagonal())} {}

  Packing run() {
    add_prototypes(
        surface_starts(mesh_, std::max(k_min_starts, k_starts_per_sphere * options_.spheres), options_.seed));
    while (!queue_.empty() && !done()) insert_largest();
    const std::span<const Sphere> spheres = space_.spheres.spheres();
    Packing result{{spheres.begin(), spheres.end()}, total_volume(spheres) / mesh_.volume()};
    if (result.spheres.empty()) {
      throw BadMesh(fmt::format("{}: too thin for a sphere of radius {}", mesh_.name(), min_radius_));
    }
    return result;
  }

 private:
  bool done() const {
    return space_.spheres.spheres().size() >= options_.spheres || filled_ >= options_.fill * mesh_.volume();
  }

  /// Optimises one prototype per start, in parallel, and queues those that are large enough.
  void add_prototypes(const std::vector<Start>& starts) {
    const std::vector<Prototype> prototypes = find_prototypes(space_, starts, order_);
    order_ += starts.size();
    for (const Prototype& prototype : prototypes) {
      if (prototype.clearance >= min_radius_) queue_.push(prototype);
    }
  }

  /// Inserts the largest prototypes that still fit; those that do not start again from their position.
  void insert_largest() {
    std::vector<Prototype> largest;
    const double enough = k_round_ratio * queue_.top().clearance;
    while (!queue_.empty() && queue_.top().clearance >= enough) {
      largest.push_back(queue_.top());
      queue_.pop();
    }
    std::vector<Start> starts;
    for (const Prototype& p : largest) {
      if (done()) return;
      const double clearance = space_.spheres.nearest(p.position, p.clearance).clearance;
      if (clearance < p.clearance) {
        // A position inside a sphere is discarded.
        if (clearance > 0.0) starts.push_back({p.position, clearance});
        continue;
      }
      if (!is_inside(p.position)) continue;
      const Sphere sphere{p.position, p.clearance * (1.0 - k_margin)};
      space_.spheres.insert(sphere);
      filled_ += sphere.volume();
      add_starts_around(sphere, starts);
    }
    add_prototypes(starts);
  }

  /// Where the surface touches itself, a start just below one part of it may be outside of another part, and its
  /// prototype then leaves the body.
  bool is_inside(const Eigen::Vector3d& p) { return detail::winding_of_a(space_.tree, p, triangles_) > 0; }

  const Mesh& mesh_;
  const PackingOptions options_;
  const double min_radius_;
  FreeSpace space_;
  std::priority_queue<Prototype> queue_;
  std::uint64_t order_ = 0;
  double filled_ = 0.0;
  std::vector<std::uint32_t> triangles_;  ///< Scratch.
};

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

/// The smallest length along the ray at which another sphere's surface is equally near, at most `length`. Every step
/// finds the sphere nearest to the end of the ray and shortens the ray to the bisector with it.
double bisector(const SphereIndex& spheres, const Sphere& sphere, const Eigen::Vector3d& u, double length) {
  while (true) {
    const auto nearest = spheres.nearest(sphere.center + length * u, (length - sphere.radius) * k_rounding);
    if (nearest.sphere < 0) return length;
    const Sphere& other = spheres.spheres()[static_cast<std::size_t>(nearest.sphere)];
    // |c + l u - c'| - r' = l - r, squared, is linear in l.
    const Eigen::Vector3d offset = other.center - sphere.center;
    const double difference = sphere.radius - other.radius;
    const double slope = 2.0 * (offset.dot(u) - difference);
    const double shorter = (offset.squaredNorm() - difference * difference) / slope;
    const double next = std::max(shorter, sphere.radius);
    if (!(next < length)) return length;  // also where spheres overlap, which no packing has but a forged one
    length = next;
  }
}

/// Distance from the sphere's centre to the end of its cell in direction `u`.
double ray(const FreeSpace& space, const Sphere& sphere, const Eigen::Vector3d& u) {
  double length = sphere.radius;
  for (int step = 0; step < k_max_steps; ++step) {
    // Steps are at most a radius: another sphere is mostly nearer than that.
    const auto surface = closest_point(space.tree, sphere.center + length * u, sphere.radius);
    const double clearance = surface ? surface->distance : sphere.radius;
    if (clearance < k_near_surface * sphere.radius) return length;
    length += clearance;
    if (const double end = bisector(space.spheres, sphere, u, length); end < length) return end;
  }
  return length;
}

}  // namespace

Packing pack_spheres(const Mesh& mesh, const PackingOptions& options) {
  require_solid(mesh, "a sphere packing");
  const Tree tree(mesh);
  return Packer(mesh, tree, options).run();
}

Packing cached_packing(const Mesh& mesh, const PackingOptions& options) {
  // Increase the version whenever the packing of the same mesh and options changes.
  const std::string key = fmt::format("3 {} spheres={} fill={} smallest_radius={} seed={}", mesh.hash(),
                                      options.spheres, options.fill, options.smallest_radius, options.seed);
  const auto visit = [&](CacheMembers members, Packing& packing) {
    members.records("spheres", packing.spheres);
    packing.fill = total_volume(packing.spheres) / mesh.volume();
  };
  // A sphere far below the smallest one would make the cells of a SphereIndex so small that a search never ends.
  const double smallest = 0.5 * options.smallest_radius * mesh.diagonal();
  const auto valid = [&](const Packing& packing) {
    return !packing.spheres.empty() && packing.spheres.size() <= options.spheres &&
           std::all_of(packing.spheres.begin(), packing.spheres.end(), [&](const Sphere& s) {
             return mesh.box().contains(s.center) && s.radius >= smallest && s.radius <= mesh.diagonal();
           });
  };
  return load_or_build(
      "ist-packing", key, [&] { return pack_spheres(mesh, options); }, visit, valid);
}

std::vector<double> cell_weights(const Mesh& mesh, std::span<const Sphere> spheres) {
  const Tree tree(mesh);
  FreeSpace space{tree, SphereIndex(mesh.diagonal())};
  for (const Sphere& s : spheres) space.spheres.insert(s);
  std::vector<double> gaps(spheres.size());  // volumes of the cells without the spheres
  parallel::for_each(spheres.size(), [&](std::size_t i) {
    const Sphere& sphere = spheres[i];
    const double cube = sphere.radius * sphere.radius * sphere.radius;
    double sum = 0.0;
    for (std::size_t k = 0; k < k_rays; ++k) {
      const double length = ray(space, sphere, direction(k, static_cast<double>(i)));
      sum += length * length * length - cube;
    }
    gaps[i] = 4.0 / 3.0 * std::numbers::pi * sum / static_cast<double>(k_rays);
  });
  const double unfilled = std::accumulate(gaps.begin(), gaps.end(), 0.0);
  const double scale = unfilled > 0.0 ? std::max(0.0, mesh.volume() - total_volume(spheres)) / unfilled : 0.0;
  std::vector<double> weights(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) weights[i] = 1.0 + scale * gaps[i] / spheres[i].volume();
  return weights;
}

std::vector<double> cached_cell_weights(const Mesh& mesh, std::span<const Sphere> spheres) {
  ContentHash hash;
  hash.add(std::as_bytes(spheres));
  // Increase the version whenever the weights of the same mesh and spheres change.
  const std::string key = fmt::format("2 {} spheres={}", mesh.hash(), hash.hex());
  return load_or_build(
      "ist-cells", key, [&] { return cell_weights(mesh, spheres); },
      [](CacheMembers members, std::vector<double>& weights) { members.array("weights", weights); },
      [&](const std::vector<double>& weights) {
        return weights.size() == spheres.size() && all_finite(weights) &&
               std::all_of(weights.begin(), weights.end(), [](double weight) { return weight > 0.0; });
      });
}

}  // namespace sixdof::ist
