#include <sixdof/oracle/distance_traversal.h>

#include <algorithm>
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

// Depth-first branch and bound over pairs of volumes, the pair with the smallest lower bound first. Of two volumes the
// larger is expanded: its eight children are bounded against the other volume at once, one child per SIMD lane.
//
// Ties: between coplanar patches the distances of thousands of pairs of triangles count as equal (TieWindow), and the
// answer is the pair of smallest rank. A pair that can at most tie with the best is pruned and recorded in `tied`.
// resolve_ties() expands the recorded pairs in the order of their ranks, so only a few of them.

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

float rounded_up(double x) {
  return std::nextafter(static_cast<float>(std::min(x, 1e30)), std::numeric_limits<float>::infinity());
}

/// The pair of the smallest rank among those whose distances count as equal to the smallest distance. That distance is
/// not above search.best, and may be as small as the least lower bound of the tied pairs.
struct FirstOfTies {
  const DistanceSearch& search;
  double certain;              // up to here a distance counts as equal, whatever the smallest is
  double possible;             // beyond, it does not
  Rank rank = k_no_rank;       // of `pair`
  Rank uncertain = k_no_rank;  // smallest of those in between
  TrianglePair pair{};

  explicit FirstOfTies(const DistanceSearch& s) : search(s), certain(s.best + s.ties.width), possible(certain) {
    for (const TiedPair& x : s.tied) certain = std::min(certain, x.lower + s.ties.width);
  }

  void update(const MeasuredPair& x) {
    if (x.distance > possible) return;
    const Rank other = rank_of(search, x.pair);
    if (x.distance > certain) {
      uncertain = std::min(uncertain, other);
    } else if (other < rank) {
      rank = other;
      pair = x.pair;
    }
  }
};

/// Which pairs are pruned although they may tie: pairs of patches by their planes and pairs of triangles by
/// triangle_gap(); only the latter, whose bounds are tighter; none.
enum class TiePruning {
  planes,
  triangles,
  none
};

class DistanceTraversal {
 public:
  DistanceTraversal(DistanceSearch& search, bool only_intersection)
      : search_(search),
        tree_a_(*search.a),
        tree_b_(*search.b),
        only_intersection_(only_intersection),
        frames_(tree_a_, tree_b_, search.X_AB) {
    if (search_.direction.squaredNorm() == 0.0) search_.direction = frames_.shift;
    frames_.set_direction(search_.direction);
    set_best();
  }

  void run() {
    for (const TiePruning next : {TiePruning::planes, TiePruning::triangles, TiePruning::none}) {
      tie_pruning_ = next;
      search_.tied.clear();
      if (find() || only_intersection_ || resolve_ties()) return;
    }
  }

 private:
  void set_best() { best_ = only_intersection_ ? 0.0f : rounded_up(search_.best + search_.ties.width); }

  /// Returns true if an intersecting pair was found.
  bool find() {
    search_.deferred.clear();
    if (traverse()) return true;
    std::vector<DeferredPair>& rest = search_.deferred;
    std::erase_if(rest, [this](const DeferredPair& x) { return x.lower > best_; });
    std::sort(rest.begin(), rest.end(), [](const DeferredPair& x, const DeferredPair& y) { return x.lower < y.lower; });
    for (const DeferredPair& x : rest) {
      if (x.lower > best_) return false;
      if (measure(x.pair)) return true;
    }
    return false;
  }

  /// Returns true if an intersecting pair was found.
  bool traverse() {
    std::vector<NodePair>& stack = search_.stack;
    stack.assign(1, {0, 0, -Tree::k_empty});
    while (!stack.empty()) {
      const NodePair top = stack.back();
      stack.pop_back();
      if (top.lower > best_ || (tie_pruning_ == TiePruning::planes && prune_by_planes(top))) continue;
      if (is_leaf(top.a) && is_leaf(top.b)) {
        if (measure_leaves(top)) return true;
        continue;
      }
      const std::size_t first = stack.size();
      expand_larger(top, [&](const NodePair& next) { push_sorted(stack, first, next); });
    }
    return false;
  }

