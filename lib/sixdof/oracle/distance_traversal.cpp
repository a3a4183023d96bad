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

float rounded_up(double x) {
  return std::nextafter(static_cast<float>(std::min(x, 1e30)), std::numeric_limits<float>::infinity());
}

/// The pair of the lowest rank among those whose distances count as equal to the smallest.
struct FirstOfTies {
  Traversal& traversal;
  double sure;                // counts as equal for certain
  double at_most;             // does not for certain beyond this
  Rank rank = k_no_rank;      // of `pair`
  Rank doubtful = k_no_rank;  // lowest of those in between
  TrianglePair pair{};

  explicit FirstOfTies(Traversal& t) : traversal(t), sure(t.best + t.ties.width), at_most(sure) {
    for (const TiedPair& x : t.tied) sure = std::min(sure, x.lower + t.ties.width);
  }

  void offer(const MeasuredPair& x) {
    if (x.distance > at_most) return;
    const Rank offered = rank_of(traversal, x.pair);
    if (x.distance > sure) {
      doubtful = std::min(doubtful, offered);
    } else if (offered < rank) {
      rank = offered;
      pair = x.pair;
    }
  }
};

/// What may be left alone because it can only tie: parts between planes; pairs of triangles, whose bounds are closer to
/// their distances; or nothing.
enum class Cuts {
  planes,
  triangles,
  sure
};

struct Descent {
  Traversal& traversal;
  const Tree& tree_a;
  const Tree& tree_b;
  const bool only_intersection;
  Frames frames;
  float best;  // cut-off, rounded up
  Cuts cuts = Cuts::planes;

  Descent(Traversal& t, bool intersection)
      : traversal(t), tree_a(*t.a), tree_b(*t.b), only_intersection(intersection), frames(tree_a, tree_b, t.X_AB) {
    if (traversal.direction.squaredNorm() == 0.0) traversal.direction = frames.shift;
    frames.look_along(traversal.direction);
    set_best();
  }

  void set_best() { best = only_intersection ? 0.0f : rounded_up(traversal.best + traversal.ties.width); }

  /// Bounds for all pairs of triangles of two leaves. Returns false if none can be close enough.
  bool bound_pairs(const Tree::Leaf& leaf_a, const Tree::Leaf& leaf_b, LeafPair& pairs) {
    ++traversal.counts.leaf_pairs;
    if (!bound_toward(leaf_a, leaf_b, frames.open_a, frames.slack, best, pairs.bounds)) return false;
    lay_out(leaf_a, leaf_b, frames.open_a, pairs);
    bound_triangles(pairs, frames.slack.far, best);
    return true;
  }

  /// Exact test of two triangles. Returns true if the search is over.
  bool measure(TrianglePair pair) {
    if (cut({OpenPair::k_triangle + pair.a, OpenPair::k_triangle + pair.b, 0.0f}, gap_of(traversal, pair)))
      return false;
    ++traversal.counts.triangles;
    if (only_intersection) {
      if (!intersects(traversal, pair)) return false;
      traversal.found = true;
      traversal.pair = pair;
      return true;
    }
    if (offer_pair(traversal, pair)) {
      if (traversal.best == 0.0) return true;
      traversal.direction = traversal.closest.on_b - traversal.closest.on_a;
      frames.look_along(traversal.direction);
      set_best();
    }
    return false;
  }

