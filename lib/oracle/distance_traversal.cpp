#include <sixdof/oracle/distance_traversal.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <Eigen/Geometry>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/distance_traversal.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: these are compiled once per instruction set, too.
#include <sixdof/oracle/distance_bounds-inl.h>
#include <sixdof/oracle/distance_leaf-inl.h>
#include <sixdof/oracle/distance_seed-inl.h>

// Depth-first branch and bound over pairs of volumes, the closest pair first. Of two volumes the larger is opened: its
// eight children are bounded against the other volume ("the fixed one") at once, one child per SIMD lane.

HWY_BEFORE_NAMESPACE();
namespace sixdof::detail {
namespace HWY_NAMESPACE {

/// Square of a box's diagonal.
float size_of(const Tree::Volume& v) {
  const float x = v.upper[0] - v.lower[0];
  const float y = v.upper[1] - v.lower[1];
  const float z = v.upper[2] - v.lower[2];
  return x * x + y * y + z * z;
}

constexpr std::size_t k_cache_line = 64;  // bytes

struct Descent {
  Traversal& traversal;
  const Tree& tree_a;
  const Tree& tree_b;
  const bool only_intersection;
  Frames frames;
  float best;  // cut-off, rounded up

  Descent(Traversal& t, bool intersection)
      : traversal(t), tree_a(*t.a), tree_b(*t.b), only_intersection(intersection), frames(tree_a, tree_b, t.X_AB) {
    if (traversal.direction.squaredNorm() == 0.0) traversal.direction = frames.shift;
    frames.look_along(traversal.direction);
    set_best();
  }

  void set_best() {
    best = only_intersection ? 0.0f
                             : std::nextafter(static_cast<float>(std::min(traversal.best, 1e30)),
                                              std::numeric_limits<float>::infinity());
  }

  /// Exact test of two triangles. Returns true if the search is over.
  bool measure(TrianglePair pair) {
    const Tree::Corners& a = tree_a.corners()[pair.a];
    const Tree::Corners& fixed = tree_b.corners()[pair.b];
    const TriangleCorners b{traversal.X_AB * fixed[0], traversal.X_AB * fixed[1], traversal.X_AB * fixed[2]};
    ++traversal.counts.triangles;
    if (only_intersection) {
      if (!triangles_intersect(a, b)) return false;
      traversal.found = true;
      traversal.pair = pair;
      return true;
    }
    if (offer_pair(traversal, pair, a, b)) {
      if (traversal.best == 0.0) return true;
      traversal.direction = traversal.closest.on_b - traversal.closest.on_a;
      frames.look_along(traversal.direction);
      set_best();
    }
    return false;
  }

  /// Pairs of triangles of two leaves. Returns true if the search is over.
  bool measure(const Tree::Leaf& leaf_a, const Tree::Leaf& leaf_b) {
    ++traversal.counts.leaf_pairs;
    LeafPair pairs;
    if (!bound_toward(leaf_a, leaf_b, frames.open_a, frames.slack, best, pairs.bounds)) return false;
    lay_out(leaf_a, leaf_b, frames.open_a, pairs);
    bound_triangles(pairs, frames.slack.far, best);
    // Pairs that certainly improve on the best, or that may intersect, are measured now, the most promising first. The
    // others wait: most of them will have become irrelevant.
    for (;;) {
      std::uint32_t next = LeafPair::k_pairs;
      for (std::uint32_t i = 0; i < leaf_a.child.count(); ++i) {
        for (std::uint32_t j = 0; j < leaf_b.child.count(); ++j) {
          const std::uint32_t lane = k_leaf * i + j;
          if (pairs.bounds[lane] > best || (pairs.bounds[lane] > 0.0f && pairs.reached[lane] >= best)) continue;
          if (next == LeafPair::k_pairs || pairs.reached[lane] < pairs.reached[next]) next = lane;
        }
      }
      if (next == LeafPair::k_pairs) break;
      pairs.bounds[next] = Tree::k_empty;
      if (measure({leaf_a.child.first() + next / k_leaf, leaf_b.child.first() + next % k_leaf})) return true;
    }
    for (std::uint32_t i = 0; i < leaf_a.child.count(); ++i) {
      for (std::uint32_t j = 0; j < leaf_b.child.count(); ++j) {
        const float bound = pairs.bounds[k_leaf * i + j];
        if (bound > best) continue;
        traversal.deferred.push_back({{leaf_a.child.first() + i, leaf_b.child.first() + j}, bound});
      }
    }
    return false;
  }

  void run() {
    traversal.deferred.clear();
    if (descend()) return;
    std::vector<DeferredPair>& rest = traversal.deferred;
    std::erase_if(rest, [this](const DeferredPair& x) { return x.lower > best; });
    std::sort(rest.begin(), rest.end(), [](const DeferredPair& x, const DeferredPair& y) { return x.lower < y.lower; });
    for (const DeferredPair& x : rest) {
      if (x.lower > best || measure(x.pair)) return;
    }
  }