  /// Tests two triangles exactly. Returns true if they intersect.
  bool measure(TrianglePair pair) {
    const NodePair triangles{NodePair::k_triangle + pair.a, NodePair::k_triangle + pair.b, 0.0f};
    if (prune(triangles, gap_of(search_, pair))) return false;
    ++search_.counts.triangles;
    if (only_intersection_) {
      if (!intersects(search_, pair)) return false;
      search_.found = true;
      search_.pair = pair;
      return true;
    }
    if (try_update(search_, pair)) {
      if (search_.best == 0.0) return true;
      search_.direction = search_.closest.on_b - search_.closest.on_a;
      frames_.set_direction(search_.direction);
      set_best();
    }
    return false;
  }

  /// Tests or defers the pairs of triangles of two leaves. Returns true if a pair intersects.
  bool measure_leaves(const NodePair& leaves) {
    const Tree::Leaf& leaf_a = leaf_of(tree_a_, leaves.a);
    const Tree::Leaf& leaf_b = leaf_of(tree_b_, leaves.b);
    LeafPair pairs;
    if (!bound_pairs(leaf_a, leaf_b, pairs)) return false;
    // Pairs that improve on the best for certain, or may intersect, are measured now, the smallest upper bound first.
    // The others are deferred: most of them are pruned later. Between coplanar patches pairs at the distance of the
    // best count as improving, as the first exact distance shows that the rest tie.
    const bool coplanar = plane_of(*search_.patches_a, leaves.a) && plane_of(*search_.patches_b, leaves.b);
    const float improving = coplanar ? best_ + frames_.slack.all : best_;
    for (;;) {
      std::uint32_t next = LeafPair::k_pairs;
      for (std::uint32_t i = 0; i < leaf_a.child.count(); ++i) {
        for (std::uint32_t j = 0; j < leaf_b.child.count(); ++j) {
          const std::uint32_t lane = k_leaf * i + j;
          if (pairs.lower[lane] > best_ || (pairs.lower[lane] > 0.0f && pairs.upper[lane] >= improving)) continue;
          if (next == LeafPair::k_pairs || pairs.upper[lane] < pairs.upper[next]) next = lane;
        }
      }
      if (next == LeafPair::k_pairs) break;
      pairs.lower[next] = Tree::k_empty;
      if (measure({leaf_a.child.first() + next / k_leaf, leaf_b.child.first() + next % k_leaf})) return true;
    }
    for_each_kept(leaf_a, leaf_b, pairs, [this](TrianglePair pair, float lower) {
      search_.deferred.push_back({pair, lower});
    });
    return false;
  }

  /// Lower bounds for all pairs of triangles of two leaves. Returns false if all are above the best.
  bool bound_pairs(const Tree::Leaf& leaf_a, const Tree::Leaf& leaf_b, LeafPair& pairs) {
    ++search_.counts.leaf_pairs;
    if (!bound_along_direction(leaf_a, leaf_b, frames_.expand_a, frames_.slack, best_, pairs.lower)) return false;
    load_pairs(leaf_a, leaf_b, frames_.expand_a, pairs);
    bound_triangles(pairs, frames_.slack.all, best_);
    return true;
  }

  /// Calls keep(pair, lower bound) for the pairs of triangles of two leaves whose bounds are not above the best.
  template <class Keep>
  void for_each_kept(const Tree::Leaf& leaf_a, const Tree::Leaf& leaf_b, const LeafPair& pairs, const Keep& keep) {
    for (std::uint32_t i = 0; i < leaf_a.child.count(); ++i) {
      for (std::uint32_t j = 0; j < leaf_b.child.count(); ++j) {
        const float lower = pairs.lower[k_leaf * i + j];
        if (lower > best_) continue;
        keep(TrianglePair{leaf_a.child.first() + i, leaf_b.child.first() + j}, lower);
      }
    }
  }

