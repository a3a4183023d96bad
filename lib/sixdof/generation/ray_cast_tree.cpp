#include <sixdof/generation/ray_cast_tree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <Eigen/Geometry>

namespace sixdof::ray_cast {
namespace {

constexpr std::size_t k_width = Tree::k_width;
constexpr std::size_t k_leaf_triangles = Tree::k_leaf_triangles;

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

struct Ball {
  Eigen::Vector3d center;
  double radius;
};

/// A small ball around the triangles, in the mesh's frame: from the centre of their box a few steps towards the
/// farthest corner (Badoiu and Clarkson, "Smaller core-sets for balls", SODA 2003).
Ball fit_ball(Triangles triangles) {
  constexpr std::size_t k_large = 512;  // triangles; the ball of more is far from the surface anyway
  constexpr int k_steps = 10;
  Eigen::AlignedBox3d box;
  for (const Tree::Corners& t : triangles) {
    for (const Eigen::Vector3d& corner : t) box.extend(corner);
  }
  Ball best{box.center(), std::numeric_limits<double>::infinity()};
  Eigen::Vector3d center = best.center;
  for (int step = 0; step <= (triangles.size() > k_large ? 0 : k_steps); ++step) {
    double squared = -1.0;
    Eigen::Vector3d farthest = center;
    for (const Tree::Corners& t : triangles) {
      for (const Eigen::Vector3d& corner : t) {
        const double d = (corner - center).squaredNorm();
        if (d > squared) {
          squared = d;
          farthest = corner;
        }
      }
    }
    if (std::sqrt(squared) < best.radius) best = {center, std::sqrt(squared)};
    center += (farthest - center) / (step + 3.0);
  }
  return best;
}

/// In lanes without a child, arrays repeat the first.
template <class... Array>
void repeat_first(std::size_t count, Array&... array) {
  (std::fill(array + count, array + k_width, array[0]), ...);
}

/// One coordinate of a matrix times the vector of a lane.
template <std::size_t lanes>
float row_times(const float (&row)[3], const float (&x)[3][lanes], std::size_t lane) {
  return row[0] * x[0][lane] + row[1] * x[1][lane] + row[2] * x[2][lane];
}

float box_size(const CastVolume& v) { return v.half[0] * v.half[0] + v.half[1] * v.half[1] + v.half[2] * v.half[2]; }

CastVolume volume_of(const CastNode& node, std::size_t lane) {
  CastVolume v;
  for (std::size_t k = 0; k < 3; ++k) {
    v.center[k] = node.center[k][lane];
    v.half[k] = node.half[k][lane];
    v.normal[k] = node.normal[k][lane];
    v.ball_center[k] = node.ball_center[k][lane];
  }
  v.ball_radius = node.ball_radius[lane];
  v.slab_offset = node.slab_offset[lane];
  v.slab_half = node.slab_half[lane];
  v.size = box_size(v);
  return v;
}

}  // namespace

CastMesh::CastMesh(std::shared_ptr<const Tree> tree) : tree_(std::move(tree)) {
  nodes_.resize(tree_->nodes().size());
  precise_volumes_.resize(nodes_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const Tree::Node& from = tree_->nodes()[n];
    CastNode& to = nodes_[n];
    to = {};
    to.child_count = from.child_count;
    for (std::size_t lane = 0; lane < from.child_count; ++lane) {
      const Tree::Child child = from.child[lane];
      to.child[lane] = child.is_leaf() ? CastChild::leaf(from.leaf[lane]) : CastChild::node(child.node());
      const Triangles triangles = triangles_of(*tree_, child);
      fit_precise_volume(triangles, tree_->center(), precise_volumes_[n], lane);
      const Ball ball = fit_ball(triangles);
      const Eigen::Vector3d ball_center = ball.center - tree_->center();
      to.ball_radius[lane] = static_cast<float>(ball.radius);
      to.slab_offset[lane] = 0.5f * (from.slab_lower[lane] + from.slab_upper[lane]);
      to.slab_half[lane] = 0.5f * (from.slab_upper[lane] - from.slab_lower[lane]);
      for (std::size_t k = 0; k < 3; ++k) {
        to.normal[k][lane] = from.normal[k][lane];
        to.ball_center[k][lane] = static_cast<float>(ball_center[static_cast<Eigen::Index>(k)]);
        to.slab_offset[lane] -= to.normal[k][lane] * to.ball_center[k][lane];
      }
    }
    repeat_first(to.child_count, to.child, to.ball_radius, to.slab_offset, to.slab_half);
    for (std::size_t k = 0; k < 3; ++k) repeat_first(to.child_count, to.normal[k], to.ball_center[k]);
  }
}

CastTree::CastTree(std::shared_ptr<const CastMesh> mesh)
    : mesh_(std::move(mesh)),
      nodes_(mesh_->nodes().begin(), mesh_->nodes().end()),
      volumes_(k_width * nodes_.size()),
      leaves_(mesh_->tree().leaves().size()),
      bounds_(nodes_.size()) {
  for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) leaves_[leaf].child = mesh_->tree().leaves()[leaf].child;
}

