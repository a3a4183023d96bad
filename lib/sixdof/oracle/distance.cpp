#include <sixdof/oracle/distance.h>

#include <algorithm>
#include <numeric>

#include <Eigen/Geometry>

#include <sixdof/oracle/distance_traversal.h>
#include <sixdof/oracle/winding.h>

namespace sixdof {
namespace {

using Eigen::Vector3d;

/// The first vertex of each piece of the surface. Pieces are connected through vertices: where surfaces do not
/// intersect, all of a piece lies on one side of the other surface.
std::vector<Vector3d> find_piece_vertices(const Mesh& mesh) {
  if (!mesh.solid()) return {};
  std::vector<std::uint32_t> root(mesh.vertices().size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&root](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (const Triangle& t : mesh.triangles()) {
    for (const std::uint32_t v : {t[1], t[2]}) {
      const std::uint32_t x = find(t[0]);
      const std::uint32_t y = find(v);
      root[std::max(x, y)] = std::min(x, y);
    }
  }
  std::vector<Vector3d> vertices;
  for (std::uint32_t v = 0; v < root.size(); ++v) {
    if (root[v] == v) vertices.push_back(mesh.vertices()[v]);
  }
  return vertices;
}

/// How DistanceQuery transforms the corners of B.
Vector3d transform_point_of_b(const Pose& X_AB, const Vector3d& p) { return X_AB * p; }

/// Whether the boxes around the two meshes are certainly apart, by the axes of both.
bool boxes_apart(const Tree& a, const Tree& b, const Pose& X_AB) {
  const Tree::Volume& box_a = a.nodes()[0].volume;
  const Tree::Volume& box_b = b.nodes()[0].volume;
  Vector3d half_a, half_b, middle_a, middle_b;
  for (int k = 0; k < 3; ++k) {
    half_a[k] = 0.5 * (static_cast<double>(box_a.upper[k]) - static_cast<double>(box_a.lower[k]));
    half_b[k] = 0.5 * (static_cast<double>(box_b.upper[k]) - static_cast<double>(box_b.lower[k]));
    middle_a[k] = static_cast<double>(box_a.lower[k]) + half_a[k] + a.center()[k];
    middle_b[k] = static_cast<double>(box_b.lower[k]) + half_b[k] + b.center()[k];
  }
  const Vector3d between = X_AB * middle_b - middle_a;
  const double slack = 1e-9 * (a.radius() + b.radius()) +
                       1e-14 * (a.center().cwiseAbs() + b.center().cwiseAbs() + X_AB.t.cwiseAbs()).sum();
  const Eigen::Matrix3d abs_R = X_AB.R.cwiseAbs();
  return (between.cwiseAbs() - half_a - abs_R * half_b).maxCoeff() > slack ||
         ((X_AB.R.transpose() * between).cwiseAbs() - half_b - abs_R.transpose() * half_a).maxCoeff() > slack;
}

}  // namespace

DistanceOracle::Body::Body(const Mesh& mesh)
    : tree(mesh), patches(tree), seeds(tree), piece_vertices(find_piece_vertices(mesh)) {}

std::size_t DistanceOracle::Body::bytes() const {
  return tree.bytes() + patches.bytes() + piece_vertices.capacity() * sizeof(Vector3d);
}

DistanceOracle::DistanceOracle(const Mesh& a, const Mesh& b)
    : a_(std::make_shared<const Body>(a)), b_(&a == &b ? a_ : std::make_shared<const Body>(b)) {}

std::size_t DistanceOracle::bytes() const { return a_->bytes() + (b_ == a_ ? 0 : b_->bytes()); }

double DistanceOracle::tie_width(const Pose& X_AB) const {
  return detail::TieWindow::of(a_->tree, a_->patches, b_->tree, b_->patches, X_AB).width;
}

DistanceQuery::DistanceQuery(const DistanceOracle& oracle) : oracle_(oracle) {
  search_.a = &oracle.a_->tree;
  search_.b = &oracle.b_->tree;
  search_.patches_a = &oracle.a_->patches;
  search_.patches_b = &oracle.b_->patches;
}

void DistanceQuery::prepare(const Pose& X_AB, bool warm_start) {
  search_.X_AB = X_AB;
  search_.ties = detail::TieWindow::of(*search_.a, *search_.patches_a, *search_.b, *search_.patches_b, X_AB);
  search_.found = false;
  search_.measured.clear();
  search_.counts = {};
  if (!warm_start) {
    closest_pair_.reset();
    intersecting_pair_.reset();
    search_.direction.setZero();
  }
}

Separation DistanceQuery::distance(const Pose& X_AB, const DistanceOptions& options) {
  prepare(X_AB, options.warm_start);
  detail::DistanceSearch& s = search_;
  s.best = options.upper_bound;
  if (closest_pair_ && detail::try_update(s, *closest_pair_)) s.direction = s.closest.on_b - s.closest.on_a;
  const auto intersecting = [&s] { return s.found && s.best == 0.0; };
  if (!intersecting()) detail::seed_search(s, oracle_.a_->seeds, oracle_.b_->seeds);
  if (!intersecting()) detail::find_closest(s);
  Separation result;
  result.has_witnesses = s.found && s.closest.distance <= options.upper_bound;
  if (!result.has_witnesses) {
    result.distance = std::numeric_limits<double>::infinity();
    return result;
  }
  closest_pair_ = s.pair;
  result.distance = s.closest.distance;
  result.witness_a = s.closest.on_a;
  result.witness_b = s.closest.on_b;
  result.triangle_a = s.a->mesh_triangle()[s.pair.a];
  result.triangle_b = s.b->mesh_triangle()[s.pair.b];
  return result;
}

bool DistanceQuery::surfaces_intersect(const Pose& X_AB, bool warm_start) {
  search_.counts = {};
  return !boxes_apart(*search_.a, *search_.b, X_AB) && intersect(X_AB, warm_start);
}

bool DistanceQuery::intersect(const Pose& X_AB, bool warm_start) {
  prepare(X_AB, warm_start);
  if (intersecting_pair_ && detail::intersects(search_, *intersecting_pair_)) return true;
  detail::find_intersection(search_);
  if (search_.found) intersecting_pair_ = search_.pair;
  return search_.found;
}

bool DistanceQuery::collide(const Pose& X_AB, bool warm_start) {
  search_.counts = {};
  if (boxes_apart(*search_.a, *search_.b, X_AB)) return false;
  if (intersect(X_AB, warm_start)) return true;
  const std::vector<Vector3d>& of_a = oracle_.a_->piece_vertices;
  const std::vector<Vector3d>& of_b = oracle_.b_->piece_vertices;
  if (of_a.empty() || of_b.empty()) return false;
  for (const Vector3d& p : of_b) {
    if (detail::winding_of_a(*search_.a, X_AB * p, triangles_) > 0) return true;
  }
  for (const Vector3d& p : of_a) {
    if (detail::winding_of_b(*search_.b, X_AB, transform_point_of_b, p, triangles_) > 0) return true;
  }
  return false;
}

}  // namespace sixdof