  /// Expands the larger of two volumes that are not both leaves: calls keep() for each pair of a child and the other
  /// volume whose bound is not above the best.
  template <class Keep>
  HWY_INLINE void expand_larger(const NodePair& top, const Keep& keep) {
    const Tree::Volume& volume_a = volume_of(tree_a_, top.a);
    const Tree::Volume& volume_b = volume_of(tree_b_, top.b);
    const bool expands_a = is_leaf(top.b) || (!is_leaf(top.a) && size_of(volume_a) >= size_of(volume_b));
    const Tree::Node& node = expands_a ? tree_a_.nodes()[top.a] : tree_b_.nodes()[top.b];
    const Frame& frame = expands_a ? frames_.expand_a : frames_.expand_b;
    HWY_ALIGN float bounds[k_width];
    ++search_.counts.nodes;
    unsigned kept =
        bound_children(node, FixedVolume(expands_a ? volume_b : volume_a, frame), frame, frames_.slack, best_, bounds);
    for (; kept != 0; kept &= kept - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(kept));
      NodePair next{top.a, top.b, bounds[i]};
      (expands_a ? next.a : next.b) = node.child[i].is_leaf() ? NodePair::k_leaf + node.leaf[i] : node.child[i].node();
      prefetch(expands_a ? tree_a_ : tree_b_, node, i);
      keep(next);
    }
  }

  /// Prefetches a child, which one of the next steps reads: large trees are not in the caches.
  static HWY_INLINE void prefetch(const Tree& tree, const Tree::Node& node, std::size_t i) {
    const bool leaf = node.child[i].is_leaf();
    const char* at = leaf ? reinterpret_cast<const char*>(&tree.leaves()[node.leaf[i]])
                          : reinterpret_cast<const char*>(&tree.nodes()[node.child[i].node()]);
    const std::size_t bytes = leaf ? sizeof(Tree::Leaf) : sizeof(Tree::Node);
    for (std::size_t byte = 0; byte < bytes; byte += k_cache_line) hwy::Prefetch(at + byte);
  }

  /// Whether a pair whose exact distance is at least `lower` is not closer than the best. Records it if it may tie.
  bool prune(const NodePair& pair, double lower) {
    if (!(lower > 0.0)) return false;  // they may intersect
    if (only_intersection_) return true;
    const TieWindow& ties = search_.ties;
    if (lower > search_.best + ties.width) return true;
    if (tie_pruning_ == TiePruning::none || !(lower > search_.best - ties.margin)) return false;
    search_.tied.push_back({pair, lower});
    return true;
  }

  bool prune_by_planes(const NodePair& pair) {
    const CoplanarPatches::Plane* plane_a = plane_of(*search_.patches_a, pair.a);
    const CoplanarPatches::Plane* plane_b = plane_of(*search_.patches_b, pair.b);
    if (!plane_a || !plane_b) return false;
    const double gap =
        plane_gap(*plane_a, volume_of(tree_a_, pair.a), *plane_b, volume_of(tree_b_, pair.b), frames_.R, frames_.shift);
    return prune(pair, gap - search_.ties.error);
  }

  /// Takes the pair of smallest rank whose distance counts as equal to the smallest, of those measured and of those in
  /// `tied`. Returns false if it cannot be decided: a pair in `tied` may have a smaller distance than the best, and
  /// whether a pair of small rank counts as equal depends on that distance.
  bool resolve_ties() {
    std::erase_if(search_.tied, [&](const TiedPair& x) { return x.lower > search_.best + search_.ties.width; });
    if (!search_.found) return search_.tied.empty();  // all distances are above the upper bound
    FirstOfTies first(search_);
    for (const MeasuredPair& x : search_.measured) first.update(x);
    std::vector<RankedPair>& heap = search_.ranked;
    const auto later = [](const RankedPair& x, const RankedPair& y) { return x.smallest > y.smallest; };
    const auto push = [&](const NodePair& pair) {
      const Rank smallest = smallest_rank(pair);
      if (smallest >= first.rank) return;
      heap.push_back({smallest, pair});
      std::push_heap(heap.begin(), heap.end(), later);
    };
    heap.clear();
    for (const TiedPair& x : search_.tied) push(x.pair);
    while (!heap.empty() && heap.front().smallest < first.rank) {
      const NodePair top = heap.front().pair;
      std::pop_heap(heap.begin(), heap.end(), later);
      heap.pop_back();
      if (is_triangle(top.a)) {
        ++search_.counts.triangles;
        first.update({triangles_of(top), distance_of(search_, triangles_of(top)).distance});
      } else if (is_leaf(top.a) && is_leaf(top.b)) {
        const Tree::Leaf& leaf_a = leaf_of(tree_a_, top.a);
        const Tree::Leaf& leaf_b = leaf_of(tree_b_, top.b);
        LeafPair pairs;
        if (!bound_pairs(leaf_a, leaf_b, pairs)) continue;
        for_each_kept(leaf_a, leaf_b, pairs, [&](TrianglePair pair, float lower) {
          push({NodePair::k_triangle + pair.a, NodePair::k_triangle + pair.b, lower});
        });
      } else {
        expand_larger(top, push);
      }
    }
    if (first.uncertain < first.rank) return false;
    if (std::pair(first.pair.a, first.pair.b) != std::pair(search_.pair.a, search_.pair.b)) {
      search_.pair = first.pair;
      search_.closest = distance_of(search_, first.pair);
    }
    return true;
  }

  /// Smallest rank that a pair of triangles in `pair` can have.
  Rank smallest_rank(const NodePair& pair) const {
    if (is_triangle(pair.a)) return rank_of(search_, triangles_of(pair));
    const auto smallest = [](const CoplanarPatches& patches, std::uint32_t volume) {
      return is_leaf(volume) ? patches.smallest_index_of_leaf(volume - NodePair::k_leaf)
                             : patches.smallest_index_of_node(volume);
    };
    return {smallest(*search_.patches_a, pair.a), smallest(*search_.patches_b, pair.b)};
  }

  static bool is_leaf(std::uint32_t volume) { return (volume & NodePair::k_leaf) != 0; }
  static bool is_triangle(std::uint32_t volume) { return !is_leaf(volume) && (volume & NodePair::k_triangle) != 0; }
  static TrianglePair triangles_of(const NodePair& pair) {
    return {pair.a - NodePair::k_triangle, pair.b - NodePair::k_triangle};
  }
  static const Tree::Leaf& leaf_of(const Tree& tree, std::uint32_t volume) {
    return tree.leaves()[volume - NodePair::k_leaf];
  }
  static const Tree::Volume& volume_of(const Tree& tree, std::uint32_t volume) {
    return is_leaf(volume) ? leaf_of(tree, volume).volume : tree.nodes()[volume].volume;
  }
  static const CoplanarPatches::Plane* plane_of(const CoplanarPatches& patches, std::uint32_t volume) {
    return is_leaf(volume) ? patches.of_leaf(volume - NodePair::k_leaf) : patches.of_node(volume);
  }

  DistanceSearch& search_;
  const Tree& tree_a_;
  const Tree& tree_b_;
  const bool only_intersection_;
  Frames frames_;
  float best_;  // search_.best + search_.ties.width, rounded up
  TiePruning tie_pruning_ = TiePruning::planes;
};

void find_closest(DistanceSearch& search) { DistanceTraversal(search, false).run(); }
void find_intersection(DistanceSearch& search) { DistanceTraversal(search, true).run(); }

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::detail {

HWY_EXPORT(seed_search);
HWY_EXPORT(find_closest);
HWY_EXPORT(find_intersection);

void seed_search(DistanceSearch& search, const SeedCorners& a, const SeedCorners& b) {
  HWY_DYNAMIC_DISPATCH(seed_search)(search, a, b);
}

void find_closest(DistanceSearch& search) { HWY_DYNAMIC_DISPATCH(find_closest)(search); }
void find_intersection(DistanceSearch& search) { HWY_DYNAMIC_DISPATCH(find_intersection)(search); }

}  // namespace sixdof::detail
#endif  // HWY_ONCE
