#include <sixdof/models/recipe.h>

#include <array>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include <sixdof/models/cos_sin.h>
#include <sixdof/models/refine.h>
#include <sixdof/models/surface.h>

namespace sixdof {
namespace {

struct ProfilePoint {
  double radius, z;
};

constexpr std::uint32_t k_fewest_around = 6;

struct ProfileRing {
  double radius, z;
  std::uint32_t count;
  bool on_side;  ///< On the side or its rim, not inside a flat disc.
};

/// Rings along a profile from the axis to the axis, for edges of length h. Parts of constant z are discs, all others
/// are the side.
std::vector<ProfileRing> rings_along(std::span<const ProfilePoint> profile, double h) {
  const auto count_at = [&](double radius) {
    return radius == 0.0 ? 1U : whole_steps(2.0 * std::numbers::pi * radius, h, k_fewest_around);
  };
  std::vector<ProfileRing> rings{{profile[0].radius, profile[0].z, count_at(profile[0].radius), false}};
  for (std::size_t i = 1; i < profile.size(); ++i) {
    const ProfilePoint& from = profile[i - 1];
    const ProfilePoint& to = profile[i];
    const bool side = from.z != to.z;
    const double dr = to.radius - from.radius;
    const double dz = to.z - from.z;
    const std::uint32_t steps = whole_steps(std::sqrt(dr * dr + dz * dz), k_row * h, 1);
    if (side) rings.back().on_side = true;
    for (std::uint32_t k = 1; k < steps; ++k) {
      const double s = static_cast<double>(k) / static_cast<double>(steps);
      const double radius = from.radius + s * dr;
      rings.push_back({radius, from.z + s * dz, count_at(radius), side});
    }
    rings.push_back({to.radius, to.z, count_at(to.radius), side});
  }
  return rings;
}

/// Every ring but the poles at both ends has a strip of triangles on either side.
std::size_t count_triangles(std::span<const ProfileRing> rings) {
  std::size_t sum = 0;
  for (const ProfileRing& ring : rings) sum += ring.count == 1 ? 0 : 2 * std::size_t{ring.count};
  return sum;
}

/// @param area of the ideal surface
/// @param radius_at radius of the ideal side at height z
template <class RadiusAt>
Mesh revolve(std::span<const ProfilePoint> profile, double area, std::size_t budget, const char* name,
             RadiusAt radius_at) {
  const double h =
      fit_edge_length(area, budget, [&](double edge) { return count_triangles(rings_along(profile, edge)); });
  RawMesh surface;
  std::vector<char> on_side;
  std::optional<Ring> before;
  for (const ProfileRing& at : rings_along(profile, h)) {
    const Ring ring{static_cast<std::uint32_t>(surface.vertices.size()), at.count, before ? 1 - before->shift : 0};
    for (std::uint32_t j = 0; j < ring.count; ++j) {
      const Eigen::Vector2d u = at.radius * cos_sin(2ULL * j + ring.shift, 2ULL * ring.count);
      surface.vertices.emplace_back(u.x(), u.y(), at.z);
      on_side.push_back(at.on_side ? 1 : 0);
    }
    if (before) stitch(surface, *before, ring);
    before = ring;
  }
  refine_to(surface, budget, [&](const RawMesh& s, std::uint32_t a, std::uint32_t b) {
    Eigen::Vector3d p = midpoint_of_edge(s, a, b);
    const bool side = on_side[a] != 0 && on_side[b] != 0;
    on_side.push_back(side ? 1 : 0);
    const double distance = std::sqrt(p.x() * p.x() + p.y() * p.y());
    if (side && distance > 0.0) p.head<2>() *= radius_at(p.z()) / distance;
    return p;
  });
  return to_mesh(std::move(surface), name);
}

}  // namespace

Mesh make_cylinder(const CylinderShape& shape, std::size_t triangles) {
  check_length("cylinder", "radius", shape.radius);
  check_length("cylinder", "height", shape.height);
  const std::size_t budget = triangle_budget("cylinder", triangles, k_minimum_cylinder);
  const double r = shape.radius;
  const double half = 0.5 * shape.height;
  const std::array<ProfilePoint, 4> profile{{{0.0, -half}, {r, -half}, {r, half}, {0.0, half}}};
  const double area = 2.0 * std::numbers::pi * r * (r + shape.height);
  return revolve(profile, area, budget, "cylinder", [r](double) { return r; });
}

Mesh make_cone(const ConeShape& shape, std::size_t triangles) {
  check_length("cone", "radius", shape.radius);
  check_length("cone", "height", shape.height);
  const std::size_t budget = triangle_budget("cone", triangles, k_minimum_cone);
  const double r = shape.radius;
  const double height = shape.height;
  const std::array<ProfilePoint, 3> profile{{{0.0, 0.0}, {r, 0.0}, {0.0, height}}};
  const double area = std::numbers::pi * r * (r + std::sqrt(r * r + height * height));
  return revolve(profile, area, budget, "cone", [r, height](double z) { return r * ((height - z) / height); });
}

}  // namespace sixdof
