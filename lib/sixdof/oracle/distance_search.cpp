#include <sixdof/oracle/distance_search.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>

#include <sixdof/base/simd_targets.h>
#include <sixdof/oracle/distance_ties.h>
#include <sixdof/oracle/triangle_distances.h>
#include <sixdof/proximity/sorted_stack.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/distance_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/oracle/distance_expansion-inl.h>

// Depth-first branch and bound over pairs of volumes, the pair with the smallest lower bound first. Of two volumes the
// larger is expanded: its eight children are bounded against the other volume at once, one child per SIMD lane.
//
// Bounds are floats. A pair whose bound is not above the best, but less than its rounding below, is bounded once more
// in doubles; and where floats cannot tell the parts of a pair apart, the pair is searched in doubles (close_search.h).
//
// Triangles are bounded by floats from both sides. The least upper bound prunes as an exact distance would, so only
// what is left at the end is measured exactly.
//
// A pair that can at most tie with the best is pruned and recorded (distance_ties.h).

HWY_BEFORE_NAMESPACE();
namespace sixdof::detail {
namespace HWY_NAMESPACE {

float rounded_up(double x) {
  return std::nextafter(static_cast<float>(std::min(x, 1e30)), std::numeric_limits<float>::infinity());
}

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
/// Where doubles may prune more but are not the only way, they are used after as many such pairs in a search: to bound
/// a pair again takes as long as to expand it.
constexpr std::uint64_t k_thick_pairs_before_doubles = 256;
constexpr std::uint64_t k_doubtful_pairs_before_doubles = 1024;
constexpr std::uint64_t k_touching_pairs_before_doubles =
    256;  // for intersections, exact tests of triangles are spared, too

/// And, in long searches, with a node whose size is less than its own divided by this.
constexpr float k_much_larger = 8.0f;
/// A search is long after as many pairs of leaves.
constexpr std::uint64_t k_leaf_pairs_of_long_search = 4096;
/// After as many exact distances of triangles their gap along the normals is asked first.
constexpr std::uint64_t k_triangles_before_gaps = 256;
/// After so many pairs of leaves and of triangles, and whenever there are half as many more, a search for an
/// intersection asks whether a corner lies inside the other body: surfaces that nearly coincide intersect along few
/// curves, but about half of their corners are inside.
constexpr std::uint64_t k_pairs_before_corners = 128;
constexpr std::uint64_t k_early_leaf_pairs = 16;  ///< So many pairs of leaves are early in a search.
/// Of axes across two triangles, which are measured exactly otherwise.
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
        width_(rounded_up(search.ties.width)),
        close_bounds_(tree_a_, tree_b_, search.X_AB),
        expansion_(tree_a_, tree_b_, search.X_AB) {
    turn_to(search_.direction.squaredNorm() == 0.0 ? frames_.shift : search_.direction);
    lower_best(only_intersection_ ? 0.0f : rounded_up(search_.best + search_.ties.width));
  }

  void run() {
    for (const TiePruning next : {TiePruning::planes, TiePruning::triangles, TiePruning::none}) {
      tie_pruning_ = next;
      search_.tied.clear();
      if (find() || only_intersection_) return;
      if (resolve_ties(search_, [this](const NodePair& pair, std::vector<NodePair>& parts) { split(pair, parts); }))
        return;
    }
  }

 private:
  /// Sets what bounds are compared with, if it is less than before.
  void lower_best(float best) {
    best_ = std::min(best_, best);
    doubtful_ = best_ - frames_.slack.all;
  }

  /// Sets the direction from A to B.
  void turn_to(const Eigen::Vector3d& direction) {
    search_.direction = direction;
    frames_.set_direction(direction);
    expansion_.forget();
  }

