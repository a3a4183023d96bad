#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>

/// Small meshes and random poses for tests.
namespace sixdof::shapes {

using Generator = std::mt19937_64;

inline double uniform(Generator& generator, double low, double high) {
  return low + (high - low) * (static_cast<double>(generator() >> 11) * 0x1p-53);
}

inline Eigen::Vector3d uniform_vector(Generator& generator, double half_width) {
  const double x = uniform(generator, -half_width, half_width);
  const double y = uniform(generator, -half_width, half_width);
  const double z = uniform(generator, -half_width, half_width);
  return {x, y, z};
}

/// Uniform over the sphere, by rejection.
inline Eigen::Vector3d unit_vector(Generator& generator) {
  for (;;) {
    const Eigen::Vector3d p = uniform_vector(generator, 1.0);
    const double norm = p.norm();
    if (norm > 0.1 && norm < 1.0) return p / norm;
  }
}

inline Pose random_pose(Generator& generator, double half_width) {
  const Eigen::AngleAxisd rotation(uniform(generator, 0.1, 3.0), unit_vector(generator));
  return {rotation.toRotationMatrix(), uniform_vector(generator, half_width)};
}

/// Icosahedron subdivided `levels` times (20 * 4^levels triangles), radius 1 + `bump` * a smooth function.
inline Mesh bumpy_sphere(int levels, double bump, double radius = 1.0,
                         const Eigen::Vector3d& center = Eigen::Vector3d::Zero()) {
  const double g = std::numbers::phi;
  std::vector<Eigen::Vector3d> v{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                 {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  std::vector<Triangle> t{{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                          {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                          {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (Eigen::Vector3d& p : v) p.normalize();
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(v.size()));
      if (is_new) v.push_back((v[a] + v[b]).normalized());
      return at->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : t) {
      const std::uint32_t ab = middle(a, b);
      const std::uint32_t bc = middle(b, c);
      const std::uint32_t ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    t = std::move(finer);
  }
  for (Eigen::Vector3d& p : v) {
    const double wave = std::sin(5.0 * p.x() + 0.3) * std::sin(6.0 * p.y() + 1.1) * std::sin(7.0 * p.z() + 2.3);
    p = center + p * radius * (1.0 + bump * wave);
  }
  return Mesh::build(std::move(v), std::move(t), "bumpy sphere");
}

/// Box with the given half extents, 12 triangles.
inline Mesh box(const Eigen::Vector3d& half, const Eigen::Vector3d& center = Eigen::Vector3d::Zero()) {
  std::vector<Eigen::Vector3d> v;
  for (int i = 0; i < 8; ++i) {
    v.emplace_back(center + Eigen::Vector3d((i & 1) ? half.x() : -half.x(), (i & 2) ? half.y() : -half.y(),
                                            (i & 4) ? half.z() : -half.z()));
  }
  return Mesh::build(std::move(v),
                     {{0, 2, 1},
                      {1, 2, 3},
                      {4, 5, 6},
                      {5, 7, 6},
                      {0, 1, 4},
                      {1, 5, 4},
                      {2, 6, 3},
                      {3, 6, 7},
                      {0, 4, 2},
                      {2, 4, 6},
                      {1, 3, 5},
                      {3, 7, 5}},
                     "box");
}

/// Cylinder about z from -1 to 1, closed: 2 n triangles as long as itself, and n on each end.
inline Mesh rod(std::uint32_t n, double radius) {
  std::vector<Eigen::Vector3d> v{{0.0, 0.0, -1.0}, {0.0, 0.0, 1.0}};
  std::vector<Triangle> t;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / n;
    const double x = radius * std::cos(angle), y = radius * std::sin(angle);
    v.emplace_back(x, y, -1.0);
    v.emplace_back(x, y, 1.0);
    const std::uint32_t low = 2 + 2 * i, next = 2 + 2 * ((i + 1) % n);
    t.insert(t.end(), {{low, next, next + 1}, {low, next + 1, low + 1}, {0, next, low}, {1, low + 1, next + 1}});
  }
  return Mesh::build(std::move(v), std::move(t), "rod");
}

/// Unconnected random triangles in a cube of the given half width.
inline Mesh soup(Generator& generator, std::size_t triangles, double half_width, double size) {
  std::vector<Eigen::Vector3d> v;
  std::vector<Triangle> t;
  for (std::size_t i = 0; i < triangles; ++i) {
    const Eigen::Vector3d at = uniform_vector(generator, half_width);
    for (int k = 0; k < 3; ++k) v.push_back(at + uniform_vector(generator, size));
    const auto n = static_cast<std::uint32_t>(3 * i);
    t.push_back({n, n + 1, n + 2});
  }
  return Mesh::build(std::move(v), std::move(t), "soup");
}

/// The mesh's vertices under a pose, as a new mesh.
inline Mesh moved(const Mesh& mesh, const Pose& pose) {
  std::vector<Eigen::Vector3d> v = mesh.vertices();
  for (Eigen::Vector3d& p : v) p = pose * p;
  return Mesh::build(std::move(v), mesh.triangles(), mesh.name());
}

}  // namespace sixdof::shapes
