#include <algorithm>
#include <utility>

#include <sixdof/base/parallel.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/geometry/tree_builder.h>

namespace sixdof {
namespace {

using Eigen::Vector3d;

/// The box of a leaf's triangles, relative to the centre, as the builder has it.
tree_builder::Box box_of(std::span<const Tree::Corners> triangles, const Vector3d& center) {
  Eigen::AlignedBox3d box;
  for (const Tree::Corners& corners : triangles) {
    for (const Vector3d& corner : corners) box.extend(corner);
  }
  tree_builder::Box rounded;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    rounded.lower[k] = tree_builder::round_down(box.min()[axis] - center[axis]);
    rounded.upper[k] = tree_builder::round_up(box.max()[axis] - center[axis]);
  }
  return rounded;
}

void set_box(Tree::Node& node, std::size_t child, const tree_builder::Box& box) {
  for (std::size_t k = 0; k < 3; ++k) {
    node.lower[k][child] = box.lower[k];
    node.upper[k][child] = box.upper[k];
  }
}

tree_builder::Box box_of_children(const Tree::Node& node) {
  tree_builder::Box box;
  for (std::size_t i = 0; i < node.child_count; ++i) {
    box.add({{node.lower[0][i], node.lower[1][i], node.lower[2][i]},
             {node.upper[0][i], node.upper[1][i], node.upper[2][i]}});
  }
  return box;
}

Vector3d area_of(std::span<const Tree::Corners> triangles) {
  Vector3d sum = Vector3d::Zero();
  for (const Tree::Corners& c : triangles) sum += (c[1] - c[0]).cross(c[2] - c[0]);
  return sum;
}

}  // namespace

void Tree::refit(const tree_builder::Surface& surface) {
  place(surface);
  place_corners(surface);
  const std::span<const Corners> corners = corners_;
  std::vector<Vector3d> sums(nodes_.size(), Vector3d::Zero());  // area vectors, twice, of a node's triangles
  parallel::for_each(nodes_.size(), [&](std::size_t index) {
    Node& node = nodes_[index];
    for (std::size_t i = 0; i < node.child_count; ++i) {
      const Child child = node.child[i];
      if (!child.is_leaf()) continue;
      const auto triangles = corners.subspan(child.first(), child.count());
      const Vector3d sum = area_of(triangles);
      set_box(node, i, box_of(triangles, center_));
      fit_slab(node, i, sum, child.first(), child.first() + child.count());
      sums[index] += sum;
    }
  });
  for (std::size_t index = nodes_.size(); index-- > 0;) {  // children before parents
    Node& node = nodes_[index];
    for (std::size_t i = 0; i < node.child_count; ++i) {
      if (node.child[i].is_leaf()) continue;
      set_box(node, i, box_of_children(nodes_[node.child[i].node()]));
      sums[index] += sums[node.child[i].node()];
    }
  }
  parallel::for_each(nodes_.size(), [&](std::size_t index) {
    Node& node = nodes_[index];
    for (std::size_t i = 0; i < node.child_count; ++i) {
      if (node.child[i].is_leaf()) continue;
      const Node& child = nodes_[node.child[i].node()];
      if (child.triangle_count > k_exact_slab) {
        bound_slab(node, i, sums[node.child[i].node()]);
      } else {
        fit_slab(node, i, sums[node.child[i].node()], child.first_triangle,
                 child.first_triangle + child.triangle_count);
      }
    }
  });
  store_volumes();
}

/// Puts a tree together of subtrees that were built anew and of the nodes above and beside them.
class Tree::Assembly {
 public:
  using Subtrees = std::vector<std::unique_ptr<tree_builder::Subtree>>;
  Assembly(Tree& tree, std::span<const std::uint32_t> parts, const Subtrees& subtrees)
      : tree_(tree), parts_(parts), subtrees_(subtrees), old_(std::move(tree.nodes_)) {
    tree_.nodes_.clear();
    tree_.leaves_.clear();
    copy(0);
  }

  std::vector<std::uint32_t> origin;  ///< Of each node the one of before, or k_new.

 private:
  /// @return the new index of a node, all of whose subtree is stored
  std::uint32_t copy(std::uint32_t from) {
    const auto part = std::ranges::lower_bound(parts_, from);
    if (part != parts_.end() && *part == from) {
      const std::uint32_t root = tree_.store_nodes(*subtrees_[static_cast<std::size_t>(part - parts_.begin())]);
      origin.resize(tree_.nodes_.size(), k_new);
      return root;
    }
    const auto index = static_cast<std::uint32_t>(tree_.nodes_.size());
    tree_.nodes_.push_back(old_[from]);
    origin.push_back(from);
    for (std::size_t i = 0; i < old_[from].child_count; ++i) {
      if (!old_[from].child[i].is_leaf()) continue;
      tree_.nodes_[index].number[i] = k_leaf_number + static_cast<std::uint32_t>(tree_.leaves_.size());
      tree_.leaves_.emplace_back();
    }
    for (std::size_t i = 0; i < old_[from].child_count; ++i) {
      if (old_[from].child[i].is_leaf()) continue;
      const std::uint32_t child = copy(old_[from].child[i].node());
      tree_.nodes_[index].child[i] = Child::node(child);
      tree_.nodes_[index].number[i] = child;
    }
    return index;
  }

  Tree& tree_;
  const std::span<const std::uint32_t> parts_;
  const Subtrees& subtrees_;
  const std::vector<Node> old_;
};

std::vector<std::uint32_t> Tree::rebuild(const tree_builder::Surface& surface, std::span<const std::uint32_t> parts) {
  Assembly::Subtrees subtrees(parts.size());
  parallel::for_each(parts.size(), [&](std::size_t k) {
    const Node& node = nodes_[parts[k]];
    const std::span<std::uint32_t> triangles =
        std::span(mesh_triangle_).subspan(node.first_triangle, node.triangle_count);
    std::ranges::sort(triangles);
    subtrees[k] = tree_builder::build(surface, center_, triangles, node.first_triangle);
  });
  place_corners(surface);
  std::vector<std::uint32_t> origin = std::move(Assembly(*this, parts, subtrees).origin);
  parallel::for_each(nodes_.size(), [&](std::size_t i) {
    if (origin[i] == k_new) fit_slabs(nodes_[i]);
  });
  store_volumes();
  return origin;
}

}  // namespace sixdof
