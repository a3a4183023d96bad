#include <sixdof/geometry/mesh.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include <sixdof/base/compensated_sum.h>
#include <sixdof/base/error.h>
#include <sixdof/base/hash.h>
#include <sixdof/base/visible_text.h>
#include <sixdof/geometry/raw_mesh.h>
#include <sixdof/geometry/sides.h>

namespace sixdof {
namespace {

constexpr std::uint32_t k_unset = std::numeric_limits<std::uint32_t>::max();

void check_finite(const std::vector<Eigen::Vector3d>& vertices) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (!vertices[i].allFinite()) {
      throw BadMesh(fmt::format("vertex {}: coordinates ({}, {}, {}) are not finite", i, vertices[i].x(),
                                vertices[i].y(), vertices[i].z()));
    }
  }
}

void check_input(const std::vector<Eigen::Vector3d>& vertices, const std::vector<Triangle>& triangles) {
  if (triangles.empty()) throw BadMesh("no triangles");
  // Numbers of corners (3 per triangle) must fit 32 bits as well.
  if (vertices.size() >= k_unset || triangles.size() >= k_unset / 3) {
    throw BadMesh(fmt::format("{} vertices and {} triangles are more than 32-bit indices can tell apart",
                              vertices.size(), triangles.size()));
  }
  check_finite(vertices);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const std::uint32_t v : triangles[i]) {
      if (v >= vertices.size()) {
        throw BadMesh(fmt::format("triangle {}: vertex index {} of {}", i, v, vertices.size()));
      }
    }
  }
}

/// For each vertex the first one that is equal to it. @pre no coordinate is -0
std::vector<std::uint32_t> first_equal_of(const std::vector<Eigen::Vector3d>& vertices) {
  // A table of vertices by the hash of their bits, at most half full; a place that is taken by another passes to the
  // next.
  std::vector<std::uint32_t> table(std::bit_ceil(2 * vertices.size()), k_unset);
  const std::size_t mask = table.size() - 1;
  std::vector<std::uint32_t> first_equal(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector3d& p = vertices[i];
    std::size_t at = std::hash<std::string_view>()({reinterpret_cast<const char*>(p.data()), sizeof(p)}) & mask;
    while (table[at] != k_unset && vertices[table[at]] != p) at = (at + 1) & mask;
    if (table[at] == k_unset) table[at] = i;
    first_equal[i] = table[at];
  }
  return first_equal;
}

/// The repairs of Mesh::build.
void weld(std::vector<Eigen::Vector3d>& vertices, std::vector<Triangle>& triangles, MeshRepairs& repairs) {
  repairs.unreferenced_vertices = drop_unreferenced(vertices, triangles);
  for (Eigen::Vector3d& p : vertices) p += Eigen::Vector3d::Zero();  // -0 becomes +0
  const std::vector<std::uint32_t> first_equal = first_equal_of(vertices);
  repairs.welded_vertices = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) repairs.welded_vertices += first_equal[i] != i ? 1 : 0;
  for (Triangle& t : triangles) {
    for (std::uint32_t& v : t) v = first_equal[v];
  }
  repairs.collapsed_triangles = std::erase_if(triangles, is_collapsed);
  if (triangles.empty()) throw BadMesh("every triangle collapses to an edge or a point");
  triangles.shrink_to_fit();
  // Now unreferenced: the welded vertices, and those whose triangles have all collapsed.
  repairs.unreferenced_vertices += drop_unreferenced(vertices, triangles) - repairs.welded_vertices;
}

/// Corners of a side at its lower and its higher vertex.
std::uint32_t corner_at_low(const Side& s) { return s.forward ? s.corner : next_corner(s.corner); }
std::uint32_t corner_at_high(const Side& s) { return s.forward ? next_corner(s.corner) : s.corner; }

MeshTopology analyse_topology(std::size_t vertex_count, const std::vector<Triangle>& triangles) {
  MeshTopology result;
  UnionFind components(triangles.size());
  UnionFind fans(3 * triangles.size());  // corners, joined across edges with two triangles
  for_each_edge(sorted_sides(triangles), [&](std::span<const Side> sides) {
    ++result.edges;
    for (const Side& side : sides.subspan(1)) components.join(sides[0].triangle(), side.triangle());
    const auto forward = std::count_if(sides.begin(), sides.end(), [](const Side& s) { return s.forward; });
    if (sides.size() == 1) ++result.border_edges;
    if (sides.size() > 2) ++result.nonmanifold_edges;
    if (sides.size() > 1 && 2 * static_cast<std::size_t>(forward) != sides.size()) ++result.misoriented_edges;
    if (sides.size() == 2) {
      fans.join(corner_at_low(sides[0]), corner_at_low(sides[1]));
      fans.join(corner_at_high(sides[0]), corner_at_high(sides[1]));
    }
  });
  std::vector<std::uint32_t> fans_at_vertex(vertex_count, 0);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (components.find(t) == t) ++result.components;
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (fans.find(3 * t + k) == 3 * t + k) ++fans_at_vertex[triangles[t][k]];
    }
  }
  result.nonmanifold_vertices = static_cast<std::size_t>(
      std::count_if(fans_at_vertex.begin(), fans_at_vertex.end(), [](std::uint32_t n) { return n > 1; }));
  result.closed = result.border_edges == 0;
  result.manifold = result.nonmanifold_edges == 0 && result.nonmanifold_vertices == 0;
  result.oriented = result.misoriented_edges == 0;
  result.euler_characteristic = static_cast<std::int64_t>(vertex_count) - static_cast<std::int64_t>(result.edges) +
                                static_cast<std::int64_t>(triangles.size());
  return result;
}