  /// Pairs of triangles of two leaves. Returns true if the search is over.
  bool measure_leaves(const OpenPair& leaves) {
    const Tree::Leaf& leaf_a = leaf_of(tree_a, leaves.a);
    const Tree::Leaf& leaf_b = leaf_of(tree_b, leaves.b);
    LeafPair pairs;
    if (!bound_pairs(leaf_a, leaf_b, pairs)) return false;
    // Pairs that certainly improve on the best, or that may intersect, are measured now, the most promising first. The
    // others wait: most of them will have become irrelevant. Between flat parts that are not yet known to tie, the
    // first distance will show that the rest do.
    const bool flat = plane_of(*traversal.flats_a, leaves.a) && plane_of(*traversal.flats_b, leaves.b);
    const float promising = flat ? best + frames.slack.far : best;
    for (;;) {
      std::uint32_t next = LeafPair::k_pairs;
      for (std::uint32_t i = 0; i < leaf_a.child.count(); ++i) {
        for (std::uint32_t j = 0; j < leaf_b.child.count(); ++j) {
          const std::uint32_t lane = k_leaf * i + j;
          if (pairs.bounds[lane] > best || (pairs.bounds[lane] > 0.0f && pairs.reached[lane] >= promising)) continue;
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
    for (const Cuts next : {Cuts::planes, Cuts::triangles, Cuts::sure}) {
      cuts = next;
      traversal.tied.clear();
      if (search() || only_intersection || settle_ties()) return;
    }
  }

  /// Returns true if the search is over: the surfaces meet.
  bool search() {
    traversal.deferred.clear();
    if (descend()) return true;
    std::vector<DeferredPair>& rest = traversal.deferred;
    std::erase_if(rest, [this](const DeferredPair& x) { return x.lower > best; });
    std::sort(rest.begin(), rest.end(), [](const DeferredPair& x, const DeferredPair& y) { return x.lower < y.lower; });
    for (const DeferredPair& x : rest) {
      if (x.lower > best) return false;
      if (measure(x.pair)) return true;
    }
    return false;
  }

  /// Asks for what the next steps will read: large trees are not in the caches, and a step is short against a miss.
  static HWY_INLINE void prefetch(const Tree& tree, const Tree::Node& node, std::size_t i) {
    const bool leaf = node.child[i].is_leaf();
    const char* at = leaf ? reinterpret_cast<const char*>(&tree.leaves()[node.leaf[i]])
                          : reinterpret_cast<const char*>(&tree.nodes()[node.child[i].node()]);
    const std::size_t bytes = leaf ? sizeof(Tree::Leaf) : sizeof(Tree::Node);
    for (std::size_t byte = 0; byte < bytes; byte += k_cache_line) hwy::Prefetch(at + byte);
  }

  static bool is_leaf(std::uint32_t volume) { return (volume & OpenPair::k_leaf) != 0; }
  static bool is_triangle(std::uint32_t volume) { return !is_leaf(volume) && (volume & OpenPair::k_triangle) != 0; }
  static TrianglePair triangles_of(const OpenPair& pair) {
    return {pair.a - OpenPair::k_triangle, pair.b - OpenPair::k_triangle};
  }
  static const Tree::Leaf& leaf_of(const Tree& tree, std::uint32_t volume) {
    return tree.leaves()[volume - OpenPair::k_leaf];
  }
  static const Tree::Volume& volume_of(const Tree& tree, std::uint32_t volume) {
    return is_leaf(volume) ? leaf_of(tree, volume).volume : tree.nodes()[volume].volume;
  }
  static const Flats::Plane* plane_of(const Flats& flats, std::uint32_t volume) {
    return is_leaf(volume) ? flats.of_leaf(volume - OpenPair::k_leaf) : flats.of_node(volume);
  }

  /// Whether a pair whose distance is at least `lower`, up to no rounding, needs no look: it is no closer than the
  /// best. If it may tie it is kept in `tied`.
  bool cut(const OpenPair& pair, double lower) {
    if (!(lower > 0.0)) return false;  // they may meet
    if (only_intersection) return true;
    const TieWindow& ties = traversal.ties;
    if (lower > traversal.best + ties.width) return true;
    if (cuts == Cuts::sure || !(lower > traversal.best - ties.margin)) return false;
    traversal.tied.push_back({pair, lower});
    return true;
  }

  bool cut_by_planes(const OpenPair& pair) {
    const Flats::Plane* plane_a = plane_of(*traversal.flats_a, pair.a);
    const Flats::Plane* plane_b = plane_of(*traversal.flats_b, pair.b);
    if (!plane_a || !plane_b) return false;
    const double gap =
        plane_gap(*plane_a, volume_of(tree_a, pair.a), *plane_b, volume_of(tree_b, pair.b), frames.R, frames.shift);
    return cut(pair, gap - traversal.ties.error);
  }

  /// Opens the larger of two volumes, not both leaves, and hands on each pair of a child and the other volume whose
  /// bound is not above the best.
  template <class Keep>
  HWY_INLINE void open_larger(const OpenPair& top, const Keep& keep) {
    const Tree::Volume& volume_a = volume_of(tree_a, top.a);
    const Tree::Volume& volume_b = volume_of(tree_b, top.b);
    const bool opens_a = is_leaf(top.b) || (!is_leaf(top.a) && size_of(volume_a) >= size_of(volume_b));
    const Tree::Node& node = opens_a ? tree_a.nodes()[top.a] : tree_b.nodes()[top.b];
    const Frame& frame = opens_a ? frames.open_a : frames.open_b;
    HWY_ALIGN float bounds[k_width];
    ++traversal.counts.nodes;
    unsigned kept =
        bound_children(node, Fixed(opens_a ? volume_b : volume_a, frame), frame, frames.slack, best, bounds);
    for (; kept != 0; kept &= kept - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(kept));
      OpenPair next{top.a, top.b, bounds[i]};
      (opens_a ? next.a : next.b) = node.child[i].is_leaf() ? OpenPair::k_leaf + node.leaf[i] : node.child[i].node();
      prefetch(opens_a ? tree_a : tree_b, node, i);
      keep(next);
    }
  }

  /// Returns true if the search is over.
  bool descend() {
    std::vector<OpenPair>& open = traversal.open;
    open.assign(1, {0, 0, -Tree::k_empty});
    while (!open.empty()) {
      const OpenPair top = open.back();
      open.pop_back();
      if (top.lower > best || (cuts == Cuts::planes && cut_by_planes(top))) continue;
      if (is_leaf(top.a) && is_leaf(top.b)) {
        if (measure_leaves(top)) return true;
        continue;
      }
      const std::size_t first = open.size();
      open_larger(top, [&](const OpenPair& next) {
        std::size_t at = open.size();
        open.push_back(next);
        for (; at > first && open[at - 1].lower < next.lower; --at) open[at] = open[at - 1];
        open[at] = next;
      });
    }
    return false;
  }

  /// Lowest rank that a pair of triangles in `pair` can have.
  Rank lowest_in(const OpenPair& pair) const {
    if (is_triangle(pair.a)) return rank_of(traversal, triangles_of(pair));
    const auto lowest = [](const Flats& flats, std::uint32_t volume) {
      return is_leaf(volume) ? flats.lowest_of_leaf(volume - OpenPair::k_leaf) : flats.lowest_of_node(volume);
    };
    return {lowest(*traversal.flats_a, pair.a), lowest(*traversal.flats_b, pair.b)};
  }

  /// Takes the first, by rank, of the pairs whose distances count as equal to the smallest: of those measured, and of
  /// those that were left alone. Returns false if it cannot tell: these may hold a smaller distance, and whether a pair
  /// of low rank counts as equal depends on it.
  bool settle_ties() {
    std::erase_if(traversal.tied, [&](const TiedPair& x) { return x.lower > traversal.best + traversal.ties.width; });
    if (!traversal.found) return traversal.tied.empty();  // not even the upper bound was reached
    FirstOfTies first(traversal);
    for (const MeasuredPair& x : traversal.measured) first.offer(x);
    std::vector<RankedPair>& open = traversal.ranked;
    const auto later = [](const RankedPair& x, const RankedPair& y) { return x.lowest > y.lowest; };
    const auto push = [&](const OpenPair& pair) {
      const Rank lowest = lowest_in(pair);
      if (lowest >= first.rank) return;
      open.push_back({lowest, pair});
      std::push_heap(open.begin(), open.end(), later);
    };
    open.clear();
    for (const TiedPair& x : traversal.tied) push(x.pair);
    while (!open.empty() && open.front().lowest < first.rank) {
      const OpenPair top = open.front().pair;
      std::pop_heap(open.begin(), open.end(), later);
      open.pop_back();
      if (is_triangle(top.a)) {
        ++traversal.counts.triangles;
        first.offer({triangles_of(top), distance_of(traversal, triangles_of(top)).distance});
      } else if (is_leaf(top.a) && is_leaf(top.b)) {
        open_leaves(leaf_of(tree_a, top.a), leaf_of(tree_b, top.b), push);
      } else {
        open_larger(top, push);
      }
    }
    if (first.doubtful < first.rank) return false;
    if (std::pair(first.pair.a, first.pair.b) != std::pair(traversal.pair.a, traversal.pair.b)) {
      traversal.pair = first.pair;
      traversal.closest = distance_of(traversal, first.pair);
    }
    return true;
  }

  /// Hands on the pairs of triangles of two leaves whose bounds are not above the best.
  template <class Keep>
  void open_leaves(const Tree::Leaf& leaf_a, const Tree::Leaf& leaf_b, const Keep& keep) {
    LeafPair pairs;
    if (!bound_pairs(leaf_a, leaf_b, pairs)) return;
    for (std::uint32_t i = 0; i < leaf_a.child.count(); ++i) {
      for (std::uint32_t j = 0; j < leaf_b.child.count(); ++j) {
        const float bound = pairs.bounds[k_leaf * i + j];
        if (bound > best) continue;
        keep(OpenPair{OpenPair::k_triangle + leaf_a.child.first() + i, OpenPair::k_triangle + leaf_b.child.first() + j,
                      bound});
      }
    }
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

namespace {

TriangleCorners moved_corners(const Traversal& traversal, std::uint32_t b) {
  const Tree::Corners& corners = traversal.b->corners()[b];
  return {traversal.X_AB * corners[0], traversal.X_AB * corners[1], traversal.X_AB * corners[2]};
}

}  // namespace

TieWindow TieWindow::of(const Tree& a, const Flats& flats_a, const Tree& b, const Flats& flats_b, const Pose& X_AB) {
  if (flats_a.empty() || flats_b.empty()) return {};
  // Heights of corners over planes round by a dozen units in the last place of the radii at most; turning a normal and
  // moving a corner, by a dozen more; a triangle's distance by k_triangle_distance_error times its size. Where offsets
  // enter it is by the moved corners and the centres alone.
  const Eigen::Vector3d shift = X_AB * b.center() - a.center();
  const double error = 4e-15 * (a.radius() + b.radius() + shift.norm()) +
                       1.5e-15 * (a.center().norm() + b.center().norm() + X_AB.t.norm());
  // Where two planes tie, a bound comes that close to every distance: it is lowered by the error, and may be off by as
  // much. Distances of ties differ by less than the error.
  return {.error = error, .margin = 2.0 * error, .width = 3.0 * error};
}

Rank rank_of(const Traversal& traversal, TrianglePair pair) {
  return {traversal.a->mesh_triangle()[pair.a], traversal.b->mesh_triangle()[pair.b]};
}

ClosestPoints distance_of(const Traversal& traversal, TrianglePair pair) {
  return triangle_triangle_distance(traversal.a->corners()[pair.a], moved_corners(traversal, pair.b));
}

double gap_of(const Traversal& traversal, TrianglePair pair) {
  return triangle_gap(traversal.a->corners()[pair.a], moved_corners(traversal, pair.b));
}

bool intersects(const Traversal& traversal, TrianglePair pair) {
  return triangles_intersect(traversal.a->corners()[pair.a], moved_corners(traversal, pair.b));
}

bool offer_pair(Traversal& traversal, TrianglePair pair) {
  const ClosestPoints closest = distance_of(traversal, pair);
  if (closest.distance > traversal.best + traversal.ties.width) return false;
  traversal.measured.push_back({pair, closest.distance});
  if (closest.distance > traversal.best || (traversal.found && closest.distance == traversal.best)) return false;
  const bool closer = closest.distance < traversal.best;
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
