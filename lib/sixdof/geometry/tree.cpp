#include <sixdof/geometry/tree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>
#include <sixdof/geometry/tree_builder.h>

namespace sixdof {

Tree::Tree(const Mesh& mesh) : Tree(tree_builder::Surface{mesh.vertices(), mesh.triangles()}) {}

Tree::Tree(const tree_builder::Surface& surface) {
  const std::size_t n = surface.triangles.size();
  if (n >= std::size_t{1} << 29) throw BadMesh(fmt::format("{} triangles: a tree holds less than 2^29", n));
  place(surface);
  mesh_triangle_.resize(n);
  std::iota(mesh_triangle_.begin(), mesh_triangle_.end(), 0u);
  const std::unique_ptr<tree_builder::Subtree> root = tree_builder::build(surface, center_, mesh_triangle_);
  place_corners(surface);

  nodes_.reserve(root->total);
  store_nodes(*root);
  leaves_.shrink_to_fit();
  parallel::for_each(nodes_.size(), [this](std::size_t i) { fit_slabs(nodes_[i]); });
  store_volumes();
}

void Tree::place(const tree_builder::Surface& surface) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : surface.vertices) box.extend(v);
  const double diagonal = box.diagonal().norm();
  if (!(diagonal >= k_smallest_diagonal && diagonal <= k_largest_diagonal)) {
    throw BadMesh(fmt::format("box diagonal {}: outside {} .. {}, where single-precision bounds have room", diagonal,
                              k_smallest_diagonal, k_largest_diagonal));
  }
  center_ = box.center();
  // Squares of lengths up to k_largest_diagonal are far from overflow.
  radius_ = 0.0;
  for (const Eigen::Vector3d& v : surface.vertices) radius_ = std::max(radius_, (v - center_).squaredNorm());
  radius_ = std::sqrt(radius_) * (1.0 + 1e-15);
}

void Tree::place_corners(const tree_builder::Surface& surface) {
  corners_.resize(mesh_triangle_.size());
  parallel::for_each(corners_.size(), [&](std::size_t i) {
    const Triangle& triangle = surface.triangles[mesh_triangle_[i]];
    for (std::size_t k = 0; k < 3; ++k) corners_[i][k] = surface.vertices[triangle[k]];
  });
}

std::uint32_t Tree::store_nodes(const tree_builder::Subtree& subtree) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  Node& node = nodes_.emplace_back();
  const std::vector<tree_builder::Range>& children = subtree.children;
  node.child_count = static_cast<std::uint32_t>(children.size());
  node.first_triangle = static_cast<std::uint32_t>(children.front().first);
  node.triangle_count = static_cast<std::uint32_t>(children.back().last - children.front().first);
  for (std::size_t i = 0; i < k_width; ++i) {
    const tree_builder::Box box = i < children.size() ? children[i].box : tree_builder::Box{};
    for (std::size_t k = 0; k < 3; ++k) {
      node.lower[k][i] = box.lower[k];
      node.upper[k][i] = box.upper[k];
    }
    if (i < children.size() && !subtree.nodes[i]) {
      node.number[i] = k_leaf_number + static_cast<std::uint32_t>(leaves_.size());
      node.child[i] =
          Child::leaf(static_cast<std::uint32_t>(children[i].first), static_cast<std::uint32_t>(children[i].count()));
      leaves_.emplace_back();
    }
  }
  for (std::size_t i = 0; i < children.size(); ++i) {
    if (!subtree.nodes[i]) continue;
    const std::uint32_t child = store_nodes(*subtree.nodes[i]);
    nodes_[index].child[i] = Child::node(child);
    nodes_[index].number[i] = child;
  }
  return index;
}

namespace {

// Less than 1 by more than the rounding to floats, so that a gap along the normal is at most the distance.
constexpr double k_length = 1.0 - 4e-7;

/// Along a sum of area vectors; along x if that is zero.
std::array<float, 3> normal_along(const Eigen::Vector3d& sum) {
  const double scale = sum.cwiseAbs().maxCoeff();
  const Eigen::Vector3d unit =
      scale > 0.0 ? Eigen::Vector3d((sum / scale).normalized() * k_length) : Eigen::Vector3d(k_length, 0.0, 0.0);
  return {static_cast<float>(unit[0]), static_cast<float>(unit[1]), static_cast<float>(unit[2])};
}

/// Sets a slab, its interval rounded outwards.
/// @param radius of the tree: a dot product rounds relative to its largest term, not to its value
void set_slab(Tree::Node& node, std::size_t child, const std::array<float, 3>& normal, double low, double high,
              double radius) {
  const double slack = 1e-15 * radius;
  for (std::size_t k = 0; k < 3; ++k) node.normal[k][child] = normal[k];
  node.slab_lower[child] = tree_builder::round_down(low - slack);
  node.slab_upper[child] = tree_builder::round_up(high + slack);
}

}  // namespace

