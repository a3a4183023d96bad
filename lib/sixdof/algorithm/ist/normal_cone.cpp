#include <sixdof/algorithm/ist/normal_cone.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <string>

#include <Eigen/Geometry>

#include <fmt/format.h>

#include <sixdof/algorithm/preparation.h>
#include <sixdof/base/hash.h>
#include <sixdof/base/parallel.h>
#include <sixdof/geometry/closest_point.h>
#include <sixdof/geometry/tree.h>

namespace sixdof::ist {
namespace {

constexpr double k_rounding = 1e-12;  // of a cosine
constexpr double k_escape = 1e-9;     // of a cosine, far above the rounding of a cone through nearly equal vectors

/// A cone by the cosine of its half angle. A vector within the rounding of its border is inside.
struct Cone {
  Eigen::Vector3d axis;
  double cosine;

  bool contains(const Eigen::Vector3d& v, double slack = k_rounding) const { return axis.dot(v) >= cosine - slack; }
  bool too_wide() const {
    static const double k_widest = std::cos(k_widest_half_angle);
    return cosine < k_widest;
  }
};

/// With the vectors on the border. Of opposite vectors, and of those of a great circle, the cosine is 0.
Cone cone_through(const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  const Eigen::Vector3d sum = u + v;
  return {sum.normalized(), 0.5 * sum.norm()};
}
Cone cone_through(const Eigen::Vector3d& u, const Eigen::Vector3d& v, const Eigen::Vector3d& w) {
  const Eigen::Vector3d normal = (v - u).cross(w - u).normalized();
  const double cosine = normal.dot(u);
  return cosine < 0.0 ? Cone{-normal, -cosine} : Cone{normal, cosine};
}

/// The same permutation in every run: Welzl's algorithm takes linear time in a random order.
std::vector<Eigen::Vector3d> shuffled(std::span<const Eigen::Vector3d> directions) {
  std::vector<Eigen::Vector3d> result(directions.begin(), directions.end());
  std::mt19937_64 random(result.size());
  for (std::size_t i = result.size(); i > 1; --i) std::swap(result[i - 1], result[random() % i]);
  return result;
}

bool is_normal(const Eigen::Vector3d& area_vector) { return area_vector.squaredNorm() > 0.0; }

/// Triangles (tree order) by the sphere that is nearest to their centroid, those of sphere i from first[i] on.
struct NearestTriangles {
  std::vector<std::size_t> first;
  std::vector<std::uint32_t> triangles;
};

NearestTriangles nearest_triangles(const Tree& tree, double diagonal, std::span<const Sphere> spheres) {
  SphereIndex index(diagonal);
  for (const Sphere& s : spheres) index.insert(s);
  const auto corners = tree.corners();
  std::vector<std::size_t> nearest(corners.size());
  parallel::for_each(corners.size(), [&](std::size_t t) {
    const Eigen::Vector3d centroid = (corners[t][0] + corners[t][1] + corners[t][2]) / 3.0;
    // Spheres and triangle are in one box, so a sphere is nearer than its diagonal.
    nearest[t] = static_cast<std::size_t>(std::max(0, index.nearest(centroid, diagonal).sphere));
  });
  NearestTriangles result{std::vector<std::size_t>(spheres.size() + 1), std::vector<std::uint32_t>(corners.size())};
  for (const std::size_t s : nearest) ++result.first[s + 1];
  std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
  std::vector<std::size_t> next(result.first.begin(), result.first.end() - 1);
  for (std::size_t t = 0; t < nearest.size(); ++t) result.triangles[next[nearest[t]]++] = static_cast<std::uint32_t>(t);
  return result;
}

}  // namespace

NormalCone narrowest_cone(std::span<const Eigen::Vector3d> directions) {
  if (directions.empty()) return {};
  const std::vector<Eigen::Vector3d> d = shuffled(directions);
  // Each loop keeps the narrowest cone of the vectors so far with one more of them on its border. No such cone is
  // wider than the final one, so the first that is too wide decides. Vectors that no half-space contains may end in a
  // cone without some of them.
  Cone cone{d[0], 1.0};
  for (std::size_t i = 1; i < d.size(); ++i) {
    if (cone.contains(d[i])) continue;
    cone = {d[i], 1.0};
    for (std::size_t j = 0; j < i; ++j) {
      if (cone.contains(d[j])) continue;
      cone = cone_through(d[i], d[j]);
      for (std::size_t k = 0; k < j && !cone.too_wide(); ++k) {
        if (!cone.contains(d[k])) cone = cone_through(d[i], d[j], d[k]);
      }
      if (cone.too_wide()) return {};
    }
  }
  if (!std::ranges::all_of(d, [&](const Eigen::Vector3d& v) { return cone.contains(v, k_escape); })) return {};
  return {cone.axis, std::acos(std::min(1.0, cone.cosine))};
}

std::vector<NormalCone> normal_cones(const Mesh& mesh, std::span<const Sphere> spheres) {
  const Tree tree(mesh);
  const std::vector<Eigen::Vector3d> areas = area_vectors(tree);
  const NearestTriangles nearest = nearest_triangles(tree, mesh.diagonal(), spheres);
  std::vector<NormalCone> cones(spheres.size());
  parallel::for_each(spheres.size(), [&](std::size_t i) {
    const Sphere& sphere = spheres[i];
    std::vector<Eigen::Vector3d> normals;
    const auto add = [&](std::uint32_t t) {
      if (is_normal(areas[t])) normals.push_back(areas[t].normalized());
    };
    for (std::size_t k = nearest.first[i]; k < nearest.first[i + 1]; ++k) add(nearest.triangles[k]);
    const double reach = closest_point(tree, sphere.center)->distance + k_touch_radii * sphere.radius;
    for_triangles_near(tree, sphere.center, reach, [&](std::uint32_t t) {
      const Eigen::Vector3d point = closest_point_on_triangle(sphere.center, tree.corners()[t]);
      if ((point - sphere.center).norm() <= reach) add(t);
      return true;
    });
    cones[i] = narrowest_cone(normals);
  });
  return cones;
}

std::vector<NormalCone> cached_normal_cones(const Mesh& mesh, std::span<const Sphere> spheres) {
  ContentHash hash;
  hash.add(std::as_bytes(spheres));
  // Increase the version whenever the cones of the same mesh and spheres change.
  const std::string key = fmt::format("1 {} spheres={}", mesh.hash(), hash.hex());
  return load_or_build(
      "ist-cones", key, [&] { return normal_cones(mesh, spheres); },
      [](CacheMembers members, std::vector<NormalCone>& cones) { members.records("cones", cones); },
      [&](const std::vector<NormalCone>& cones) {
        return cones.size() == spheres.size() && std::all_of(cones.begin(), cones.end(), [](const NormalCone& cone) {
                 return cone.axis.allFinite() && cone.half_angle >= 0.0 && cone.half_angle <= std::numbers::pi;
               });
      });
}

}  // namespace sixdof::ist
