#include "cgal_minkowski.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <vector>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/convert_nef_polyhedron_to_polygon_mesh.h>
#include <CGAL/minkowski_sum_3.h>

namespace sixdof::reference {
namespace {

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Rounded = CGAL::Exact_predicates_inexact_constructions_kernel;
using ExactMesh = CGAL::Surface_mesh<Exact::Point_3>;

CGAL::Nef_polyhedron_3<Exact> to_nef(const CgalMesh& mesh) {
  ExactMesh result;
  std::vector<ExactMesh::Vertex_index> vertices;
  for (const auto& p : mesh.vertices) vertices.push_back(result.add_vertex(Exact::Point_3(p[0], p[1], p[2])));
  for (const auto& t : mesh.triangles) result.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
  return CGAL::Nef_polyhedron_3<Exact>(result);
}

}  // namespace

double distance_to_minkowski_sum(const CgalMesh& a, const CgalMesh& b) try {
  auto nef_a = to_nef(a), nef_b = to_nef(b);
  const auto sum = CGAL::minkowski_sum_3(nef_a, nef_b);
  ExactMesh surface;
  CGAL::convert_nef_polyhedron_to_polygon_mesh(sum, surface, true);
  double least = std::numeric_limits<double>::infinity();
  const auto rounded = [&](ExactMesh::Vertex_index v) {
    const auto& p = surface.point(v);
    return Rounded::Point_3(CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()));
  };
  for (const auto face : surface.faces()) {
    std::vector<Rounded::Point_3> corners;
    for (const auto v : vertices_around_face(surface.halfedge(face), surface)) corners.push_back(rounded(v));
    if (corners.size() != 3) return -1.0;
    const Rounded::Triangle_3 triangle(corners[0], corners[1], corners[2]);
    if (triangle.is_degenerate()) continue;
    least = std::min(least, std::sqrt(CGAL::squared_distance(Rounded::Point_3(0, 0, 0), triangle)));
  }
  return least;
} catch (const std::exception&) {
  return -1.0;
}

}  // namespace sixdof::reference
