#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "cgal_mesh.h"

/// Volume of the intersection of two closed meshes by CGAL's corefinement, an independent exact Boolean, and what CGAL
/// finds wrong with a mesh: for tests and benchmarks only (these parts of CGAL are GPL; the library does not link
/// them).
namespace sixdof::reference {

/// A fixed and a moving mesh, converted once; the moving one is copied and placed per query, as corefinement changes
/// its arguments.
class CgalOverlap {
 public:
  CgalOverlap(const CgalMesh& a, const CgalMesh& b);
  ~CgalOverlap();

  /// Volume of A and placed B; `placed_b` holds B's vertices in A's frame. Negative if CGAL gives up.
  double volume(const std::vector<std::array<double, 3>>& placed_b) const;

 private:
  struct Meshes;
  std::unique_ptr<Meshes> meshes_;
};

/// Pairs of triangles that meet elsewhere than in a corner or an edge that they share, by exact predicates.
std::size_t count_self_intersections(const CgalMesh& mesh);

}  // namespace sixdof::reference