void Tree::fit_slabs(Node& node) const {
  std::uint32_t first = node.first_triangle;
  for (std::size_t i = 0; i < k_width; ++i) {
    if (i >= node.child_count) {
      for (std::size_t k = 0; k < 3; ++k) node.normal[k][i] = k == 0 ? static_cast<float>(k_length) : 0.0f;
      node.slab_lower[i] = k_empty;
      node.slab_upper[i] = -k_empty;
      continue;
    }
    const Child child = node.child[i];
    const std::uint32_t end = first + (child.is_leaf() ? child.count() : nodes_[child.node()].triangle_count);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::uint32_t t = first; t < end; ++t) {
      sum += (corners_[t][1] - corners_[t][0]).cross(corners_[t][2] - corners_[t][0]);
    }
    fit_slab(node, i, sum, first, end);
    first = end;
  }
}

void Tree::fit_slab(Node& node, std::size_t child, const Eigen::Vector3d& sum, std::uint32_t first,
                    std::uint32_t end) const {
  const std::array<float, 3> normal = normal_along(sum);
  const Eigen::Vector3d n(normal[0], normal[1], normal[2]);
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (std::uint32_t t = first; t < end; ++t) {
    for (const Eigen::Vector3d& corner : corners_[t]) {
      const double offset = n.dot(corner - center_);
      low = std::min(low, offset);
      high = std::max(high, offset);
    }
  }
  set_slab(node, child, normal, low, high, radius_);
}

void Tree::bound_slab(Node& node, std::size_t child, const Eigen::Vector3d& sum) const {
  const std::array<float, 3> normal = normal_along(sum);
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  const auto add_boxes = [&](const Node& of) {
    for (std::size_t i = 0; i < of.child_count; ++i) {
      double least = 0.0, most = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double n = normal[k], x = n * of.lower[k][i], y = n * of.upper[k][i];
        least += std::min(x, y);
        most += std::max(x, y);
      }
      low = std::min(low, least);
      high = std::max(high, most);
    }
  };
  const Node& below = nodes_[node.child[child].node()];
  bool has_leaf = false;
  for (std::size_t i = 0; i < below.child_count; ++i) has_leaf = has_leaf || below.child[i].is_leaf();
  if (has_leaf) {
    add_boxes(below);
  } else {
    for (std::size_t i = 0; i < below.child_count; ++i) add_boxes(nodes_[below.child[i].node()]);
  }
  set_slab(node, child, normal, low, high, radius_);
}

void Tree::store_volumes() {
  static_assert(sizeof(Node) == 512 && sizeof(Leaf) == 192);
  Node& root = nodes_[0];
  for (std::size_t k = 0; k < 3; ++k) {
    root.volume.lower[k] = *std::min_element(root.lower[k], root.lower[k] + root.child_count);
    root.volume.upper[k] = *std::max_element(root.upper[k], root.upper[k] + root.child_count);
  }
  parallel::for_each(nodes_.size(), [this](std::size_t index) {
    const Node& node = nodes_[index];
    for (std::size_t i = 0; i < node.child_count; ++i) {
      Volume volume{};
      for (std::size_t k = 0; k < 3; ++k) {
        volume.lower[k] = node.lower[k][i];
        volume.upper[k] = node.upper[k][i];
        volume.normal[k] = node.normal[k][i];
      }
      volume.slab_lower = node.slab_lower[i];
      volume.slab_upper = node.slab_upper[i];
      const Child child = node.child[i];
      if (!child.is_leaf()) {
        nodes_[child.node()].volume = volume;
        continue;
      }
      Leaf& leaf = leaves_[node.leaf(i)];
      leaf.volume = volume;
      leaf.child = child;
      for (std::uint32_t t = 0; t < k_leaf_triangles; ++t) {
        const Corners& corners = corners_[child.first() + std::min(t, child.count() - 1)];
        for (std::size_t corner = 0; corner < 3; ++corner) {
          for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<Eigen::Index>(k);
            leaf.corner[corner][k][t] = static_cast<float>(corners[corner][axis] - center_[axis]);
          }
        }
      }
    }
  });
}

std::size_t Tree::bytes() const {
  return leaves_.capacity() * sizeof(Leaf) + nodes_.capacity() * sizeof(Node) +
         mesh_triangle_.capacity() * sizeof(std::uint32_t) + corners_.capacity() * sizeof(Corners);
}

std::vector<Eigen::Vector3d> area_vectors(const Tree& tree) {
  std::vector<Eigen::Vector3d> areas;
  areas.reserve(tree.corners().size());
  for (const Tree::Corners& c : tree.corners()) areas.push_back(0.5 * (c[1] - c[0]).cross(c[2] - c[0]));
  return areas;
}

}  // namespace sixdof
