#include <sixdof/geometry/shape_facts.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

namespace sixdof {
namespace {

/// The edges of a triangle, by its smaller vertex number first.
struct EdgeOfTriangle {
  std::uint64_t edge = 0;
  std::uint32_t triangle = 0;

  auto operator<=>(const EdgeOfTriangle&) const = default;
};

Eigen::Vector3d doubled_area_vector(const Mesh& mesh, const Triangle& t) {
  const Eigen::Vector3d& p = mesh.vertices()[t[0]];
  return (mesh.vertices()[t[1]] - p).cross(mesh.vertices()[t[2]] - p);
}

std::vector<EdgeOfTriangle> sorted_edges(const Mesh& mesh) {
  std::vector<EdgeOfTriangle> edges;
  edges.reserve(3 * mesh.triangles().size());
  for (std::uint32_t i = 0; i < mesh.triangles().size(); ++i) {
    const Triangle& t = mesh.triangles()[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      edges.push_back({(std::uint64_t{low} << 32) | high, i});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Angles between the normals of the two triangles of an edge, in radians; of edges with two triangles that have an
/// area.
std::vector<double> bends(const Mesh& mesh, const std::vector<Eigen::Vector3d>& area_vectors) {
  const std::vector<EdgeOfTriangle> edges = sorted_edges(mesh);
  std::vector<double> angles;
  angles.reserve(edges.size() / 2);
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].edge == edges[begin].edge) ++end;
    if (end - begin != 2) continue;
    const Eigen::Vector3d& u = area_vectors[edges[begin].triangle];
    const Eigen::Vector3d& v = area_vectors[edges[begin + 1].triangle];
    if (u.isZero(0.0) || v.isZero(0.0)) continue;
    angles.push_back(std::atan2(u.cross(v).norm(), u.dot(v)));
  }
  return angles;
}

double flat_share(const std::vector<double>& bends) {
  if (bends.empty()) return 0.0;
  const auto count = static_cast<double>(bends.size());
  const double mean = std::accumulate(bends.begin(), bends.end(), 0.0) / count;
  const auto flat =
      std::count_if(bends.begin(), bends.end(), [&](double bend) { return bend <= ShapeFacts::k_flat_share * mean; });
  return static_cast<double>(flat) / count;
}

double aligned_share(const std::vector<Eigen::Vector3d>& area_vectors) {
  const double cosine = std::cos(ShapeFacts::k_aligned_deg * std::numbers::pi / 180.0);
  double aligned = 0.0, all = 0.0;
  for (const Eigen::Vector3d& vector : area_vectors) {
    const double area = vector.norm();
    all += area;
    if (vector.cwiseAbs().maxCoeff() >= cosine * area) aligned += area;
  }
  return all > 0.0 ? aligned / all : 0.0;
}

}  // namespace

ShapeFacts shape_facts(const Mesh& mesh) {
  std::vector<Eigen::Vector3d> area_vectors;
  area_vectors.reserve(mesh.triangles().size());
  for (const Triangle& t : mesh.triangles()) area_vectors.push_back(doubled_area_vector(mesh, t));

  ShapeFacts facts;
  const MeshTopology& topology = mesh.topology();
  if (topology.closed && topology.manifold) {
    facts.genus = static_cast<std::int64_t>(topology.components) - topology.euler_characteristic / 2;
  }
  const Eigen::Vector3d size = mesh.box().sizes();
  if (size.maxCoeff() > 0.0) facts.box_aspect = size.minCoeff() / size.maxCoeff();
  if (mesh.solid()) {
    facts.box_fill = mesh.volume() / mesh.box().volume();
    facts.thickness = 2.0 * mesh.volume() / mesh.area() / mesh.diagonal();
  }
  facts.aligned_share = aligned_share(area_vectors);
  facts.flat_share = flat_share(bends(mesh, area_vectors));
  return facts;
}

ShapeKind kind_of(const ShapeFacts& facts) {
  constexpr std::int64_t k_many_handles = 10;
  constexpr double k_thin = 0.02;     // a sheet of 1 % to 2 % of its own diagonal
  constexpr double k_slender = 0.04;  // a needle or a disc of 1 : 25
  constexpr double k_boxy = 0.8;      // walls along the axes, with some rounding between them
  constexpr double k_flat_faces =
      0.25;  // a third of a meshed cylinder's edges is straight; curved surfaces have 0 to 0.1
  if (facts.genus >= k_many_handles) return ShapeKind::handles;
  // Without a volume there is no thickness.
  const bool sheet = facts.thickness > 0.0 && facts.thickness < k_thin;
  if (sheet || facts.box_aspect < k_slender) return ShapeKind::thin;
  if (facts.aligned_share >= k_boxy) return ShapeKind::boxy;
  return facts.flat_share >= k_flat_faces ? ShapeKind::cad : ShapeKind::organic;
}

std::string_view name_of(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::handles:
      return "handles";
    case ShapeKind::thin:
      return "thin";
    case ShapeKind::boxy:
      return "boxy";
    case ShapeKind::cad:
      return "cad";
    case ShapeKind::organic:
      return "organic";
  }
  return "";
}

}  // namespace sixdof