CastTree::Bounds CastTree::transform_leaf(std::uint32_t leaf, const float (&m)[3][3]) {
  const Tree::Leaf& from = mesh_->tree().leaves()[leaf];
  CastLeaf& to = leaves_[leaf];
  Bounds box;
  for (std::size_t i = 0; i < 3; ++i) {
    float low[k_leaf_triangles];
    float high[k_leaf_triangles];
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (std::size_t t = 0; t < k_leaf_triangles; ++t) {
        const float x = row_times(m[i], from.corner[corner], t);
        to.corner[corner][i][t] = x;
        low[t] = corner == 0 ? x : std::min(low[t], x);
        high[t] = corner == 0 ? x : std::max(high[t], x);
      }
    }
    box.lower[i] = std::min(std::min(low[0], low[1]), std::min(low[2], low[3]));
    box.upper[i] = std::max(std::max(high[0], high[1]), std::max(high[2], high[3]));
  }
  return box;
}

void CastTree::transform(const Eigen::Matrix3d& M) {
  matrix_ = M;
  float m[3][3];
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      m[i][k] = static_cast<float>(M(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)));
    }
  }
  for (std::size_t n = nodes_.size(); n-- > 0;) {  // children before parents
    const CastNode& from = mesh_->nodes()[n];
    CastNode& to = nodes_[n];
    Bounds all{};
    for (std::size_t lane = 0; lane < from.child_count; ++lane) {
      const CastChild child = from.child[lane];
      const Bounds box = child.is_leaf() ? transform_leaf(child.index(), m) : bounds_[child.index()];
      for (std::size_t k = 0; k < 3; ++k) {
        to.center[k][lane] = 0.5f * (box.lower[k] + box.upper[k]);
        to.half[k][lane] = 0.5f * (box.upper[k] - box.lower[k]);
        all.lower[k] = lane == 0 ? box.lower[k] : std::min(all.lower[k], box.lower[k]);
        all.upper[k] = lane == 0 ? box.upper[k] : std::max(all.upper[k], box.upper[k]);
      }
    }
    for (std::size_t k = 0; k < 3; ++k) repeat_first(from.child_count, to.center[k], to.half[k]);
    bounds_[n] = all;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t lane = 0; lane < k_width; ++lane) {
        to.normal[i][lane] = row_times(m[i], from.normal, lane);
        to.ball_center[i][lane] = row_times(m[i], from.ball_center, lane);
      }
    }
    for (std::size_t lane = 0; lane < from.child_count; ++lane) volumes_[k_width * n + lane] = volume_of(to, lane);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    root_volume_.center[k] = 0.5f * (bounds_[0].lower[k] + bounds_[0].upper[k]);
    root_volume_.half[k] = 0.5f * (bounds_[0].upper[k] - bounds_[0].lower[k]);
  }
  root_volume_.ball_radius = static_cast<float>(radius());
  root_volume_.size = box_size(root_volume_);
}

TriangleCorners CastTree::triangle(std::uint32_t t) const {
  const Tree& tree = mesh_->tree();
  const Tree::Corners& corners = tree.corners()[t];
  return {matrix_ * (corners[0] - tree.center()), matrix_ * (corners[1] - tree.center()),
          matrix_ * (corners[2] - tree.center())};
}

}  // namespace sixdof::ray_cast
