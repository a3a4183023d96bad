#include <sixdof/oracle/distance.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <sixdof/geometry/predicates.h>
#include <sixdof/oracle/winding_rays.h>

namespace sixdof {
namespace {

using Eigen::Vector3d;

std::vector<DistanceOracle::Piece> find_pieces(const Mesh& mesh) {
  if (!mesh.solid()) return {};
  // Pieces are joined through vertices: where surfaces do not meet, all of a piece lies on one side.
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
  std::vector<DistanceOracle::Piece> pieces;
  std::vector<std::uint32_t> index(root.size());
  for (std::uint32_t v = 0; v < root.size(); ++v) {
    const Vector3d& p = mesh.vertices()[v];
    const std::uint32_t first = find(v);  // the lowest vertex of the piece: met before the others
    if (first == v) {
      index[v] = static_cast<std::uint32_t>(pieces.size());
      pieces.push_back({p, {}});
    }
    pieces[index[first]].box.extend(p);
  }
  return pieces;
}

std::shared_ptr<const Tree> second_tree(const Mesh& a, const std::shared_ptr<const Tree>& tree_a, const Mesh& b) {
  return &a == &b ? tree_a : std::make_shared<const Tree>(b);
}

/// Adds up how segment p -> q passes through triangle t: +1 leaving (along the normal), -1 entering, 0 missing.
/// Returns false if it touches the border or an end: the sum says nothing then.
bool add_crossing(const Vector3d& p, const Vector3d& q, const TriangleCorners& t, int& sum) {
  const int o0 = orient3d(p, q, t[0], t[1]);
  const int o1 = orient3d(p, q, t[1], t[2]);
  if (o0 * o1 < 0) return true;
  const int o2 = orient3d(p, q, t[2], t[0]);
  if (o0 * o2 < 0 || o1 * o2 < 0) return true;
  const int side_p = orient3d(t[0], t[1], t[2], p);
  const int side_q = orient3d(t[0], t[1], t[2], q);
  if (side_p * side_q > 0) return true;
  if (o0 == 0 || o1 == 0 || o2 == 0 || side_p == 0 || side_q == 0) return false;
  sum += side_q;
  return true;
}

/// A ray as a segment that ends outside of the mesh: from p, in A's frame, and in the frame of the tree that it
/// crosses.
struct Ray {
  Vector3d from;
  Vector3d to;
  Vector3d local_from;  // relative to the tree's centre
  Vector3d local_direction;
  double length;
  double slack;  // of the way to the tree's frame, far above rounding

