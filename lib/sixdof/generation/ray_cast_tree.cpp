#include <sixdof/generation/ray_cast_tree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <Eigen/Geometry>

namespace sixdof::ray_cast {
namespace {

using Triangles = std::span<const Tree::Corners>;

/// The triangles below a child.
Triangles triangles_of(const Tree& tree, Tree::Child child) {
  if (child.is_leaf()) return tree.corners().subspan(child.first(), child.count());
  const Tree::Node& node = tree.nodes()[child.node()];
  return tree.corners().subspan(node.first_triangle, node.triangle_count);
}

/// Sets slab and box of one lane, relative to `origin`. The slab is the thinnest along the triangles' mean normal.
void fit_precise_volume(Triangles triangles, const Eigen::Vector3d& origin, PreciseVolumes& volumes, std::size_t lane) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Tree::Corners& t : triangles) sum += (t[1] - t[0]).cross(t[2] - t[0]);
  const double scale = sum.cwiseAbs().maxCoeff();
  const Eigen::Vector3d normal = scale > 0.0 ? Eigen::Vector3d((sum / scale).normalized()) : Eigen::Vector3d::UnitX();
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  Eigen::AlignedBox3d box;
  for (const Tree::Corners& t : triangles) {
    for (const Eigen::Vector3d& corner : t) {
      const Eigen::Vector3d p = corner - origin;
      low = std::min(low, normal.dot(p));
      high = std::max(high, normal.dot(p));
      box.extend(p);
    }
  }
  volumes.middle[lane] = 0.5 * (low + high);
  volumes.half[lane] = 0.5 * (high - low);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    volumes.normal[k][lane] = normal[axis];
    volumes.box_center[k][lane] = 0.5 * (box.min()[axis] + box.max()[axis]);
    volumes.box_half[k][lane] = 0.5 * (box.max()[axis] - box.min()[axis]);
  }
}

}  // namespace

CastMesh::CastMesh(std::shared_ptr<const Tree> tree) : tree_(std::move(tree)) {
  precise_volumes_.resize(tree_->nodes().size());
  for (std::size_t n = 0; n < precise_volumes_.size(); ++n) {
    const Tree::Node& node = tree_->nodes()[n];
    std::copy_n(node.child, Tree::k_width, precise_volumes_[n].child);
    precise_volumes_[n].child_count = node.child_count;
    for (std::size_t lane = 0; lane < node.child_count; ++lane) {
      fit_precise_volume(triangles_of(*tree_, node.child[lane]), tree_->center(), precise_volumes_[n], lane);
    }
  }
}

}  // namespace sixdof::ray_cast
