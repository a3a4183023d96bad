#include <sixdof/oracle/convex_depth.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace sixdof {
namespace {

using Eigen::Vector3d;

/// Sines of angles on the Gauss map below this are rounding: an arc that nearly ends at another counts as crossing.
constexpr double k_arc_slack = 1e-9;

/// An edge between two faces that are not coplanar.
struct Edge {
  Vector3d start;
  Vector3d along;        ///< A unit vector.
  Vector3d left, right;  ///< Outward unit normals of the faces.
};

struct Body {
  std::vector<Vector3d> vertices, normals;
  std::vector<Edge> edges;

  Body(const Mesh& mesh, const Pose& X) {
    for (const Vector3d& p : mesh.vertices()) vertices.push_back(X * p);
    std::map<std::pair<std::uint32_t, std::uint32_t>, Vector3d> open;
    for (const Triangle& t : mesh.triangles()) {
      const Vector3d area = (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]);
      if (area.isZero(0.0)) continue;
      const Vector3d normal = area.normalized();
      normals.push_back(normal);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = t[k], to = t[(k + 1) % 3];
        const auto known = open.find(std::minmax(from, to));
        if (known == open.end()) {
          open.emplace(std::minmax(from, to), normal);
        } else if (normal.cross(known->second).norm() > k_arc_slack) {
          edges.push_back({vertices[from], (vertices[to] - vertices[from]).normalized(), known->second, normal});
        }
      }
    }
  }

  double support(const Vector3d& n) const {
    double most = -std::numeric_limits<double>::infinity();
    for (const Vector3d& p : vertices) most = std::max(most, n.dot(p));
    return most;
  }
};

/// Whether n, which is at right angles to the edge, lies on the arc from one normal to the other (`sign` 1), or its
/// opposite does (`sign` -1).
bool is_on_arc(const Edge& edge, const Vector3d& n, double sign) {
  const Vector3d turn = edge.left.cross(edge.right);
  return sign * edge.left.cross(n).dot(turn) >= -k_arc_slack && sign * n.cross(edge.right).dot(turn) >= -k_arc_slack &&
         sign * n.dot(edge.left + edge.right) > 0.0;
}

/// The least support value found so far.
struct Least {
  const Body& a;
  const Body& b;
  ConvexDepth best{.depth = std::numeric_limits<double>::infinity()};

  void try_normal(const Vector3d& n) {
    const double width = a.support(n) + b.support(-n);
    if (width < best.depth) best = {width, n};
  }

  void try_edges(const Edge& e, const Edge& f) {
    // Necessary for arcs that cross: the ends of each lie on both sides of the plane of the other.
    if (f.left.dot(e.along) * f.right.dot(e.along) > k_arc_slack) return;
    if (e.left.dot(f.along) * e.right.dot(f.along) > k_arc_slack) return;
    Vector3d n = e.along.cross(f.along);
    const double sine = n.norm();
    if (sine < k_arc_slack) return;
    n /= sine;
    if (n.dot(e.left + e.right) < 0.0) n = -n;
    if (!is_on_arc(e, n, 1.0) || !is_on_arc(f, n, -1.0)) return;
    if (n.dot(e.start - f.start) < best.depth) try_normal(n);
  }
};

}  // namespace

ConvexDepth convex_depth(const Mesh& a, const Mesh& b, const Pose& X_AB) {
  const Body body_a(a, Pose{}), body_b(b, X_AB);
  Least least{body_a, body_b};
  for (const Vector3d& n : body_a.normals) least.try_normal(n);
  for (const Vector3d& n : body_b.normals) least.try_normal(-n);
  for (const Edge& e : body_a.edges) {
    for (const Edge& f : body_b.edges) least.try_edges(e, f);
  }
  least.best.depth = std::max(0.0, least.best.depth);
  return least.best;
}

}  // namespace sixdof
