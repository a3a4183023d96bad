#include <sixdof/oracle/distance_search.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <span>

#include <Eigen/Geometry>

#include <sixdof/oracle/triangle_distances.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/distance_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/oracle/distance_bounds-inl.h>

// Depth-first branch and bound over pairs of volumes, the pair with the smallest lower bound first. Of two volumes the
// larger is expanded: its eight children are bounded against the other volume at once, one child per SIMD lane.
//
// Bounds are floats. A pair whose bound is not above the best, but less than its rounding below, is bounded once more
// in doubles; and where floats cannot tell the parts of a pair apart, the pair is searched in doubles (close_search.h).
//
// Ties: between coplanar patches the distances of thousands of pairs of triangles count as equal (TieWindow), and the
// answer is the pair of smallest rank. A pair that can at most tie with the best is pruned and recorded in `tied`.
// resolve_ties() expands the recorded pairs in the order of their ranks, so only a few of them.

HWY_BEFORE_NAMESPACE();
namespace sixdof::detail {
namespace HWY_NAMESPACE {

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

/// Volumes smaller than this many times the rounding of float bounds are searched in doubles.
constexpr float k_blurred = 16.0f;
/// So is a leaf with a node whose size is less than the leaf's thickness times this.
constexpr float k_thick = 4.0f;
/// Where doubles may prune more but are not the only way, they are used only after as many such pairs in a search. Most
/// searches have fewer, and to bound a pair again takes as long as to expand it.
constexpr std::uint64_t k_patience_with_thick = 256;
constexpr std::uint64_t k_patience_with_doubtful = 1024;
constexpr std::uint64_t k_patience_with_touching = 256;  // for intersections, exact tests of triangles are spared, too

/// And, in long searches, with a node whose size is less than its own divided by this.
constexpr float k_unlike = 8.0f;
/// A search is long after as many pairs of leaves.
constexpr std::uint64_t k_patience_with_leaves = 4096;
/// After as many exact distances of triangles their gap along the normals is asked first. Most searches need fewer.
constexpr std::uint64_t k_patience_with_triangles = 256;
/// So many pairs of leaves are early in a search.
constexpr std::uint64_t k_early = 16;
/// Axes across two boxes, and across two triangles, which are measured exactly otherwise.
constexpr CrossAxesUse k_use_of_cross_axes(0.125);
constexpr CrossAxesUse k_use_of_cross_edges(0.03);

class DistanceTraversal final : private CloseVisitor {
 public:
  DistanceTraversal(DistanceSearch& search, bool only_intersection)
      : search_(search),
        tree_a_(search.a.tree),
        tree_b_(search.b.tree),
        only_intersection_(only_intersection),
        frames_(tree_a_, tree_b_, search.X_AB),
        blurred_(k_blurred * k_blurred * frames_.slack.all * frames_.slack.all),
        blurs_leaves_(std::max(search.a.smallest_leaf, search.b.smallest_leaf) < blurred_),
        has_planes_(!search.a.patches.empty() && !search.b.patches.empty()),
        close_bounds_(tree_a_, tree_b_, search.X_AB),
        expansion_(tree_a_, tree_b_) {
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
  void set_best() {
    best_ = only_intersection_ ? 0.0f : rounded_up(search_.best + search_.ties.width);
    doubtful_ = best_ - frames_.slack.all;
  }

  /// Returns true if an intersecting pair was found.
  bool find() {
    search_.deferred.clear();
    if (traverse()) return true;
    std::vector<NodePair>& rest = search_.deferred;
    std::erase_if(rest, [this](const NodePair& x) { return x.lower > best_; });
    std::sort(rest.begin(), rest.end(), [](const NodePair& x, const NodePair& y) { return x.lower < y.lower; });
    for (std::size_t first = 0; first < rest.size();) {
      std::array<TrianglePair, TriangleDistances::k_most> next;
      std::size_t count = 0;
      for (; first < rest.size() && count < next.size() && rest[first].lower <= best_; ++first) {
        next[count++] = triangles_of(rest[first]);
      }
      if (count == 0) return false;
      if (measure(std::span(next).first(count))) return true;
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
      if (is_doubtful(top) && bound_closely(top) > largest_of_interest()) continue;
      if (is_leaf(top.a) && is_leaf(top.b)) {
        if (are_blurred(top) ? search_in_doubles(top) : measure_leaves(top)) return true;
        continue;
      }
      if (needs_doubles(top)) {
        if (search_in_doubles(top)) return true;
        continue;
      }
      const std::size_t first = stack.size();
      const bool is_early = search_.counts.leaf_pairs < k_early;
      expand(top, [&](const NodePair& next) {
        std::size_t at = stack.size();
        const std::size_t lowest = is_early ? first : std::max(first + 1, at) - 1;
        stack.push_back(next);
        for (; at > lowest && stack[at - 1].lower < next.lower; --at) stack[at] = stack[at - 1];
        stack[at] = next;
      });
    }
    return false;
  }

  /// Whether a pair, not of two leaves, is searched in doubles: if the larger is so small that floats blur it, or if
  /// the other is a leaf whose volume is much larger than its triangles in comparison: a thick one, or slices of a fan
  /// that lie across all axes.
  HWY_INLINE bool needs_doubles(const NodePair& pair) {
    const Tree::Volume& a = volume_of(tree_a_, pair.a);
    const Tree::Volume& b = volume_of(tree_b_, pair.b);
    const float size_a = a.squared_diagonal();
    const float size_b = b.squared_diagonal();
    const bool expands_a = is_leaf(pair.b) || (!is_leaf(pair.a) && size_a >= size_b);
    const float expanded = expands_a ? size_a : size_b;
    if (expanded < blurred_) return true;
    if (!is_leaf(expands_a ? pair.b : pair.a)) return false;
    const bool is_long_search = search_.counts.leaf_pairs > k_patience_with_leaves;
    if (is_long_search && k_unlike * k_unlike * expanded < (expands_a ? size_b : size_a)) return true;
    return is_thick(expands_a ? b : a, expanded) && ++thick_pairs_ > k_patience_with_thick;
  }

  /// @param size square of a diagonal
  static bool is_thick(const Tree::Volume& leaf, float size) {
    float thickness = leaf.slab_upper - leaf.slab_lower;
    for (std::size_t k = 0; k < 3; ++k) thickness = std::min(thickness, leaf.upper[k] - leaf.lower[k]);
    return k_thick * k_thick * thickness * thickness > size;
  }

  bool are_blurred(const NodePair& leaves) const {
    return blurs_leaves_ && std::max(volume_of(tree_a_, leaves.a).squared_diagonal(),
                                     volume_of(tree_b_, leaves.b).squared_diagonal()) < blurred_;
  }

  HWY_NOINLINE bool search_in_doubles(const NodePair& top) {
    return search_closely(tree_a_, tree_b_, close_bounds_, top.a, top.b, *this, search_.close);
  }

  /// Whether the pair's bound may exceed the best but for rounding.
  bool is_doubtful(const NodePair& pair) {
    if (!(pair.lower > doubtful_)) return false;
    return ++doubtful_pairs_ > (only_intersection_ ? k_patience_with_touching : k_patience_with_doubtful);
  }

  HWY_NOINLINE double bound_closely(const NodePair& pair) const {
    return close_bounds_.lower_bound(close_bounds_.shape_of_a({pair.a}), close_bounds_.shape_of_b({pair.b}),
                                     search_.direction, largest_of_interest());
  }

  double largest_of_interest() const override { return only_intersection_ ? 0.0 : search_.best + search_.ties.width; }
  const Eigen::Vector3d& direction() const override { return search_.direction; }
  bool prune_volumes(std::uint32_t a, std::uint32_t b) override {
    return tie_pruning_ == TiePruning::planes && prune_by_planes({a, b, 0.0f});
  }
  bool visit_triangles(TrianglePair pair) override { return measure({&pair, 1}); }
  void count_expansion() override { ++search_.counts.nodes; }

  /// Tests pairs of triangles exactly, up to TriangleDistances::k_most. Returns true if one intersects.
  bool measure(std::span<const TrianglePair> pairs) {
    std::array<TrianglePair, TriangleDistances::k_most> left;
    std::size_t count = 0;
    for (const TrianglePair pair : pairs) {
      if (!prune_by_gap(pair)) left[count++] = pair;
    }
    search_.counts.triangles += count;
    const std::span<const TrianglePair> rest = std::span(left).first(count);
    if (only_intersection_) return test_intersections(rest);
    const bool closer = count > 1 ? measure_several(rest) : count == 1 && try_update(search_, rest[0]);
    if (!closer) return false;
    if (search_.best == 0.0) return true;
    frames_.set_direction(search_.direction);
    expansion_.forget();
    set_best();
    return false;
  }

  /// Returns whether the distance decreased.
  HWY_NOINLINE bool measure_several(std::span<const TrianglePair> pairs) {
    TriangleDistances several;
    for (const TrianglePair& pair : pairs) several.add(tree_a_.corners()[pair.a], corners_of_b(search_, pair.b));
    several.measure();
    bool closer = false;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (!several.is_measured(i)) {
        closer |= try_update(search_, pairs[i]);
      } else if (try_update(search_, pairs[i], several.distance(i))) {
        search_.direction = several.direction(i);
        closer = true;
      }
    }
    return closer;
  }

