#pragma once

#include <random>
#include <utility>
#include <vector>

#include <sixdof/geometry/mesh.h>

namespace sixdof::test {

/// The mesh with each coordinate moved at random by up to 1e-6 box diagonals, as of the CAD part `fandisk`: its flat
/// faces tie up to that, whichever triangles are closest.
inline Mesh rough_mesh(const Mesh& mesh) {
  const double roughness = 1e-6 * mesh.diagonal();
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> move(-roughness, roughness);
  std::vector<Eigen::Vector3d> vertices(mesh.vertices().begin(), mesh.vertices().end());
  for (Eigen::Vector3d& p : vertices) p += Eigen::Vector3d(move(random), move(random), move(random));
  return Mesh::build(std::move(vertices), {mesh.triangles().begin(), mesh.triangles().end()}, mesh.name() + "-rough");
}

}  // namespace sixdof::test
