#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <sixdof/scene/bodies.h>

namespace sixdof::scene::detail {

/// A binary tree over one box per body. Its shape is made once from all boxes, by halving along the longest side; then
/// single boxes may change, and the boxes above them with them. Stored boxes are floats, rounded outwards.
class BoxTree {
 public:
  /// Makes the tree anew.
  void build(std::span<const Box> boxes);

  /// Changes one box. Slow queries follow if many boxes have moved far since build().
  void set(std::uint32_t body, const Box& box);

  std::size_t size() const { return leaf_of_.size(); }
  std::size_t bytes() const;

  /// Calls found(j) for every body whose box meets the given one, in no particular order.
  template <class Found>
  void for_each_meeting(const Box& box, const Found& found) const {
    if (nodes_.empty()) return;
    const Node target(box);
    std::uint32_t stack[k_depth];
    std::size_t top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const Node& node = nodes_[stack[--top]];
      if (!node.meets(target)) continue;
      if (node.is_leaf()) {
        found(node.body());
        continue;
      }
      stack[top++] = node.right;
      stack[top++] = left_of(node);
    }
  }

  /// All pairs of bodies whose boxes meet and for which keep(i, j), i < j, is true, as i << 32 | j, sorted.
  template <class Keep>
  std::vector<std::uint64_t> meeting_pairs(const Keep& keep) const;

 private:
  static constexpr std::size_t k_depth = 128;  ///< Of a stack: the tree halves, so it is no deeper than 40.
  static constexpr std::uint32_t k_leaf = 1u << 31;

  struct Node {
    float lower[3] = {};
    std::uint32_t right = 0;  ///< Index of the right child, the left one follows the node; k_leaf + body for a leaf.
    float upper[3] = {};
    std::uint32_t parent = 0;

    Node() = default;
    explicit Node(const Box& box);
    bool is_leaf() const { return (right & k_leaf) != 0; }
    std::uint32_t body() const { return right & ~k_leaf; }
    bool meets(const Node& o) const {
      return (lower[0] <= o.upper[0]) & (lower[1] <= o.upper[1]) & (lower[2] <= o.upper[2]) & (upper[0] >= o.lower[0]) &
             (upper[1] >= o.lower[1]) & (upper[2] >= o.lower[2]);
    }
    /// Length of the box's edges together.
    float extent() const { return (upper[0] - lower[0]) + (upper[1] - lower[1]) + (upper[2] - lower[2]); }
  };

  struct NodePair {
    std::uint32_t a, b;  ///< The same for the pairs within a node.
  };

  struct Item {
    float center[3];
    std::uint32_t body;
  };

  std::uint32_t left_of(const Node& node) const { return static_cast<std::uint32_t>(&node - nodes_.data()) + 1; }
  void build_range(std::span<Item> items, std::uint32_t at, std::uint32_t parent, std::span<const Box> boxes);
  void join_children(Node& node);
  /// Pushes the pairs that a pair of nodes consists of.
  void split(const NodePair& pair, std::vector<NodePair>& stack) const;
  bool is_pair_of_leaves(const NodePair& pair) const {
    return pair.a != pair.b && nodes_[pair.a].is_leaf() && nodes_[pair.b].is_leaf();
  }
  /// Parts of the work of meeting_pairs(), as many as there are for some threads.
  std::vector<NodePair> parts() const;
  static std::vector<std::uint64_t> collect(std::size_t count,
                                            const std::function<void(std::size_t, std::vector<std::uint64_t>&)>& part);

  std::vector<Node> nodes_;  // depth first
  std::vector<std::uint32_t> leaf_of_;
};

template <class Keep>
std::vector<std::uint64_t> BoxTree::meeting_pairs(const Keep& keep) const {
  const std::vector<NodePair> all = parts();
  return collect(all.size(), [&](std::size_t k, std::vector<std::uint64_t>& found) {
    std::vector<NodePair> stack{all[k]};
    while (!stack.empty()) {
      const NodePair top = stack.back();
      stack.pop_back();
      if (is_pair_of_leaves(top)) {
        const std::uint32_t i = nodes_[top.a].body(), j = nodes_[top.b].body();
        const std::uint32_t low = std::min(i, j), high = std::max(i, j);
        if (keep(low, high)) found.push_back(std::uint64_t{low} << 32 | high);
        continue;
      }
      split(top, stack);
    }
  });
}

}  // namespace sixdof::scene::detail
