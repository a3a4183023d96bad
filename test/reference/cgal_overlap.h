#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "cgal_mesh.h"

/// Volume of the intersection of two closed meshes by CGAL's corefinement, an independent exact Boolean, and the
/// self-intersections of a mesh. For tests and benchmarks only: these parts of CGAL are GPL, and the library does not
/// link them.
namespace sixdof::reference {

/// A fixed and a moving mesh, converted once. Both are copied per query, because corefinement changes its arguments.
class CgalOverlap {
 public:
  CgalOverlap(const CgalMesh& a, const CgalMesh& b);
  ~CgalOverlap();

  /// Volume of the intersection; `vertices_b` are B's vertices in A's frame. Negative if corefinement fails.
  double volume(const std::vector<std::array<double, 3>>& vertices_b) const;

 private:
  struct Meshes;
  std::unique_ptr<Meshes> meshes_;
};

/// Pairs of triangles that intersect elsewhere than in a common vertex or edge, by exact predicates.
std::size_t count_self_intersections(const CgalMesh& mesh);

}  // namespace sixdof::reference
