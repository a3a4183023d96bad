#include <sixdof/oracle/deforming_mesh.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <sixdof/base/compensated_sum.h>

namespace sixdof {
namespace {

using Eigen::Vector3d;

/// Building a triangle's share of a tree takes as long as expanding so many pairs of nodes: about 500 ns of the prepare
/// rows of bench/published/growth against 50 to 70 ns. Another value moves the moment of a rebuild, no answer.
constexpr double k_build = 8.0;
/// A part whose ratio of areas has grown by less is left as it is.
constexpr double k_worth = 1.05;
/// Parts below a node are built instead of it if they save at least this share of what it would, and are at most this
/// share of it.
constexpr double k_half = 0.5;
/// Smaller parts are not taken apart.
constexpr std::uint32_t k_smallest_part = 256;
/// Rounding of a displacement relative to the coordinates.
constexpr double k_rounding = 1e-15;

double half_area_of_child(const Tree::Node& node, std::size_t i) {
  const float x = node.upper[0][i] - node.lower[0][i], y = node.upper[1][i] - node.lower[1][i],
              z = node.upper[2][i] - node.lower[2][i];
  return static_cast<double>(x * y + y * z + z * x);
}

/// As Mesh::volume().
double volume_of(std::span<const Vector3d> vertices, std::span<const Triangle> triangles, const Vector3d& origin) {
  CompensatedSum volume;
  for (const Triangle& t : triangles) {
    const Vector3d a = vertices[t[0]] - origin, b = vertices[t[1]] - origin, c = vertices[t[2]] - origin;
    volume += a.dot(b.cross(c)) / 6.0;
  }
  return volume.value();
}

}  // namespace

std::vector<DeformingMesh::Areas> DeformingMesh::areas_of(const Tree& tree) {
  std::vector<Areas> areas(tree.nodes().size());
  for (std::size_t index = areas.size(); index-- > 0;) {  // children before parents
    const Tree::Node& node = tree.nodes()[index];
    Areas& sum = areas[index];
    for (std::size_t i = 0; i < node.child_count; ++i) {
      const Tree::Child child = node.child[i];
      sum.boxes += half_area_of_child(node, i);
      if (!child.is_leaf()) {
        sum.boxes += areas[child.node()].boxes;
        sum.surface += areas[child.node()].surface;
        continue;
      }
      for (const Tree::Corners& c : tree.corners().subspan(child.first(), child.count())) {
        sum.surface += 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm();
      }
    }
  }
  return areas;
}

DeformingMesh::DeformingMesh(const Mesh& mesh)
    : triangles_(mesh.triangles()),
      vertices_(mesh.vertices()),
      body_(std::make_shared<detail::DistanceBody>(Tree(surface()))),
      prepared_(std::shared_ptr<const detail::DistanceBody>(body_)) {
  if (mesh.topology().closed && mesh.topology().oriented) {
    pieces_ = detail::first_vertices_of_pieces(triangles_, vertices_.size());
  }
  refresh();
  note_built();
}

double DeformingMesh::take(std::span<const Vector3d> vertices) {
  double squared = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    squared = std::max(squared, (vertices[i] - vertices_[i]).squaredNorm());
    largest = std::max(largest, vertices[i].cwiseAbs().maxCoeff());
    vertices_[i] = vertices[i] + Vector3d::Zero();  // -0 becomes +0, as in a Mesh
  }
  return std::sqrt(squared) * (1.0 + 4.0 * k_rounding) + k_rounding * largest;
}

void DeformingMesh::refresh() {
  detail::DistanceBody& body = *body_;
  body.box.setEmpty();
  for (const Vector3d& p : vertices_) body.box.extend(p);
  body.bound = detail::SupportBound(body.box);
  solid_ = !pieces_.empty() && volume_of(vertices_, triangles_, body.tree.center()) > 0.0;
  body.piece_vertices.clear();
  if (!solid_) return;
  for (const std::uint32_t v : pieces_) body.piece_vertices.push_back(vertices_[v]);
}

