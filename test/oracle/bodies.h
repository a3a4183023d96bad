#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/overlap.h>

/// Bodies and poses shared by the tests of the oracle.
namespace sixdof::bodies {

/// A mesh with everything a query needs.
struct Body {
  Mesh mesh;
  Tree tree;
  Solid solid;
  explicit Body(Mesh m) : mesh(std::move(m)), tree(mesh), solid(mesh, tree) {}
  Body(const Body&) = delete;
};

inline Overlap overlap(const Body& a, const Body& b, const Pose& X_AB) {
  return OverlapQuery(a.solid, b.solid).evaluate(X_AB);
}

/// Axis-parallel box; `other_diagonals` splits every face along the other diagonal.
inline Mesh box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, bool other_diagonals = false) {
  std::vector<Eigen::Vector3d> v;
  for (int i = 0; i < 8; ++i) {
    v.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z());
  }
  const std::array<std::array<std::uint32_t, 4>, 6> faces{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  std::vector<Triangle> t;
  for (const auto& f : faces) {
    if (other_diagonals) {
      t.push_back({f[1], f[2], f[3]});
      t.push_back({f[1], f[3], f[0]});
    } else {
      t.push_back({f[0], f[1], f[2]});
      t.push_back({f[0], f[2], f[3]});
    }
  }
  return Mesh::build(std::move(v), std::move(t), "box");
}

/// Torus-like surface r(u, v) with bumps: n_u * n_v * 2 triangles, genus 1, not convex.
inline Mesh bumpy_torus(std::uint32_t n_u, std::uint32_t n_v, double bump = 0.08, double size = 1.0) {
  std::vector<Eigen::Vector3d> p;
  for (std::uint32_t i = 0; i < n_u; ++i) {
    for (std::uint32_t j = 0; j < n_v; ++j) {
      const double u = 2.0 * std::numbers::pi * i / n_u;
      const double v = 2.0 * std::numbers::pi * j / n_v;
      const double r = 0.2 + 0.2 * bump * std::sin(7.0 * u + 3.0 * v);
      p.push_back(size * Eigen::Vector3d((0.5 + r * std::cos(v)) * std::cos(u), (0.5 + r * std::cos(v)) * std::sin(u),
                                         r * std::sin(v)));
    }
  }
  std::vector<Triangle> t;
  for (std::uint32_t i = 0; i < n_u; ++i) {
    for (std::uint32_t j = 0; j < n_v; ++j) {
      const std::uint32_t a = i * n_v + j, b = (i + 1) % n_u * n_v + j;
      const std::uint32_t c = (i + 1) % n_u * n_v + (j + 1) % n_v, d = i * n_v + (j + 1) % n_v;
      t.push_back({a, b, c});
      t.push_back({a, c, d});
    }
  }
  return Mesh::build(std::move(p), std::move(t), "bumpy torus");
}

/// Octahedron subdivided `levels` times onto a sphere with bumps: 8 * 4^levels triangles.
inline Mesh bumpy_sphere(int levels, double bump = 0.1, double radius = 0.5) {
  std::vector<Eigen::Vector3d> p{Eigen::Vector3d::UnitX(),  -Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(),
                                 -Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(),  -Eigen::Vector3d::UnitZ()};
  std::vector<Triangle> t{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::vector<Triangle> finer;
    for (const Triangle& f : t) {
      const auto n = static_cast<std::uint32_t>(p.size());  // Mesh::build welds the repeated midpoints
      for (std::size_t k = 0; k < 3; ++k) p.push_back((p[f[k]] + p[f[(k + 1) % 3]]).normalized());
      finer.push_back({f[0], n, n + 2});
      finer.push_back({f[1], n + 1, n});
      finer.push_back({f[2], n + 2, n + 1});
      finer.push_back({n, n + 1, n + 2});
    }
    t = std::move(finer);
  }
  for (Eigen::Vector3d& x : p) {
    x *= radius * (1.0 + bump * std::sin(5.0 * x.x() + 1.0) * std::cos(4.0 * x.y()) * std::sin(6.0 * x.z() + 0.3));
  }
  return Mesh::build(std::move(p), std::move(t), "bumpy sphere");
}

inline Mesh moved(const Mesh& mesh, const Pose& pose, double scale = 1.0) {
  std::vector<Eigen::Vector3d> p;
  for (const Eigen::Vector3d& x : mesh.vertices()) p.push_back(pose * Eigen::Vector3d(scale * x));
  return Mesh::build(std::move(p), mesh.triangles(), mesh.name());
}

/// Both meshes in one, as separate pieces unless vertices coincide.
inline Mesh together(const Mesh& a, const Mesh& b) {
  std::vector<Eigen::Vector3d> p = a.vertices();
  p.insert(p.end(), b.vertices().begin(), b.vertices().end());
  std::vector<Triangle> t = a.triangles();
  const auto n = static_cast<std::uint32_t>(a.vertices().size());
  for (const Triangle& f : b.triangles()) t.push_back({f[0] + n, f[1] + n, f[2] + n});
  return Mesh::build(std::move(p), std::move(t), a.name() + " and " + b.name());
}

inline Mesh inside_out(const Mesh& mesh) {
  std::vector<Triangle> t = mesh.triangles();
  for (Triangle& x : t) std::swap(x[1], x[2]);
  return Mesh::build(mesh.vertices(), std::move(t), mesh.name() + " inside out");
}

inline Pose random_pose(std::mt19937_64& random, double reach) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-reach, reach);
  const Eigen::Quaterniond q =
      Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized();
  return {q.toRotationMatrix(), {uniform(random), uniform(random), uniform(random)}};
}

}  // namespace sixdof::bodies
