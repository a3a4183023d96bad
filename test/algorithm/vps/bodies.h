#pragma once

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>
#include <sixdof/models/recipe.h>

/// Bodies and poses for the tests of voxmap-pointshell.

namespace sixdof::vps_test {

inline Pose generic_pose(std::uint64_t seed, double reach) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto next = [&] { return normal(random); };
  const double w = next(), x = next(), y = next(), z = next(), u = next(), v = next(), t = next();
  return {Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix(),
          reach * Eigen::Vector3d(u, v, t).normalized()};
}

inline Mesh moved(const Mesh& mesh, const Pose& X) {
  std::vector<Eigen::Vector3d> vertices;
  for (const Eigen::Vector3d& p : mesh.vertices()) vertices.push_back(X * p);
  return Mesh::build(std::move(vertices), mesh.triangles(), mesh.name());
}

inline Mesh inside_out(const Mesh& mesh) {
  std::vector<Triangle> triangles = mesh.triangles();
  for (Triangle& t : triangles) std::swap(t[1], t[2]);
  return Mesh::build(mesh.vertices(), triangles, "inside-out " + mesh.name());
}

/// Both meshes as one.
inline Mesh together(const Mesh& a, const Mesh& b) {
  std::vector<Eigen::Vector3d> vertices = a.vertices();
  std::vector<Triangle> triangles = a.triangles();
  const auto offset = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), b.vertices().begin(), b.vertices().end());
  for (const Triangle& t : b.triangles()) triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return Mesh::build(std::move(vertices), std::move(triangles), a.name() + " and " + b.name());
}

inline Mesh box(const Eigen::Vector3d& size) { return make_box({size}, 12); }
inline Mesh ball(double radius, std::size_t triangles) { return make_sphere({radius}, triangles); }

}  // namespace sixdof::vps_test
