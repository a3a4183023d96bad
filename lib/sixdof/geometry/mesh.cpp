#include <sixdof/geometry/mesh.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>
#include <unordered_map>

#include <fmt/format.h>

#include <sixdof/base/compensated_sum.h>
#include <sixdof/base/error.h>
#include <sixdof/base/hash.h>

namespace sixdof {
namespace {

constexpr std::uint32_t k_unset = std::numeric_limits<std::uint32_t>::max();

void check_input(const std::vector<Eigen::Vector3d>& vertices, const std::vector<Triangle>& triangles) {
  if (triangles.empty()) throw BadMesh("no triangles");
  // Numbers of corners (3 per triangle) must fit 32 bits as well.
  if (vertices.size() >= k_unset || triangles.size() >= k_unset / 3) {
    throw BadMesh(fmt::format("{} vertices and {} triangles are more than 32-bit indices can tell apart",
                              vertices.size(), triangles.size()));
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (!vertices[i].allFinite()) {
      throw BadMesh(fmt::format("vertex {}: coordinates ({}, {}, {}) are not finite", i, vertices[i].x(),
                                vertices[i].y(), vertices[i].z()));
    }
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const std::uint32_t v : triangles[i]) {
      if (v >= vertices.size()) {
        throw BadMesh(fmt::format("triangle {}: vertex index {} of {}", i, v, vertices.size()));
      }
    }
  }
}

struct VertexBits {
  std::array<std::uint64_t, 3> bits;
  explicit VertexBits(const Eigen::Vector3d& p) {
    for (std::size_t i = 0; i < 3; ++i) {
      bits[i] = std::bit_cast<std::uint64_t>(p[static_cast<Eigen::Index>(i)]);
    }
  }
  bool operator==(const VertexBits&) const = default;
};

struct VertexBitsHash {
  std::size_t operator()(const VertexBits& v) const {
    std::uint64_t h = 0x9E3779B97F4A7C15ull;
    for (const std::uint64_t word : v.bits) {
      h = (h ^ word) * 0xBF58476D1CE4E5B9ull;
      h ^= h >> 29;
    }
    return h;
  }
};

/// Drops vertices that no triangle uses. @return their number
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

/// The repairs of Mesh::build.
void weld(std::vector<Eigen::Vector3d>& vertices, std::vector<Triangle>& triangles, MeshRepairs& repairs) {
  repairs.unreferenced_vertices = drop_unreferenced(vertices, triangles);
  std::unordered_map<VertexBits, std::uint32_t, VertexBitsHash> first;
  first.reserve(vertices.size());
  std::vector<std::uint32_t> first_equal(vertices.size());
  repairs.welded_vertices = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices[i] += Eigen::Vector3d::Zero();  // -0 becomes +0
    first_equal[i] = first.try_emplace(VertexBits(vertices[i]), static_cast<std::uint32_t>(i)).first->second;
    if (first_equal[i] != i) ++repairs.welded_vertices;
  }
  for (Triangle& t : triangles) {
    for (std::uint32_t& v : t) v = first_equal[v];
  }
  repairs.collapsed_triangles =
      std::erase_if(triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  if (triangles.empty()) throw BadMesh("every triangle collapses to an edge or a point");
  triangles.shrink_to_fit();
  // Now unreferenced: the welded vertices, and those whose triangles have all collapsed.
  repairs.unreferenced_vertices += drop_unreferenced(vertices, triangles) - repairs.welded_vertices;
}

class UnionFind {
 public:
  explicit UnionFind(std::size_t n) {
    parent_.reserve(n);
    for (std::size_t i = 0; i < n; ++i) parent_.push_back(static_cast<std::uint32_t>(i));
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t i, std::uint32_t j) { parent_[find(i)] = find(j); }

 private:
  std::vector<std::uint32_t> parent_;
};

/// One side of a triangle: an undirected edge and the direction in which the triangle uses it.
struct Side {
  std::uint32_t low, high;
  std::uint32_t corner;  ///< 3 * triangle + k: the side from corner k to corner k + 1.
  bool forward;          ///< From low to high.
};

std::uint32_t next_corner(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

std::vector<Side> sorted_sides(const std::vector<Triangle>& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = triangles[t][k];
      const std::uint32_t to = triangles[t][(k + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), 3 * t + k, from < to});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
  });
  return sides;
}

