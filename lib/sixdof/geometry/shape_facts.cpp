#include <sixdof/geometry/shape_facts.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <sixdof/geometry/sides.h>

namespace sixdof {
namespace {

/// Angles between the normals of the two triangles of an edge, in radians; of edges with two triangles that have an
/// area.
std::vector<double> bends(const Mesh& mesh, const std::vector<Eigen::Vector3d>& area_vectors) {
  std::vector<double> angles;
  for_each_edge(sorted_sides(mesh.triangles()), [&](std::span<const Side> sides) {
    if (sides.size() != 2) return;
    const Eigen::Vector3d& u = area_vectors[sides[0].triangle()];
    const Eigen::Vector3d& v = area_vectors[sides[1].triangle()];
    if (!u.isZero(0.0) && !v.isZero(0.0)) angles.push_back(std::atan2(u.cross(v).norm(), u.dot(v)));
  });
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
  for (const Triangle& t : mesh.triangles()) {
    const Eigen::Vector3d& p = mesh.vertices()[t[0]];
    area_vectors.push_back((mesh.vertices()[t[1]] - p).cross(mesh.vertices()[t[2]] - p));
  }

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
  // A third of a meshed cylinder's edges is straight; curved surfaces have 0 to 0.1.
  constexpr double k_flat_faces = 0.25;
  if (facts.genus >= k_many_handles) return ShapeKind::handles;
  // Without a volume there is no thickness.
  const bool sheet = facts.thickness > 0.0 && facts.thickness < k_thin;
  if (sheet || facts.box_aspect < k_slender) return ShapeKind::thin;
  if (facts.aligned_share >= k_boxy) return ShapeKind::boxy;
  return facts.flat_share >= k_flat_faces ? ShapeKind::cad : ShapeKind::organic;
}

std::string_view name_of(ShapeKind kind) {
  constexpr std::string_view k_names[] = {"handles", "thin", "boxy", "cad", "organic"};
  return k_names[static_cast<std::size_t>(kind)];
}

}  // namespace sixdof