  /// Asks for what the next steps will read: large trees are not in the caches, and a step is short against a miss.
  static HWY_INLINE void prefetch(const Tree& tree, const Tree::Node& node, std::size_t i) {
    const bool leaf = node.child[i].is_leaf();
    const char* at = leaf ? reinterpret_cast<const char*>(&tree.leaves()[node.leaf[i]])
                          : reinterpret_cast<const char*>(&tree.nodes()[node.child[i].node()]);
    const std::size_t bytes = leaf ? sizeof(Tree::Leaf) : sizeof(Tree::Node);
    for (std::size_t byte = 0; byte < bytes; byte += k_cache_line) hwy::Prefetch(at + byte);
  }

  /// Returns true if the search is over.
  bool descend() {
    std::vector<OpenPair>& open = traversal.open;
    open.clear();
    open.push_back({0, 0, -Tree::k_empty});
    while (!open.empty()) {
      const OpenPair top = open.back();
      open.pop_back();
      if (top.lower > best) continue;
      const bool leaf_a = (top.a & OpenPair::k_leaf) != 0;
      const bool leaf_b = (top.b & OpenPair::k_leaf) != 0;
      if (leaf_a && leaf_b) {
        if (measure(tree_a.leaves()[top.a - OpenPair::k_leaf], tree_b.leaves()[top.b - OpenPair::k_leaf])) return true;
        continue;
      }
      const Tree::Volume& volume_a =
          leaf_a ? tree_a.leaves()[top.a - OpenPair::k_leaf].volume : tree_a.nodes()[top.a].volume;
      const Tree::Volume& volume_b =
          leaf_b ? tree_b.leaves()[top.b - OpenPair::k_leaf].volume : tree_b.nodes()[top.b].volume;
      const bool opens_a = leaf_b || (!leaf_a && size_of(volume_a) >= size_of(volume_b));
      const Tree::Node& node = opens_a ? tree_a.nodes()[top.a] : tree_b.nodes()[top.b];
      const Frame& frame = opens_a ? frames.open_a : frames.open_b;
      HWY_ALIGN float bounds[k_width];
      ++traversal.counts.nodes;
      unsigned kept =
          bound_children(node, Fixed(opens_a ? volume_b : volume_a, frame), frame, frames.slack, best, bounds);

      const std::size_t first = open.size();
      for (; kept != 0; kept &= kept - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(kept));
        OpenPair next{top.a, top.b, bounds[i]};
        (opens_a ? next.a : next.b) = node.child[i].is_leaf() ? OpenPair::k_leaf + node.leaf[i] : node.child[i].node();
        prefetch(opens_a ? tree_a : tree_b, node, i);
        std::size_t at = open.size();
        open.push_back(next);
        for (; at > first && open[at - 1].lower < next.lower; --at) open[at] = open[at - 1];
        open[at] = next;
      }
    }
    return false;
  }
};

void find_closest(Traversal& traversal) { Descent(traversal, false).run(); }
void find_intersection(Traversal& traversal) { Descent(traversal, true).run(); }

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::detail {

HWY_EXPORT(offer_seed);
HWY_EXPORT(find_closest);
HWY_EXPORT(find_intersection);

bool offer_pair(Traversal& traversal, TrianglePair pair, const TriangleCorners& a, const TriangleCorners& b) {
  const ClosestPoints closest = triangle_triangle_distance(a, b);
  if (closest.distance > traversal.best) return false;
  const bool closer = closest.distance < traversal.best;
  if (!closer && traversal.found) {
    const auto rank = [&](const TrianglePair& p) {
      return std::pair(traversal.a->mesh_triangle()[p.a], traversal.b->mesh_triangle()[p.b]);
    };
    if (rank(traversal.pair) <= rank(pair)) return false;
  }
  traversal.best = closest.distance;
  traversal.found = true;
  traversal.pair = pair;
  traversal.closest = closest;
  return closer;
}

Samples::Samples(const Tree& tree) {
  for (std::size_t i = 0; i < k_count; ++i) {
    leaf[i] = static_cast<std::uint32_t>((2 * i + 1) * tree.leaves().size() / (2 * k_count));
    for (std::size_t k = 0; k < 3; ++k) point[k][i] = tree.leaves()[leaf[i]].corner[0][k][0];
  }
}

void offer_seed(Traversal& traversal, const Samples& a, const Samples& b) {
  HWY_DYNAMIC_DISPATCH(offer_seed)(traversal, a, b);
}

void find_closest(Traversal& traversal) { HWY_DYNAMIC_DISPATCH(find_closest)(traversal); }
void find_intersection(Traversal& traversal) { HWY_DYNAMIC_DISPATCH(find_intersection)(traversal); }

}  // namespace sixdof::detail
#endif