  bool test_intersections(std::span<const TrianglePair> pairs) {
    for (const TrianglePair pair : pairs) {
      if (!intersects(search_, pair)) continue;
      search_.found = true;
      search_.pair = pair;
      return true;
    }
    return false;
  }

  /// Tests or defers the pairs of triangles of two leaves. Returns true if a pair intersects.
  bool measure_leaves(const NodePair& leaves) {
    const Tree::Leaf& leaf_a = leaf_of(tree_a_, leaves.a);
    const Tree::Leaf& leaf_b = leaf_of(tree_b_, leaves.b);
    LeafPair pairs;
    if (!bound_pairs(leaf_a, leaf_b, pairs)) return false;
    // Pairs that improve on the best for certain, or may intersect, are measured now, the smallest upper bounds first.
    // The others are deferred: most of them are pruned later. Between coplanar patches pairs at the distance of the
    // best count as improving, one at a time, as the first exact distance shows that the rest tie.
    const bool coplanar = plane_of(search_.a.patches, leaves.a) && plane_of(search_.b.patches, leaves.b);
    while (true) {
      std::array<TrianglePair, TriangleDistances::k_most> next;
      const float improving = coplanar ? best_ + frames_.slack.all : best_;
      const std::span<TrianglePair> most = std::span(next).first(coplanar ? 1 : next.size());
      const std::span<TrianglePair> taken = take_improving(leaf_a, leaf_b, pairs, improving, most);
      if (taken.empty()) break;
      if (measure(taken)) return true;
    }
    for_each_kept(leaf_a, leaf_b, pairs, [this](const NodePair& pair) { search_.deferred.push_back(pair); });
    return false;
  }

