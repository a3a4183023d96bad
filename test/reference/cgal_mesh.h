#pragma once

#include <array>
#include <cstdint>
#include <vector>

/// A mesh for CGAL, whose code is compiled without this project's headers, see CMakeLists.txt.
namespace sixdof::reference {

struct CgalMesh {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// @tparam M has vertices() and triangles() as Mesh.
template <class M>
CgalMesh to_cgal(const M& mesh) {
  CgalMesh result;
  result.vertices.reserve(mesh.vertices().size());
  for (const auto& p : mesh.vertices()) result.vertices.push_back({p.x(), p.y(), p.z()});
  result.triangles.assign(mesh.triangles().begin(), mesh.triangles().end());
  return result;
}

}  // namespace sixdof::reference
