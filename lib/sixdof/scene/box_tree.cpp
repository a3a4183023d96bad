#include <sixdof/scene/box_tree.h>

#include <cmath>
#include <limits>

#include <sixdof/base/parallel.h>

namespace sixdof::scene::detail {
namespace {

/// Below as many bodies one thread is faster.
constexpr std::size_t k_parallel = 4096;

float rounded_down(double x) { return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity()); }
float rounded_up(double x) { return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity()); }

}  // namespace

BoxTree::Node::Node(const Box& box) {
  for (int k = 0; k < 3; ++k) {
    lower[k] = rounded_down(box.lower[k]);
    upper[k] = rounded_up(box.upper[k]);
  }
}

void BoxTree::join_children(Node& node) {
  const Node& l = nodes_[left_of(node)];
  const Node& r = nodes_[node.right];
  for (int k = 0; k < 3; ++k) {
    node.lower[k] = std::min(l.lower[k], r.lower[k]);
    node.upper[k] = std::max(l.upper[k], r.upper[k]);
  }
}

void BoxTree::build(std::span<const Box> boxes) {
  nodes_.resize(boxes.empty() ? 0 : 2 * boxes.size() - 1);
  leaf_of_.resize(boxes.size());
  std::vector<Item> items(boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    for (int k = 0; k < 3; ++k) items[i].center[k] = static_cast<float>(boxes[i].lower[k] + boxes[i].upper[k]);
    items[i].body = i;
  }
  if (!items.empty()) build_range(items, 0, 0, boxes);
}

void BoxTree::build_range(std::span<Item> items, std::uint32_t at, std::uint32_t parent, std::span<const Box> boxes) {
  Node& node = nodes_[at];
  if (items.size() == 1) {
    node = Node(boxes[items[0].body]);
    node.parent = parent;
    node.right = k_leaf | items[0].body;
    leaf_of_[items[0].body] = at;
    return;
  }
  float low[3], high[3];
  for (int k = 0; k < 3; ++k) low[k] = high[k] = items[0].center[k];
  for (const Item& item : items) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], item.center[k]);
      high[k] = std::max(high[k], item.center[k]);
    }
  }
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
  }
  const std::size_t middle = items.size() / 2;
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(middle), items.end(),
                   [axis](const Item& x, const Item& y) {
                     return x.center[axis] < y.center[axis] || (x.center[axis] == y.center[axis] && x.body < y.body);
                   });
  node.parent = parent;
  node.right = at + static_cast<std::uint32_t>(2 * middle);
  const auto left = [&] { build_range(items.first(middle), at + 1, at, boxes); };
  const auto right = [&] { build_range(items.subspan(middle), node.right, at, boxes); };
  if (items.size() > k_parallel) {
    parallel::invoke(left, right);
  } else {
    left();
    right();
  }
  join_children(node);
}

void BoxTree::set(std::uint32_t body, const Box& box) {
  std::uint32_t at = leaf_of_[body];
  const std::uint32_t right = nodes_[at].right, parent = nodes_[at].parent;
  nodes_[at] = Node(box);
  nodes_[at].right = right;
  nodes_[at].parent = parent;
  while (at != 0) {
    at = nodes_[at].parent;
    const Node before = nodes_[at];
    join_children(nodes_[at]);
    if (std::equal(before.lower, before.lower + 3, nodes_[at].lower) &&
        std::equal(before.upper, before.upper + 3, nodes_[at].upper)) {
      return;
    }
  }
}

void BoxTree::split(const NodePair& pair, std::vector<NodePair>& stack) const {
  const Node& a = nodes_[pair.a];
  const auto push = [&](std::uint32_t i, std::uint32_t j) {
    if (nodes_[i].meets(nodes_[j])) stack.push_back({i, j});
  };
  if (pair.a == pair.b) {
    if (a.is_leaf()) return;
    const std::uint32_t left = pair.a + 1;
    push(left, a.right);
    if (!nodes_[left].is_leaf()) stack.push_back({left, left});
    if (!nodes_[a.right].is_leaf()) stack.push_back({a.right, a.right});
    return;
  }
  const Node& b = nodes_[pair.b];
  if (b.is_leaf() || (!a.is_leaf() && a.extent() >= b.extent())) {
    push(pair.a + 1, pair.b);
    push(a.right, pair.b);
  } else {
    push(pair.a, pair.b + 1);
    push(pair.a, b.right);
  }
}

std::vector<BoxTree::NodePair> BoxTree::parts() const {
  std::vector<NodePair> pairs;
  if (nodes_.empty()) return pairs;
  pairs.push_back({0, 0});
  constexpr std::size_t k_parts = 256;
  if (size() <= k_parallel) return pairs;
  std::vector<NodePair> next;
  for (int round = 0; round < 16 && pairs.size() < k_parts; ++round) {
    next.clear();
    for (const NodePair& pair : pairs) {
      if (is_pair_of_leaves(pair)) {
        next.push_back(pair);
      } else {
        split(pair, next);
      }
    }
    pairs.swap(next);
  }
  return pairs;
}

std::vector<std::uint64_t> BoxTree::collect(std::size_t count,
                                            const std::function<void(std::size_t, std::vector<std::uint64_t>&)>& part) {
  std::vector<std::vector<std::uint64_t>> found(count);
  if (count == 1) {
    part(0, found[0]);
  } else {
    parallel::for_each(count, [&](std::size_t k) { part(k, found[k]); });
  }
  std::vector<std::uint64_t> all;
  for (const auto& each : found) all.insert(all.end(), each.begin(), each.end());
  parallel::sort(all);
  return all;
}

std::size_t BoxTree::bytes() const {
  return nodes_.capacity() * sizeof(Node) + leaf_of_.capacity() * sizeof(std::uint32_t);
}

}  // namespace sixdof::scene::detail
