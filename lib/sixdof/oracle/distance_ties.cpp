#include <sixdof/oracle/distance_ties.h>

#include <algorithm>
#include <utility>

namespace sixdof::detail {
namespace {

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

/// The smallest rank that a pair of triangles in `pair` can have.
Rank smallest_rank(const DistanceSearch& search, const NodePair& pair) {
  if (pair.is_of_triangles()) return rank_of(search, pair.triangles());
  return {search.a.patches.smallest_index(pair.a), search.b.patches.smallest_index(pair.b)};
}

}  // namespace

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

bool resolve_ties(DistanceSearch& search, const SplitPair& split) {
  std::erase_if(search.tied, [&](const TiedPair& x) { return x.lower > search.best + search.ties.width; });
  FirstOfTies first(search);
  for (const MeasuredPair& x : search.measured) first.update(x);
  std::vector<RankedPair>& heap = search.ranked;
  const auto later = [](const RankedPair& x, const RankedPair& y) { return x.smallest > y.smallest; };
  const auto push = [&](const NodePair& pair) {
    const Rank smallest = smallest_rank(search, pair);
    if (smallest >= first.rank) return;
    heap.push_back({smallest, pair});
    std::push_heap(heap.begin(), heap.end(), later);
  };
  heap.clear();
  for (const TiedPair& x : search.tied) push(x.pair);
  while (!heap.empty() && heap.front().smallest < first.rank) {
    const NodePair top = heap.front().pair;
    std::pop_heap(heap.begin(), heap.end(), later);
    heap.pop_back();
    if (top.is_of_triangles()) {
      ++search.counts.triangles;
      first.update({top.triangles(), distance_of(search, top.triangles()).distance});
      continue;
    }
    search.stack.clear();
    split(top, search.stack);
    for (const NodePair& part : search.stack) push(part);
  }
  if (first.uncertain < first.rank) return false;
  if (std::pair(first.pair.a, first.pair.b) != std::pair(search.pair.a, search.pair.b)) {
    search.pair = first.pair;
    search.closest.reset();
  }
  return true;
}

}  // namespace sixdof::detail
