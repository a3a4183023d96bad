#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/tree.h>

namespace sixdof {

/// A part of a surface that is connected through edges. Triangles that are there twice, facing the same way, belong to
/// different shells.
struct Shell {
  std::uint32_t first_triangle = 0;  ///< The lowest index.
  std::size_t triangles = 0;
  bool closed = false;   ///< Its triangles use both directions of each edge equally often.
  bool doubled = false;  ///< Each of its triangles is there in an earlier shell.
  double volume = 0.0;   ///< Signed, as Mesh::volume(); only where closed.
};

struct Shells {
  std::vector<std::uint32_t> of_triangle;  ///< Index into `all` for each triangle.
  std::vector<Shell> all;                  ///< By first_triangle.
};

Shells find_shells(const Mesh& mesh);

/// Winding number around `p` of each group of triangles, those with 0 left out. Meaningful for groups that are closed.
/// Points on the surface are decided as in predicates.h.
/// @param tree of the mesh; @param group of each triangle, in the mesh's order
std::map<std::uint32_t, int> windings_of_groups(const Tree& tree, std::span<const std::uint32_t> group,
                                                const Eigen::Vector3d& p);

}  // namespace sixdof