/// Corners of a side at its lower and its higher vertex.
std::uint32_t corner_at_low(const Side& s) { return s.forward ? s.corner : next_corner(s.corner); }
std::uint32_t corner_at_high(const Side& s) { return s.forward ? next_corner(s.corner) : s.corner; }

MeshTopology analyse_topology(std::size_t vertex_count, const std::vector<Triangle>& triangles) {
  MeshTopology result;
  const std::vector<Side> sides = sorted_sides(triangles);
  UnionFind components(triangles.size());
  UnionFind fans(3 * triangles.size());  // corners, joined across edges with two triangles
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
    ++result.edges;
    for (std::size_t i = begin + 1; i < end; ++i) components.join(sides[begin].corner / 3, sides[i].corner / 3);
    const std::size_t count = end - begin;
    const auto forward = static_cast<std::size_t>(
        std::count_if(&sides[begin], &sides[begin] + count, [](const Side& s) { return s.forward; }));
    if (count == 1) ++result.border_edges;
    if (count > 2) ++result.nonmanifold_edges;
    if (count > 1 && 2 * forward != count) ++result.misoriented_edges;
    if (count == 2) {
      fans.join(corner_at_low(sides[begin]), corner_at_low(sides[begin + 1]));
      fans.join(corner_at_high(sides[begin]), corner_at_high(sides[begin + 1]));
    }
    begin = end;
  }
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

struct MassProperties {
  double area, volume;
  Eigen::Vector3d centroid;
  std::vector<std::uint32_t> zero_area;
};

/// Area, signed volume and centroid, by the tetrahedra of all triangles with `origin` (divergence theorem).
MassProperties integrate(const std::vector<Eigen::Vector3d>& vertices, const std::vector<Triangle>& triangles,
                         const Eigen::Vector3d& origin) {
  MassProperties result;
  CompensatedSum area, volume;
  std::array<CompensatedSum, 3> first_moment, surface_moment;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Eigen::Vector3d a = vertices[triangles[i][0]] - origin;
    const Eigen::Vector3d b = vertices[triangles[i][1]] - origin;
    const Eigen::Vector3d c = vertices[triangles[i][2]] - origin;
    const Eigen::Vector3d cross = (b - a).cross(c - a);
    const double triangle_area = 0.5 * cross.norm();
    if (triangle_area == 0.0) result.zero_area.push_back(i);
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
  result.area = area.value();
  result.volume = volume.value();
  const bool bounds_a_body = result.volume != 0.0;
  const double mass = bounds_a_body ? result.volume : result.area;
  const auto& moment = bounds_a_body ? first_moment : surface_moment;
  result.centroid = origin;
  if (mass != 0.0) {
    result.centroid += Eigen::Vector3d(moment[0].value(), moment[1].value(), moment[2].value()) / mass;
  }
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

Mesh Mesh::build(std::vector<Eigen::Vector3d> vertices, std::vector<Triangle> triangles, std::string name,
                 MeshRepairs repairs) {
  check_input(vertices, triangles);
  Mesh mesh;
  mesh.name_ = std::move(name);
  mesh.repairs_ = std::move(repairs);
  weld(vertices, triangles, mesh.repairs_);
  mesh.vertices_ = std::move(vertices);
  mesh.triangles_ = std::move(triangles);
  for (const Eigen::Vector3d& p : mesh.vertices_) mesh.box_.extend(p);
  if (!std::isfinite(mesh.diagonal())) throw BadMesh("the bounding box is too large for double precision");
  mesh.topology_ = analyse_topology(mesh.vertices_.size(), mesh.triangles_);
  MassProperties mass = integrate(mesh.vertices_, mesh.triangles_, mesh.center());
  mesh.area_ = mass.area;
  mesh.volume_ = mass.volume;
  mesh.centroid_ = mass.centroid;
  mesh.repairs_.zero_area_triangles = std::move(mass.zero_area);
  mesh.hash_ = content_hash(mesh.vertices_, mesh.triangles_);
  return mesh;
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
