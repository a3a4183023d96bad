#include <sixdof/models/recipe.h>

#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <sixdof/models/cos_sin.h>
#include <sixdof/models/refine.h>
#include <sixdof/models/surface.h>

namespace sixdof {
namespace {

/// Icosahedron with corners (0, +-1, +-g) and cyclic, g the golden ratio; not normalised.
RawMesh icosahedron() {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  return {{{-1, g, 0},
           {1, g, 0},
           {-1, -g, 0},
           {1, -g, 0},
           {0, -1, g},
           {0, 1, g},
           {0, -1, -g},
           {0, 1, -g},
           {g, 0, -1},
           {g, 0, 1},
           {-g, 0, -1},
           {-g, 0, 1}},
          {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
           {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
           {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
}

/// Divides every triangle into n^2 equal ones. Points of an edge are made once, from its lower to its higher corner.
RawMesh divide_faces(const RawMesh& coarse, std::uint32_t n) {
  RawMesh fine{coarse.vertices, {}};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first_on_edge;
  const auto between = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, std::uint32_t k, std::uint32_t parts) {
    const double s = static_cast<double>(k) / static_cast<double>(parts);
    return Eigen::Vector3d((1.0 - s) * a + s * b);
  };
  const auto on_edge = [&](std::uint32_t a, std::uint32_t b, std::uint32_t k) {
    if (k == 0) return a;
    if (k == n) return b;
    const auto [low, high] = std::minmax(a, b);
    const auto [entry, fresh] =
        first_on_edge.try_emplace({low, high}, static_cast<std::uint32_t>(fine.vertices.size()));
    for (std::uint32_t i = 1; fresh && i < n; ++i) {
      fine.add(between(coarse.vertices[low], coarse.vertices[high], i, n));
    }
    return entry->second + (a == low ? k : n - k) - 1;
  };
  std::vector<std::uint32_t> row, above;
  for (const Triangle& t : coarse.triangles) {
    // Row r goes from edge t0-t1 to edge t0-t2, r steps away from t0.
    above.assign(1, t[0]);
    for (std::uint32_t r = 1; r <= n; ++r) {
      row.clear();
      const std::uint32_t left = on_edge(t[0], t[1], r);
      const std::uint32_t right = on_edge(t[0], t[2], r);
      for (std::uint32_t k = 0; k <= r; ++k) {
        if (r == n) {
          row.push_back(on_edge(t[1], t[2], k));
        } else if (k == 0 || k == r) {
          row.push_back(k == 0 ? left : right);
        } else {
          row.push_back(fine.add(between(fine.vertices[left], fine.vertices[right], k, r)));
        }
      }
      for (std::uint32_t k = 0; k < r; ++k) {
        fine.triangles.push_back({above[k], row[k], row[k + 1]});
        if (k + 1 < r) fine.triangles.push_back({above[k], row[k + 1], above[k + 1]});
      }
      above.swap(row);
    }
  }
  return fine;
}

/// @param project maps any point but the origin to the surface along its ray
template <class Project>
Mesh make_geodesic(const char* name, std::size_t triangles, Project project) {
  const std::size_t budget = triangle_budget(name, triangles, k_minimum_sphere);
  std::uint32_t n = 1;
  while (20ULL * (n + 1) * (n + 1) <= budget) ++n;
  RawMesh surface = divide_faces(icosahedron(), n);
  for (Eigen::Vector3d& p : surface.vertices) p = project(p);
  refine_to(surface, budget,
            [&](const RawMesh& s, std::uint32_t a, std::uint32_t b) { return project(midpoint_of_edge(s, a, b)); });
  return to_mesh(std::move(surface), name);
}

Eigen::Vector3d direction_of(const Eigen::Vector3d& p) { return p / norm_in_order(p); }

}  // namespace

Mesh make_sphere(const SphereShape& shape, std::size_t triangles) {
  check_length("sphere", "radius", shape.radius);
  return make_geodesic("sphere", triangles,
                       [&](const Eigen::Vector3d& p) { return Eigen::Vector3d(shape.radius * direction_of(p)); });
}

Mesh make_bumpy_sphere(const BumpySphereShape& shape, std::size_t triangles) {
  check_length("bumpy-sphere", "radius", shape.radius);
  check_shape(shape.amplitude >= 0.0 && shape.amplitude <= 0.5, "bumpy-sphere", "amplitude must be from 0 to 0.5");
  check_shape(shape.waves >= 0.0 && shape.waves <= 20.0, "bumpy-sphere", "waves must be from 0 to 20");
  return make_geodesic("bumpy-sphere", triangles, [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d direction = direction_of(p);
    const double wave = cos_sin(shape.waves * direction.x()).x() * cos_sin(shape.waves * direction.y()).x() *
                        cos_sin(shape.waves * direction.z()).x();
    return Eigen::Vector3d(shape.radius * (1.0 + shape.amplitude * wave) * direction);
  });
}

}  // namespace sixdof