  /// Moves the pairs with the smallest upper bounds, of those that may intersect or are below `improving`, from `pairs`
  /// to `taken` as far as there is space. Returns them.
  std::span<TrianglePair> take_improving(const Tree::Leaf& leaf_a, const Tree::Leaf& leaf_b, LeafPair& pairs,
                                         float improving, std::span<TrianglePair> taken) const {
    std::size_t count = 0;
    std::array<std::uint32_t, LeafPair::k_pairs> lanes;
    for (std::uint32_t i = 0; i < leaf_a.child.count(); ++i) {
      for (std::uint32_t j = 0; j < leaf_b.child.count(); ++j) {
        const std::uint32_t lane = k_leaf * i + j;
        if (pairs.lower[lane] > best_ || (pairs.lower[lane] > 0.0f && pairs.upper[lane] >= improving)) continue;
        std::size_t at = count++;
        for (; at > 0 && pairs.upper[lanes[at - 1]] > pairs.upper[lane]; --at) lanes[at] = lanes[at - 1];
        lanes[at] = lane;
      }
    }
    taken = taken.first(std::min(count, taken.size()));
    for (std::size_t k = 0; k < taken.size(); ++k) {
      taken[k] = {leaf_a.child.first() + lanes[k] / k_leaf, leaf_b.child.first() + lanes[k] % k_leaf};
      pairs.lower[lanes[k]] = Tree::k_empty;
    }
    return taken;
  }