std::string content_hash(const std::vector<Eigen::Vector3d>& vertices, const std::vector<Triangle>& triangles) {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  ContentHash hash;
  const std::array<std::uint64_t, 2> counts{vertices.size(), triangles.size()};
  hash.add_values(std::span<const std::uint64_t>(counts));
  hash.add(std::as_bytes(std::span(vertices)));
  hash.add(std::as_bytes(std::span(triangles)));
  return hash.hex();
}

}  // namespace

std::size_t drop_unreferenced(std::vector<Eigen::Vector3d>& vertices, std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> renumbered(vertices.size(), k_unset);
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) renumbered[v] = 0;
  }
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (renumbered[i] == k_unset) continue;
    vertices[kept] = vertices[i];
    renumbered[i] = kept++;
  }
  for (Triangle& t : triangles) {
    for (std::uint32_t& v : t) v = renumbered[v];
  }
  const std::size_t dropped = vertices.size() - kept;
  vertices.resize(kept);
  vertices.shrink_to_fit();
  return dropped;
}

Mesh Mesh::build(std::vector<Eigen::Vector3d> vertices, std::vector<Triangle> triangles, std::string name,
                 MeshRepairs repairs) {
  check_input(vertices, triangles);
  Mesh mesh;
  mesh.name_ = visible_text(name, k_any_length);
  mesh.repairs_ = std::move(repairs);
  weld(vertices, triangles, mesh.repairs_);
  mesh.vertices_ = std::move(vertices);
  mesh.triangles_ = std::move(triangles);
  mesh.topology_ = analyse_topology(mesh.vertices_.size(), mesh.triangles_);
  mesh.measure();
  return mesh;
}

Mesh Mesh::with_vertices(std::vector<Eigen::Vector3d> vertices) const {
  if (vertices.size() != vertices_.size()) {
    throw BadMesh(fmt::format("{} vertices for a mesh of {}", vertices.size(), vertices_.size()));
  }
  check_finite(vertices);
  for (Eigen::Vector3d& p : vertices) p += Eigen::Vector3d::Zero();  // -0 becomes +0
  const std::vector<std::uint32_t> first_equal = first_equal_of(vertices);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (first_equal[i] != i) throw BadMesh(fmt::format("vertices {} and {} are equal", first_equal[i], i));
  }
  Mesh mesh;
  mesh.name_ = name_;
  mesh.vertices_ = std::move(vertices);
  mesh.triangles_ = triangles_;
  mesh.topology_ = topology_;
  mesh.measure();
  return mesh;
}

void Mesh::measure() {
  for (const Eigen::Vector3d& p : vertices_) box_.extend(p);
  if (!std::isfinite(diagonal())) throw BadMesh("the bounding box is too large for double precision");
  integrate();
  hash_ = content_hash(vertices_, triangles_);
}

void Mesh::integrate() {
  const Eigen::Vector3d origin = center();
  CompensatedSum area, volume;
  std::array<CompensatedSum, 3> first_moment, surface_moment;
  repairs_.zero_area_triangles.clear();
  for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
    const Eigen::Vector3d a = vertices_[triangles_[i][0]] - origin;
    const Eigen::Vector3d b = vertices_[triangles_[i][1]] - origin;
    const Eigen::Vector3d c = vertices_[triangles_[i][2]] - origin;
    const Eigen::Vector3d cross = (b - a).cross(c - a);
    const double triangle_area = 0.5 * cross.norm();
    if (triangle_area == 0.0) repairs_.zero_area_triangles.push_back(i);
    const double tetrahedron = a.dot(b.cross(c)) / 6.0;
    area += triangle_area;
    volume += tetrahedron;
    const Eigen::Vector3d sum = a + b + c;
    for (std::size_t k = 0; k < 3; ++k) {
      const double s = sum[static_cast<Eigen::Index>(k)];
      first_moment[k] += tetrahedron * s / 4.0;
      surface_moment[k] += triangle_area * s / 3.0;
    }
  }
  area_ = area.value();
  volume_ = volume.value();
  const double mass = volume_ != 0.0 ? volume_ : area_;
  const auto& moment = volume_ != 0.0 ? first_moment : surface_moment;
  centroid_ = origin;
  if (mass != 0.0) centroid_ += Eigen::Vector3d(moment[0].value(), moment[1].value(), moment[2].value()) / mass;
}

std::string Mesh::why_not_solid() const {
  if (!topology_.closed) return fmt::format("not closed: {} border edges", topology_.border_edges);
  if (!topology_.oriented) {
    return fmt::format("not consistently oriented: {} edges disagree", topology_.misoriented_edges);
  }
  if (volume_ < 0.0) return "inside out: triangles face inwards";
  if (volume_ == 0.0) return "encloses no volume";
  return {};
}

}  // namespace sixdof
