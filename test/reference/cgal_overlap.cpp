#include "cgal_overlap.h"

#include <iterator>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

namespace sixdof::reference {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Vertex = Surface::Vertex_index;

Surface convert(const CgalMesh& mesh) {
  Surface surface;
  std::vector<Vertex> vertices;
  vertices.reserve(mesh.vertices.size());
  for (const auto& p : mesh.vertices) vertices.push_back(surface.add_vertex({p[0], p[1], p[2]}));
  for (const auto& t : mesh.triangles) surface.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
  return surface;
}

}  // namespace

struct CgalOverlap::Meshes {
  Surface a, b;
};

CgalOverlap::CgalOverlap(const CgalMesh& a, const CgalMesh& b)
    : meshes_(std::make_unique<Meshes>(Meshes{convert(a), convert(b)})) {}
CgalOverlap::~CgalOverlap() = default;

double CgalOverlap::volume(const std::vector<std::array<double, 3>>& vertices_b) const {
  Surface a = meshes_->a;
  Surface b = meshes_->b;
  std::size_t i = 0;
  for (const Vertex v : b.vertices()) {
    b.point(v) = {vertices_b[i][0], vertices_b[i][1], vertices_b[i][2]};
    ++i;
  }
  Surface common;
  if (!CGAL::Polygon_mesh_processing::corefine_and_compute_intersection(a, b, common)) return -1.0;
  return common.number_of_faces() == 0 ? 0.0 : CGAL::Polygon_mesh_processing::volume(common);
}

std::size_t count_self_intersections(const CgalMesh& mesh) {
  const Surface surface = convert(mesh);
  std::vector<std::pair<Surface::Face_index, Surface::Face_index>> pairs;
  CGAL::Polygon_mesh_processing::self_intersections(surface, std::back_inserter(pairs));
  return pairs.size();
}

}  // namespace sixdof::reference