  /// Lower bounds for all pairs of triangles of two leaves. Returns false if all are above the best.
  bool bound_pairs(const Tree::Leaf& leaf_a, const Tree::Leaf& leaf_b, LeafPair& pairs) {
    ++search_.counts.leaf_pairs;
    if (bound_along_direction<k_rounding>(leaf_a, leaf_b, frames_, frames_.slack.local, best_, pairs.lower) > best_) {
      return false;
    }
    load_pairs<k_rounding>(leaf_a, leaf_b, frames_.a, pairs);
    bound_triangles(pairs, frames_.slack.all, best_);
    if (use_of_cross_edges_.is_due()) {
      const int before = count_near(pairs);
      if (before > 0) {
        bound_across_edges(pairs, frames_.slack.all, best_);
        use_of_cross_edges_.count(before, count_near(pairs));
      }
    }
    return true;
  }

  /// Pairs of triangles whose bounds are not above the best.
  HWY_INLINE int count_near(const LeafPair& pairs) const {
    int count = 0;
    for (const float lower : pairs.lower) count += lower <= best_ ? 1 : 0;
    return count;
  }

  /// Calls keep() for the pairs of triangles of two leaves whose bounds are not above the best.
  template <class Keep>
  void for_each_kept(const Tree::Leaf& leaf_a, const Tree::Leaf& leaf_b, const LeafPair& pairs, const Keep& keep) {
    for (std::uint32_t i = 0; i < leaf_a.child.count(); ++i) {
      for (std::uint32_t j = 0; j < leaf_b.child.count(); ++j) {
        const float lower = pairs.lower[k_leaf * i + j];
        if (lower <= best_) keep(node_pair({leaf_a.child.first() + i, leaf_b.child.first() + j}, lower));
      }
    }
  }

  /// Expands two volumes that are not both leaves: calls keep() for each pair of volumes whose bound is not above the
  /// best.
  template <class Keep>
  HWY_INLINE void expand(const NodePair& top, const Keep& keep) {
    expansion_.take(tree_a_, top.a, tree_b_, top.b, frames_);
    const auto& [a, b] = expansion_;
    const auto near_b =
        b.lanes() & near_volumes(a.volumes(), a.whole(), b.volumes(), frames_.shift_along, frames_.slack, best_);
    const auto near_a =
        a.lanes() & near_volumes(b.volumes(), b.whole(), a.volumes(), frames_.shift_along, frames_.slack, best_);
    // One volume after the other of the side that has fewer.
    const bool x_is_a = std::popcount(near_a) >= std::popcount(near_b);
    const auto& x = x_is_a ? a : b;
    const auto& y = x_is_a ? b : a;
    const std::uint32_t near_x = x_is_a ? near_a : near_b;
    const Frame& frame = x_is_a ? frames_.a : frames_.b;
    for (std::uint32_t rest = x_is_a ? near_b : near_a; rest != 0; rest &= rest - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(rest));
      HWY_ALIGN float bounds[k_width];
      ++search_.counts.nodes;
      std::uint32_t kept =
          near_x & bound_volumes(x.volumes(), y.volumes(), j, frame, frames_.shift_along, frames_.slack, best_, bounds);
      if (kept != 0 && use_of_cross_axes_.is_due())
        kept = ask_cross_axes(x.volumes(), y.volumes(), j, x_is_a, kept, bounds);
      if (kept == 0) continue;
      const std::uint32_t child_y = y.child(j);
      y.prefetch_child(child_y);
      for (; kept != 0; kept &= kept - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(kept));
        const std::uint32_t child_x = x.child(i);
        x.prefetch_child(child_x);
        keep(x_is_a ? NodePair{child_x, child_y, bounds[i]} : NodePair{child_y, child_x, bounds[i]});
      }
    }
  }