  /// Returns true if an intersecting pair was found.
  bool find() {
    search_.deferred.clear();
    if (traverse()) return true;
    // Doubles tell apart what floats do not: most of what is left is farther along the direction of the closest.
    std::vector<TiedPair>& rest = search_.bounded;
    rest.clear();
    const Eigen::Vector3d direction = search_.direction.normalized();
    for (const NodePair& pair : search_.deferred) {
      if (pair.lower <= best_) rest.push_back({pair, close_bounds_.gap_along(direction, pair.triangles())});
    }
    std::sort(rest.begin(), rest.end(), [](const TiedPair& x, const TiedPair& y) { return x.lower < y.lower; });
    for (std::size_t first = 0; first < rest.size();) {
      // After a few the best is exact, and the others are farther for certain or tie.
      const std::size_t most = first == 0 ? TriangleDistances::k_most / 2 : TriangleDistances::k_most;
      std::array<TrianglePair, TriangleDistances::k_most> next;
      std::size_t count = 0;
      for (; first < rest.size() && count < most && !(rest[first].lower > largest_of_interest()); ++first) {
        next[count++] = rest[first].pair.triangles();
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
      // Children by their bounds: all of them early in a search, later the smallest one only.
      const std::size_t first = stack.size();
      const bool is_early = search_.counts.leaf_pairs < k_early_leaf_pairs;
      expand(top, [&](const NodePair& next) {
        push_sorted(stack, is_early ? first : std::max(first + 1, stack.size()) - 1, next);
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
    const bool is_long_search = search_.counts.leaf_pairs > k_leaf_pairs_of_long_search;
    if (is_long_search && k_much_larger * k_much_larger * expanded < (expands_a ? size_b : size_a)) return true;
    return is_thick(expands_a ? b : a, expanded) && ++thick_pairs_ > k_thick_pairs_before_doubles;
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
    return ++doubtful_pairs_ > (only_intersection_ ? k_touching_pairs_before_doubles : k_doubtful_pairs_before_doubles);
  }

  HWY_NOINLINE double bound_closely(const NodePair& pair) const {
    return close_bounds_.lower_bound(close_bounds_.shape_of_a({pair.a}), close_bounds_.shape_of_b({pair.b}),
                                     search_.direction, largest_of_interest());
  }

  double largest_of_interest() const override {
    return std::min(static_cast<double>(best_), search_.best + search_.ties.width);
  }
  const Eigen::Vector3d& direction() const override { return search_.direction; }
  bool prune_volumes(std::uint32_t a, std::uint32_t b) override {
    return tie_pruning_ == TiePruning::planes && prune_by_planes({a, b, 0.0f});
  }
  bool visit_triangles(TrianglePair pair) override { return measure({&pair, 1}); }
  void count_expansion() override { ++search_.counts.nodes; }

  /// Tests pairs of triangles exactly, up to TriangleDistances::k_most. Returns true if one intersects.
  bool measure(std::span<const TrianglePair> pairs) {
    if (find_corner_inside(pairs.front(), pairs.size())) return true;
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
    turn_to(search_.direction);
    lower_best(rounded_up(search_.best + search_.ties.width));
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

  /// Asks now and then whether the bodies meet at a corner of a pair of triangles.
  /// @param count of pairs met since the last call
  HWY_INLINE bool find_corner_inside(TrianglePair pair, std::size_t count) {
    if (!search_.of_bodies) return false;
    near_pairs_ += count;
    if (near_pairs_ < next_corner_) return false;
    next_corner_ = near_pairs_ + near_pairs_ / 2;
    return search_.found_inside = has_corner_inside(search_, pair, corners_asked_++);
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
    if (find_corner_inside({leaf_a.child.first(), leaf_b.child.first()}, 1)) return true;
    LeafPair pairs;
    if (!bound_pairs(leaf_a, leaf_b, pairs)) return false;
    // Pairs that may intersect are measured now, the others last: most of them are pruned by then. Where an exact best
    // tells more than the least upper bound, pairs that improve on it are measured now, too: where meshes have planes,
    // as ties are pruned by exact distances, and where bounds are asked in doubles. Between coplanar patches pairs at
    // the distance of the best improve, too, one at a time: the first exact distance shows that the rest tie.
    const bool coplanar = has_planes_ && search_.a.patches.of(leaves.a) && search_.b.patches.of(leaves.b);
    const bool one_by_one = coplanar || doubtful_pairs_ > k_doubtful_pairs_before_doubles;
    const float improving = one_by_one ? best_ + frames_.slack.all : has_planes_ ? best_ : -Tree::k_empty;
    if (!has_planes_) take_upper_bound(pairs);
    while (true) {
      std::array<TrianglePair, TriangleDistances::k_most> next;
      const std::span<TrianglePair> most = std::span(next).first(one_by_one ? 1 : next.size());
      const std::span<TrianglePair> taken = take_improving(leaf_a, leaf_b, pairs, improving, most);
      if (taken.empty()) break;
      if (measure(taken)) return true;
    }
    for_each_kept(leaf_a, leaf_b, pairs, [this](const NodePair& pair) { search_.deferred.push_back(pair); });
    return false;
  }

  /// Takes the shortest difference of points for the direction and, unless only intersections are of interest, for an
  /// upper bound on the distance.
  HWY_INLINE void take_upper_bound(const LeafPair& pairs) {
    std::uint32_t sorted[k_pairs];
    if (sort_pairs(pairs_below(pairs.upper, shortest_), pairs.upper, sorted) == 0) return;
    const std::uint32_t least = sorted[0];
    shortest_ = pairs.upper[least];
    turn_to({difference_[0][least], difference_[1][least], difference_[2][least]});
    if (!only_intersection_) lower_best(shortest_ + frames_.slack.all + width_);
  }

  /// Moves the pairs with the smallest upper bounds, of those that may intersect or are below `improving`, from `pairs`
  /// to `taken` as far as there is space. Returns them.
  HWY_INLINE std::span<TrianglePair> take_improving(const Tree::Leaf& leaf_a, const Tree::Leaf& leaf_b, LeafPair& pairs,
                                                    float improving, std::span<TrianglePair> taken) const {
    const std::uint32_t bits =
        near_pairs(leaf_a, leaf_b, pairs) & (pairs_within(pairs.lower, 0.0f) | pairs_below(pairs.upper, improving));
    std::uint32_t sorted[k_pairs];
    taken = taken.first(std::min(sort_pairs(bits, pairs.upper, sorted), taken.size()));
    for (std::size_t k = 0; k < taken.size(); ++k) {
      taken[k] = pair_of(leaf_a.child.first(), leaf_b.child.first(), sorted[k]);
      pairs.lower[sorted[k]] = Tree::k_empty;
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
    bound_triangles(pairs, frames_.slack.all, best_, difference_);
    if (use_of_cross_edges_.is_due()) {
      const int before = std::popcount(near_pairs(leaf_a, leaf_b, pairs));
      if (before > 0) {
        bound_across_edges(pairs, frames_.slack.all, best_);
        use_of_cross_edges_.count(before, std::popcount(near_pairs(leaf_a, leaf_b, pairs)));
      }
    }
    return true;
  }

  /// Pairs of triangles (bits) whose bounds are not above the best.
  HWY_INLINE std::uint32_t near_pairs(const Tree::Leaf& leaf_a, const Tree::Leaf& leaf_b, const LeafPair& pairs) const {
    return pairs_of(leaf_a.child.count(), leaf_b.child.count()) & pairs_within(pairs.lower, best_);
  }

  /// Calls keep() for the pairs of triangles of two leaves whose bounds are not above the best.
  template <class Keep>
  HWY_INLINE void for_each_kept(const Tree::Leaf& leaf_a, const Tree::Leaf& leaf_b, const LeafPair& pairs,
                                const Keep& keep) {
    for (std::uint32_t bits = near_pairs(leaf_a, leaf_b, pairs); bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      keep(NodePair::of(pair_of(leaf_a.child.first(), leaf_b.child.first(), lane), pairs.lower[lane]));
    }
  }

  /// Expands two volumes that are not both leaves: calls keep() for each pair of volumes whose bound is not above the
  /// best.
  template <class Keep>
  HWY_INLINE void expand(const NodePair& top, const Keep& keep) {
    expansion_.expand(top, frames_, best_, search_.counts.nodes, keep);
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
        only_intersection_ || search_.ties.margin > 0.0 || search_.counts.triangles > k_triangles_before_gaps;
    return is_asked && prune(NodePair::of(pair, 0.0f), gap_of(search_, pair));
  }

  HWY_INLINE bool prune_by_planes(const NodePair& pair) { return has_planes_ && prune_by_their_planes(pair); }

  HWY_NOINLINE bool prune_by_their_planes(const NodePair& pair) {
    const CoplanarPatches::Plane* plane_a = search_.a.patches.of(pair.a);
    const CoplanarPatches::Plane* plane_b = search_.b.patches.of(pair.b);
    if (!plane_a || !plane_b) return false;
    const double gap =
        plane_gap(*plane_a, volume_of(tree_a_, pair.a), *plane_b, volume_of(tree_b_, pair.b), frames_.R, frames_.shift);
    return prune(pair, gap - search_.ties.error);
  }

  /// The pairs of children of volumes, or of triangles of leaves, whose bounds are not above the best.
  void split(const NodePair& pair, std::vector<NodePair>& parts) {
    const auto keep = [&parts](const NodePair& part) { parts.push_back(part); };
    if (!is_leaf(pair.a) || !is_leaf(pair.b)) return expand(pair, keep);
    const Tree::Leaf& leaf_a = leaf_of(tree_a_, pair.a);
    const Tree::Leaf& leaf_b = leaf_of(tree_b_, pair.b);
    LeafPair pairs;
    if (bound_pairs(leaf_a, leaf_b, pairs)) for_each_kept(leaf_a, leaf_b, pairs, keep);
  }

  DistanceSearch& search_;
  const Tree& tree_a_;
  const Tree& tree_b_;
  const bool only_intersection_;
  QueryFrames frames_;
  const float blurred_;      // square of a diagonal: of the largest volume that floats blur
  const bool blurs_leaves_;  // both trees have leaves that small
  const bool has_planes_;    // both meshes have coplanar patches
  const float width_;        // search_.ties.width, rounded up
  const CloseBounds close_bounds_;
  PairExpansion expansion_;
  CrossAxesUse use_of_cross_edges_ = k_use_of_cross_edges;
  std::uint64_t thick_pairs_ = 0;
  std::uint64_t doubtful_pairs_ = 0;
  std::uint64_t near_pairs_ = 0, next_corner_ = k_pairs_before_corners;
  std::size_t corners_asked_ = 0;
  HWY_ALIGN float difference_[3][k_pairs];                   // of points of the triangles that bound_pairs() left
  float shortest_ = std::numeric_limits<float>::infinity();  // of the differences so far
  float best_ = std::numeric_limits<float>::infinity();      // search_.best, or less, + search_.ties.width, rounded up
  float doubtful_;                                           // bounds above this may exceed the best but for rounding
  TiePruning tie_pruning_ = TiePruning::planes;
};

void find_pair(DistanceSearch& search, bool only_intersection) { DistanceTraversal(search, only_intersection).run(); }

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::detail {

HWY_EXPORT(find_pair);

void find_pair(DistanceSearch& search, bool only_intersection) {
  HWY_DYNAMIC_DISPATCH(find_pair)(search, only_intersection);
}

}  // namespace sixdof::detail
#endif  // HWY_ONCE
