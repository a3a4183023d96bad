#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

/// Volume of the intersection of two closed meshes by CGAL's corefinement: an independent exact Boolean, for tests and
/// benchmarks only (CGAL's corefinement is GPL; the library does not link it).
namespace sixdof::reference {

struct CgalMesh {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

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

}  // namespace sixdof::reference