  HWY_NOINLINE std::uint32_t ask_cross_axes(const Volumes& x, const Volumes& y, std::size_t j, bool x_is_a,
                                            std::uint32_t kept, float* bounds) {
    if (!cross_axes_) cross_axes_.emplace(search_.X_AB.R);
    const auto& axes_x = x_is_a ? cross_axes_->in_a : cross_axes_->in_b;
    const auto& axes_y = x_is_a ? cross_axes_->in_b : cross_axes_->in_a;
    const std::uint32_t left = bound_across_axes(x, y, j, axes_x, axes_y, frames_.slack, best_, kept, bounds);
    use_of_cross_axes_.count(std::popcount(kept), std::popcount(left));
    return left;
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

  /// The same by the planes of two triangles, where it may be a tie or spare an exact test of an intersection; and in
  /// long searches.
  bool prune_by_gap(TrianglePair pair) {
    const bool is_asked =
        only_intersection_ || search_.ties.margin > 0.0 || search_.counts.triangles > k_patience_with_triangles;
    return is_asked && prune(node_pair(pair, 0.0f), gap_of(search_, pair));
  }

  HWY_INLINE bool prune_by_planes(const NodePair& pair) { return has_planes_ && prune_by_their_planes(pair); }

  HWY_NOINLINE bool prune_by_their_planes(const NodePair& pair) {
    const CoplanarPatches::Plane* plane_a = plane_of(search_.a.patches, pair.a);
    const CoplanarPatches::Plane* plane_b = plane_of(search_.b.patches, pair.b);
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
        continue;
      }
      if (is_leaf(top.a) && is_leaf(top.b)) {
        const Tree::Leaf& leaf_a = leaf_of(tree_a_, top.a);
        const Tree::Leaf& leaf_b = leaf_of(tree_b_, top.b);
        LeafPair pairs;
        if (!bound_pairs(leaf_a, leaf_b, pairs)) continue;
        for_each_kept(leaf_a, leaf_b, pairs, push);
      } else {
        expand(top, push);
      }
    }
    if (first.uncertain < first.rank) return false;
    if (std::pair(first.pair.a, first.pair.b) != std::pair(search_.pair.a, search_.pair.b)) {
      search_.pair = first.pair;
      search_.closest.reset();
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
    return {smallest(search_.a.patches, pair.a), smallest(search_.b.patches, pair.b)};
  }

  static bool is_triangle(std::uint32_t volume) { return !is_leaf(volume) && (volume & NodePair::k_triangle) != 0; }
  static NodePair node_pair(TrianglePair pair, float lower) {
    return {NodePair::k_triangle + pair.a, NodePair::k_triangle + pair.b, lower};
  }
  static TrianglePair triangles_of(const NodePair& pair) {
    return {pair.a - NodePair::k_triangle, pair.b - NodePair::k_triangle};
  }
  HWY_INLINE static const CoplanarPatches::Plane* plane_of(const CoplanarPatches& patches, std::uint32_t volume) {
    return is_leaf(volume) ? patches.of_leaf(volume - NodePair::k_leaf) : patches.of_node(volume);
  }

  DistanceSearch& search_;
  const Tree& tree_a_;
  const Tree& tree_b_;
  const bool only_intersection_;
  QueryFrames frames_;
  const float blurred_;      // square of a diagonal: of the largest volume that floats blur
  const bool blurs_leaves_;  // both trees have leaves that small
  const bool has_planes_;    // both meshes have coplanar patches
  const CloseBounds close_bounds_;
  Expansion<k_rounding, true> expansion_;
  std::optional<CrossAxes> cross_axes_;  // made when they are asked for the first time
  CrossAxesUse use_of_cross_axes_ = k_use_of_cross_axes;
  CrossAxesUse use_of_cross_edges_ = k_use_of_cross_edges;
  std::uint64_t thick_pairs_ = 0;
  std::uint64_t doubtful_pairs_ = 0;
  float best_;      // search_.best + search_.ties.width, rounded up
  float doubtful_;  // bounds above this may exceed the best but for rounding
  TiePruning tie_pruning_ = TiePruning::planes;
};

