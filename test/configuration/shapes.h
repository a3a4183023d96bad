#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <sixdof/geometry/mesh.h>

namespace sixdof::test {

struct BoxShape {
  Eigen::Vector3d center, half;  ///< Centre and half edges.
};

/// Axis-aligned boxes as one mesh of 12 triangles each.
inline Mesh boxes_mesh(const std::vector<BoxShape>& boxes, const std::string& name = "boxes") {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
  for (const BoxShape& box : boxes) {
    const auto base = static_cast<std::uint32_t>(vertices.size());
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d sign((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0, (i & 4) != 0 ? 1.0 : -1.0);
      vertices.emplace_back(box.center + box.half.cwiseProduct(sign));
    }
    for (const Triangle& t : std::vector<Triangle>{{0, 2, 3},
                                                   {0, 3, 1},
                                                   {4, 5, 7},
                                                   {4, 7, 6},
                                                   {0, 1, 5},
                                                   {0, 5, 4},
                                                   {2, 6, 7},
                                                   {2, 7, 3},
                                                   {0, 4, 6},
                                                   {0, 6, 2},
                                                   {1, 3, 7},
                                                   {1, 7, 5}}) {
      triangles.push_back({base + t[0], base + t[1], base + t[2]});
    }
  }
  return Mesh::build(std::move(vertices), std::move(triangles), name);
}

/// An irregular tetrahedron with one corner at `offset`.
inline Mesh tetrahedron_mesh(const Eigen::Vector3d& offset, double height) {
  return Mesh::build({offset, offset + Eigen::Vector3d(1.0, 0.1, 0.0), offset + Eigen::Vector3d(-0.2, 1.3, 0.3),
                      offset + Eigen::Vector3d(0.1, -0.3, height)},
                     {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, "tetrahedron");
}

/// A closed lump of 20 triangles with no symmetry: an icosahedron with its corners moved.
inline Mesh lump_mesh(std::uint64_t seed, const Eigen::Vector3d& offset) {
  constexpr double g = 1.618;
  std::vector<Eigen::Vector3d> v{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                 {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> scale(0.6, 1.4);
  for (Eigen::Vector3d& p : v) p = offset + scale(random) * p;
  return Mesh::build(v, {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                         {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                         {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}},
                     "lump");
}

/// first .. last - 1
inline std::vector<std::uint32_t> indices(std::size_t first, std::size_t last) {
  std::vector<std::uint32_t> list(last - first);
  std::iota(list.begin(), list.end(), static_cast<std::uint32_t>(first));
  return list;
}

inline bool same_bits(std::span<const double> left, std::span<const double> right) {
  return left.size() == right.size() && std::memcmp(left.data(), right.data(), left.size_bytes()) == 0;
}

inline Eigen::Vector3d random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
}

inline Eigen::Vector4d random_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Eigen::Vector4d(normal(random), normal(random), normal(random), normal(random)).normalized();
}

}  // namespace sixdof::test