void DeformingMesh::note_built() {
  const std::vector<Areas> areas = areas_of(body_->tree);
  built_.resize(areas.size());
  for (std::size_t i = 0; i < areas.size(); ++i) built_[i] = static_cast<float>(areas[i].ratio());
  fresh_ = true;
  work_ = 0.0;
  wasted_ = 0.0;
}

double DeformingMesh::rebuild(std::span<const Vector3d> vertices) {
  detail::DistanceBody made{Tree(tree_builder::Surface{vertices, triangles_})};  // may throw
  const double moved = take(vertices);
  *body_ = std::move(made);
  refresh();
  note_built();
  built_triangles_ += triangles_.size();
  return moved;
}

double DeformingMesh::refit(std::span<const Vector3d> vertices) {
  body_->tree.refit({vertices, triangles_});  // may throw
  const double moved = take(vertices);
  body_->update();
  refresh();
  fresh_ = false;
  return moved;
}

double DeformingMesh::update(std::span<const Vector3d> vertices) {
  const double moved = refit(vertices);
  apply_rule();
  return moved;
}

void DeformingMesh::make_fresh() {
  if (fresh_) return;
  const std::vector<Vector3d> here = vertices_;
  rebuild(here);
}

DeformingMesh::Parts DeformingMesh::find_parts(std::uint32_t index, const std::vector<Areas>& areas) const {
  const Tree::Node& node = body_->tree.nodes()[index];
  const double before = static_cast<double>(built_[index]) * areas[index].surface;
  const double saved = std::max(0.0, areas[index].boxes - before);
  Parts below;
  if (node.triangle_count >= k_smallest_part) {
    for (std::size_t i = 0; i < node.child_count; ++i) {
      if (node.child[i].is_leaf()) continue;
      const Parts of_child = find_parts(node.child[i].node(), areas);
      below.nodes.insert(below.nodes.end(), of_child.nodes.begin(), of_child.nodes.end());
      below.saved += of_child.saved;
      below.price += of_child.price;
    }
  }
  const bool is_better_below = below.saved >= k_half * saved && below.price <= k_half * node.triangle_count;
  if (is_better_below || areas[index].boxes < k_worth * before) return below;
  return {{index}, saved, static_cast<double>(node.triangle_count)};
}

void DeformingMesh::apply_rule() {
  constexpr double k_least_part = Tree::k_width * Tree::k_leaf_triangles;
  if (work_ < k_build * k_least_part) return;  // not worth a look at all nodes
  const double work = std::exchange(work_, 0.0);
  const std::vector<Areas> areas = areas_of(body_->tree);
  const Parts parts = find_parts(0, areas);
  if (parts.nodes.empty()) return;
  wasted_ += work * parts.saved / areas[0].boxes;
  if (wasted_ < k_build * parts.price) return;
  wasted_ = 0.0;
  built_triangles_ += static_cast<std::uint64_t>(parts.price);
  if (parts.nodes.front() == 0) {
    detail::DistanceBody made{Tree(surface())};
    *body_ = std::move(made);
    refresh();
    return note_built();
  }
  const std::vector<std::uint32_t> origin = body_->tree.rebuild(surface(), parts.nodes);
  const std::vector<Areas> now = areas_of(body_->tree);
  std::vector<float> built(now.size());
  for (std::size_t i = 0; i < now.size(); ++i) {
    built[i] = origin[i] == Tree::k_new ? static_cast<float>(now[i].ratio()) : built_[origin[i]];
  }
  built_ = std::move(built);
  body_->update();
}

std::size_t DeformingMesh::bytes() const {
  return body_->bytes() + triangles_.capacity() * sizeof(Triangle) + vertices_.capacity() * sizeof(Vector3d) +
         built_.capacity() * sizeof(float);
}

}  // namespace sixdof
