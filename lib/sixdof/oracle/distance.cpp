#include <sixdof/oracle/distance.h>

#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include <sixdof/geometry/sides.h>
#include <sixdof/oracle/far_pair.h>
#include <sixdof/oracle/nested.h>

namespace sixdof {
namespace {

using Eigen::Vector3d;

/// Empty unless the mesh is solid.
std::vector<Vector3d> find_piece_vertices(const Mesh& mesh) {
  std::vector<Vector3d> vertices;
  if (!mesh.solid()) return vertices;
  for (const std::uint32_t v : detail::first_vertices_of_pieces(mesh.triangles(), mesh.vertices().size())) {
    vertices.push_back(mesh.vertices()[v]);
  }
  return vertices;
}

}  // namespace

std::vector<std::uint32_t> detail::first_vertices_of_pieces(std::span<const Triangle> triangles, std::size_t vertices) {
  UnionFind pieces(vertices);
  for (const Triangle& t : triangles) {
    pieces.join(t[0], t[1]);
    pieces.join(t[0], t[2]);
  }
  std::vector<std::uint32_t> first;
  std::vector<bool> seen(vertices, false);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const std::uint32_t piece = pieces.find(v);
    if (!seen[piece]) first.push_back(v);
    seen[piece] = true;
  }
  return first;
}

detail::DistanceBody::DistanceBody(const Mesh& mesh)
    : tree(mesh),
      box(mesh.box()),
      bound(tree),
      patches(tree),
      seeds(tree),
      smallest_leaf(smallest_leaf_of(tree)),
      piece_vertices(find_piece_vertices(mesh)) {}

detail::DistanceBody::DistanceBody(Tree made)
    : tree(std::move(made)), patches(tree, true), seeds(tree), smallest_leaf(smallest_leaf_of(tree)) {}

void detail::DistanceBody::update() {
  patches = CoplanarPatches(tree, true);
  seeds = SeedCorners(tree);
  smallest_leaf = smallest_leaf_of(tree);
}

std::size_t detail::DistanceBody::bytes() const {
  return tree.bytes() + bound.bytes() + patches.bytes() + piece_vertices.capacity() * sizeof(Vector3d);
}

DistanceOracle::DistanceOracle(const Mesh& a, const Mesh& b)
    : a_(std::make_shared<const detail::DistanceBody>(a)),
      b_(&a == &b ? a_ : std::make_shared<const detail::DistanceBody>(b)) {}

std::size_t DistanceOracle::bytes() const { return a_->bytes() + (b_ == a_ ? 0 : b_->bytes()); }

double DistanceOracle::tie_width(const Pose& X_AB) const { return detail::TieWindow::of(*a_, *b_, X_AB).width; }

bool DistanceOracle::certainly_apart(const Pose& X_AB) const {
  return detail::certainly_apart(a_->bound, b_->bound, X_AB);
}

void DistanceQuery::prepare(const Pose& X_AB, bool warm_start) {
  search_.X_AB = X_AB;
  search_.ties = detail::TieWindow::of(search_.a, search_.b, X_AB);
  search_.found = false;
  search_.of_bodies = false;
  search_.found_inside = false;
  search_.measured.clear();
  search_.counts = {};
  if (!warm_start) {
    closest_pair_.reset();
    intersecting_pair_.reset();
    search_.direction.setZero();
  }
}

Separation DistanceQuery::distance(const Pose& X_AB, bool warm_start) {
  prepare(X_AB, warm_start);
  detail::DistanceSearch& s = search_;
  s.best = std::numeric_limits<double>::infinity();
  s.closest.reset();
  if (detail::are_far(s.a, s.b, X_AB)) {
    detail::take_far_pair(s);
  } else {
    if (closest_pair_) detail::try_update(s, *closest_pair_);
    if (s.best != 0.0) detail::seed_search(s);
    if (s.best != 0.0) detail::find_pair(s, false);
  }
  Separation result;
  const ClosestPoints& closest = detail::points_of(s);
  result.has_witnesses = !std::isnan(closest.distance);  // NaN: coordinates that overflow
  if (!result.has_witnesses) {
    result.distance = std::numeric_limits<double>::infinity();
    return result;
  }
  closest_pair_ = s.pair;
  result.distance = closest.distance;
  result.witness_a = closest.on_a;
  result.witness_b = closest.on_b;
  result.triangle_a = s.a.tree.mesh_triangle()[s.pair.a];
  result.triangle_b = s.b.tree.mesh_triangle()[s.pair.b];
  return result;
}

bool DistanceQuery::collide(const Pose& X_AB, bool warm_start) {
  search_.counts = {};
  if (detail::certainly_apart(search_.a.bound, search_.b.bound, X_AB)) return false;
  prepare(X_AB, warm_start);
  if (intersecting_pair_ && detail::intersects(search_, *intersecting_pair_)) return true;
  const std::vector<Vector3d>& of_a = search_.a.piece_vertices;
  const std::vector<Vector3d>& of_b = search_.b.piece_vertices;
  search_.of_bodies = !of_a.empty() && !of_b.empty();
  detail::find_pair(search_, true);
  if (search_.found_inside) return true;
  if (search_.found) {
    intersecting_pair_ = search_.pair;
    return true;
  }
  return search_.of_bodies && detail::is_nested(search_.a, search_.b, X_AB, search_.triangles);
}

}  // namespace sixdof
