#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// A triangle mesh under construction, not validated.
struct Surface {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
};

inline Mesh to_mesh(Surface surface, std::string name) {
  return Mesh::build(std::move(surface.vertices), std::move(surface.triangles), std::move(name));
}

/// Most triangles that a recipe or a subdivision makes: a larger number is taken for a typing mistake.
constexpr std::size_t k_maximum_triangles = 20'000'000;

}  // namespace sixdof