  /// Whether it may cross child `i` of a node.
  bool meets(const Tree::Node& node, std::size_t i) const {
    double enter = 0.0;
    double leave = length;
    for (int k = 0; k < 3; ++k) {  // no component of a direction is zero in A; in B it may be
      const double lower = static_cast<double>(node.lower[k][i]) - slack - local_from[k];
      const double upper = static_cast<double>(node.upper[k][i]) + slack - local_from[k];
      const double d = local_direction[k];
      if (std::abs(d) < 1e-9) {  // drifts less than the slack over the whole length
        if (lower > 0.0 || upper < 0.0) return false;
        continue;
      }
      enter = std::max(enter, std::min(lower / d, upper / d));
      leave = std::min(leave, std::max(lower / d, upper / d));
    }
    return enter <= leave;
  }
};

/// Adds up all crossings of the surface of `tree`, moved by `pose`. Returns false if the ray touches a border.
bool add_crossings(const Tree& tree, const Pose* pose, const Ray& ray, std::vector<std::uint32_t>& open, int& sum) {
  open.assign(1, 0);
  while (!open.empty()) {
    const Tree::Node& node = tree.nodes()[open.back()];
    open.pop_back();
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      if (!ray.meets(node, i)) continue;
      const Tree::Child child = node.child[i];
      if (!child.is_leaf()) {
        open.push_back(child.node());
        continue;
      }
      for (std::uint32_t t = child.first(); t < child.first() + child.count(); ++t) {
        TriangleCorners corners = tree.corners()[t];
        if (pose) {
          for (Vector3d& corner : corners) corner = *pose * corner;
        }
        if (!add_crossing(ray.from, ray.to, corners, sum)) return false;
      }
    }
  }
  return true;
}

/// Winding number of the surface of `tree`, moved by `pose`, around p.
int winding(const Tree& tree, const Pose* pose, const Vector3d& p, std::vector<std::uint32_t>& open) {
  const Vector3d local_p = (pose ? Vector3d(pose->R.transpose() * (p - pose->t)) : p) - tree.center();
  const double offset = tree.center().norm() + (pose ? pose->t.norm() : 0.0) + p.norm();
  const double slack = 1e-6 * tree.radius() + 1e-14 * offset;
  const Tree::Volume& box = tree.nodes()[0].volume;
  for (int k = 0; k < 3; ++k) {
    if (local_p[k] < static_cast<double>(box.lower[k]) - slack) return 0;
    if (local_p[k] > static_cast<double>(box.upper[k]) + slack) return 0;
  }
  const double length = 4.0 * tree.radius();  // longer than any way out of the mesh from inside of its box
  const auto& rays = detail::k_winding_rays;
  const auto direction = [&rays](std::size_t i) { return Vector3d(rays[i][0], rays[i][1], rays[i][2]).normalized(); };
  // The ray that leads away from the centre most directly meets the least of the mesh.
  const Vector3d outwards = pose ? Vector3d(pose->R * local_p) : local_p;
  std::size_t first = 0;
  for (std::size_t i = 1; i < rays.size(); ++i) {
    if (direction(i).dot(outwards) > direction(first).dot(outwards)) first = i;
  }
  for (std::size_t tried = 0; tried < rays.size(); ++tried) {
    const Vector3d u = direction((first + tried) % rays.size());
    const Vector3d local_u = pose ? Vector3d(pose->R.transpose() * u) : u;
    int sum = 0;
    if (add_crossings(tree, pose, {p, p + length * u, local_p, local_u, length, slack}, open, sum)) return sum;
  }
  return 0;  // p lies on the surface, up to rounding
}

/// Whether the boxes around two whole meshes are apart for certain, by their faces' normals.
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
  const Eigen::Matrix3d reach = X_AB.R.cwiseAbs();
  return (between.cwiseAbs() - half_a - reach * half_b).maxCoeff() > slack ||
         ((X_AB.R.transpose() * between).cwiseAbs() - half_b - reach.transpose() * half_a).maxCoeff() > slack;
}

}  // namespace

DistanceOracle::DistanceOracle(const Mesh& a, std::shared_ptr<const Tree> tree_a, const Mesh& b,
                               std::shared_ptr<const Tree> tree_b)
    : tree_a_(std::move(tree_a)),
      tree_b_(tree_b ? std::move(tree_b) : second_tree(a, tree_a_, b)),
      solid_a_(a.solid()),
      solid_b_(b.solid()),
      pieces_a_(find_pieces(a)),
      pieces_b_(&a == &b ? pieces_a_ : find_pieces(b)),
      samples_a_(*tree_a_),
      samples_b_(*tree_b_),
      flats_a_(std::make_shared<const detail::Flats>(*tree_a_)),
      flats_b_(tree_b_ == tree_a_ ? flats_a_ : std::make_shared<const detail::Flats>(*tree_b_)) {}

DistanceOracle::DistanceOracle(const Mesh& a, const Mesh& b)
    : DistanceOracle(a, std::make_shared<const Tree>(a), b, nullptr) {}

std::size_t DistanceOracle::bytes() const {
  return tree_a_->bytes() + (tree_b_ == tree_a_ ? 0 : tree_b_->bytes()) + flats_a_->bytes() +
         (flats_b_ == flats_a_ ? 0 : flats_b_->bytes()) + (pieces_a_.capacity() + pieces_b_.capacity()) * sizeof(Piece);
}