void find_pair(DistanceSearch& search, bool only_intersection) { DistanceTraversal(search, only_intersection).run(); }

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::detail {

TriangleCorners corners_of_b(const DistanceSearch& search, std::uint32_t triangle) {
  const Tree::Corners& corners = search.b.tree.corners()[triangle];
  return {search.X_AB * corners[0], search.X_AB * corners[1], search.X_AB * corners[2]};
}

HWY_EXPORT(find_pair);

void find_pair(DistanceSearch& search, bool only_intersection) {
  HWY_DYNAMIC_DISPATCH(find_pair)(search, only_intersection);
}

TieWindow TieWindow::of(const DistanceBody& body_a, const DistanceBody& body_b, const Pose& X_AB) {
  if (body_a.patches.empty() || body_b.patches.empty()) return {};
  const Tree &a = body_a.tree, &b = body_b.tree;
  // Relative to the radii: n . p of a plane's corners rounds by a dozen units in the last place at most; rotating a
  // normal and transforming a corner, by a dozen more; a triangle's distance by k_triangle_distance_error times its
  // size. Offsets from the origins enter by the transformed corners and the centres alone.
  const Eigen::Vector3d shift = X_AB * b.center() - a.center();
  const double error = 4e-15 * (a.radius() + b.radius() + shift.norm()) +
                       1.5e-15 * (a.center().norm() + b.center().norm() + X_AB.t.norm());
  // A bound between planes is lowered by the error and may be off by as much, so at a tie it comes within twice the
  // error of every distance. Distances of ties differ by less than the error.
  return {.error = error, .margin = 2.0 * error, .width = 3.0 * error};
}

Rank rank_of(const DistanceSearch& search, TrianglePair pair) {
  return {search.a.tree.mesh_triangle()[pair.a], search.b.tree.mesh_triangle()[pair.b]};
}

ClosestPoints distance_of(const DistanceSearch& search, TrianglePair pair) {
  return triangle_triangle_distance(search.a.tree.corners()[pair.a], corners_of_b(search, pair.b));
}

double gap_of(const DistanceSearch& search, TrianglePair pair) {
  return triangle_gap(search.a.tree.corners()[pair.a], corners_of_b(search, pair.b));
}

bool intersects(const DistanceSearch& search, TrianglePair pair) {
  return triangles_intersect(search.a.tree.corners()[pair.a], corners_of_b(search, pair.b));
}

bool try_update(DistanceSearch& search, TrianglePair pair, double distance) {
  if (distance > search.best + search.ties.width) return false;
  search.measured.push_back({pair, distance});
  if (distance > search.best || (search.found && distance == search.best)) return false;
  const bool closer = distance < search.best;
  search.best = distance;
  search.found = true;
  search.pair = pair;
  search.closest.reset();
  return closer;
}

bool try_update(DistanceSearch& search, TrianglePair pair) {
  const ClosestPoints closest = distance_of(search, pair);
  if (!try_update(search, pair, closest.distance)) return false;
  search.closest = closest;
  search.direction = closest.on_b - closest.on_a;
  return true;
}

const ClosestPoints& points_of(DistanceSearch& search) {
  if (!search.closest) search.closest = distance_of(search, search.pair);
  return *search.closest;
}

float smallest_leaf_of(const Tree& tree) {
  float smallest = std::numeric_limits<float>::infinity();
  for (const Tree::Leaf& leaf : tree.leaves()) {
    smallest = std::min(smallest, leaf.volume.squared_diagonal());
  }
  return smallest;
}

}  // namespace sixdof::detail
#endif  // HWY_ONCE