double DistanceOracle::tie_width(const Pose& X_AB) const {
  return detail::TieWindow::of(*tree_a_, *flats_a_, *tree_b_, *flats_b_, X_AB).width;
}

DistanceQuery::DistanceQuery(const DistanceOracle& oracle) : oracle_(oracle) {
  traversal_.a = oracle.tree_a().get();
  traversal_.b = oracle.tree_b().get();
  traversal_.flats_a = &oracle.flats_a();
  traversal_.flats_b = &oracle.flats_b();
}

void DistanceQuery::prepare(const Pose& X_AB, bool warm_start) {
  traversal_.X_AB = X_AB;
  traversal_.ties =
      detail::TieWindow::of(*oracle_.tree_a(), oracle_.flats_a(), *oracle_.tree_b(), oracle_.flats_b(), X_AB);
  traversal_.found = false;
  traversal_.measured.clear();
  traversal_.counts = {};
  if (!warm_start) {
    closest_pair_.reset();
    intersecting_pair_.reset();
    traversal_.direction.setZero();
  }
}

Separation DistanceQuery::distance(const Pose& X_AB, const DistanceOptions& options) {
  prepare(X_AB, options.warm_start);
  detail::Traversal& t = traversal_;
  t.best = options.upper_bound;
  if (closest_pair_) {
    if (detail::offer_pair(t, *closest_pair_)) t.direction = t.closest.on_b - t.closest.on_a;
  }
  if (!(t.found && t.best == 0.0)) detail::offer_seed(t, oracle_.samples_a(), oracle_.samples_b());
  if (!(t.found && t.best == 0.0)) detail::find_closest(t);
  Separation result;
  result.has_witnesses = t.found && t.closest.distance <= options.upper_bound;
  if (!result.has_witnesses) {
    result.distance = std::numeric_limits<double>::infinity();
    return result;
  }
  closest_pair_ = t.pair;
  result.distance = t.closest.distance;
  result.witness_a = t.closest.on_a;
  result.witness_b = t.closest.on_b;
  result.triangle_a = t.a->mesh_triangle()[t.pair.a];
  result.triangle_b = t.b->mesh_triangle()[t.pair.b];
  return result;
}

bool DistanceQuery::may_meet(const Pose& X_AB) {
  traversal_.counts = {};
  return !boxes_apart(*oracle_.tree_a(), *oracle_.tree_b(), X_AB);
}

bool DistanceQuery::surfaces_intersect(const Pose& X_AB, bool warm_start) {
  return may_meet(X_AB) && intersect(X_AB, warm_start);
}

bool DistanceQuery::intersect(const Pose& X_AB, bool warm_start) {
  prepare(X_AB, warm_start);
  detail::Traversal& t = traversal_;
  if (intersecting_pair_) {
    if (detail::intersects(t, *intersecting_pair_)) return true;
  }
  detail::find_intersection(t);
  if (t.found) intersecting_pair_ = t.pair;
  return t.found;
}

bool DistanceQuery::collide(const Pose& X_AB, bool warm_start) {
  if (!may_meet(X_AB)) return false;
  if (intersect(X_AB, warm_start)) return true;
  if (oracle_.solid_a()) {
    for (const DistanceOracle::Piece& piece : oracle_.pieces_b()) {
      if (winding_a(X_AB * piece.vertex) > 0) return true;
    }
  }
  if (oracle_.solid_b()) {
    for (const DistanceOracle::Piece& piece : oracle_.pieces_a()) {
      if (winding_b(X_AB, piece.vertex) > 0) return true;
    }
  }
  return false;
}

int DistanceQuery::winding_a(const Vector3d& p) const { return winding(*oracle_.tree_a(), nullptr, p, open_); }

int DistanceQuery::winding_b(const Pose& X_AB, const Vector3d& p) const {
  return winding(*oracle_.tree_b(), &X_AB, p, open_);
}

}  // namespace sixdof
