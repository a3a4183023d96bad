#include <sixdof/oracle/ray_cast_search.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include <sixdof/oracle/ray_cast_pair.h>
#include <sixdof/proximity/sorted_stack.h>

#include <sixdof/base/simd_targets.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/ray_cast_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/oracle/ray_cast_bounds-inl.h>

// Depth first: of the children of one expansion the one most likely to be hit first is next. Pairs of volumes wait on a
// stack, front.pending. Of two volumes the larger is expanded.

HWY_BEFORE_NAMESPACE();
namespace sixdof::ray_cast {
namespace HWY_NAMESPACE {

/// A front that has grown beyond this, in units of its size after the first target, is discarded. Expansions near the
/// hits of earlier targets are never undone otherwise.
constexpr double k_largest_growth = 2.0;

/// Error of single-precision bounds of flat patches that lie face to face, in units of half their diagonals: 1.3e-3 for
/// normals that are shorter than unit vectors, and as much again for the tilt of parts of a rough face.
constexpr float k_flat_error = 2e-3f;

/// What one query of a DifferenceSupport adds to its budget. Support values cull pairs because volumes reach beyond
/// their triangles: on smooth surfaces they halve the number of expanded nodes. Of 0, 2, 4, 8 .. 64, 16 is the fastest;
/// 15 instead takes 3 % more nodes and 4 % fewer evaluations where the flat faces of a box tie.
constexpr std::uint64_t k_budget = 15;

/// Diagonals of two boxes, in units of the slack, up to which they are bounded in double precision: bounds in
/// single precision do not tell their parts apart.
constexpr float k_unresolved = 4.0f;

/// Decides when a test is due: after ever more pairs while it fails, for each pair while it succeeds. `now` is the
/// number of pairs that single-precision bounds did not cull.
struct Backoff {
  static constexpr std::uint64_t k_first = 8;
  std::uint64_t last_success = 0;
  std::uint64_t next = k_first;

  bool due(std::uint64_t now) const { return now >= next; }
  void record(bool success, std::uint64_t now) {
    if (success) last_success = now;
    next = success ? now : now + 1 + (now - last_success) / 2;
  }
};

/// Tests of the pairs of volumes of one search.
class TieTests {
 public:
  TieTests(Cast& cast, const Ray& ray) : cast_(cast), ray_(ray), tie_(k_cast_tie * cast.size()) {}

  /// Counts a pair that single-precision bounds did not cull.
  void count_pair() { ++pairs_; }

  /// Takes a flat volume for cast.patch if it is larger than that.
  /// @param normal of its slab, in A's frame
  /// @param size squared diagonal
  void note_patch(const Eigen::Vector3d& normal, float size) {
    if (!cast_.best.pair) return;
    if (size <= cast_.patch.size && cast_.patch.is_facing(cast_.best.axis, cast_.direction)) return;
    const CoplanarPatch patch{normal.dot(cast_.direction) < 0.0 ? Eigen::Vector3d(-normal) : normal, size};
    if (patch.is_facing(cast_.best.axis, cast_.direction)) cast_.patch = patch;
  }

  /// Whether two subtrees are separated by the target, up to half a tie: along the patch's normal, or along
  /// best.separating_axis, each tested only when it is due; where both are unresolved, by separated_in_double(). Half a
  /// tie is more than the rounding of this test and of try_update(), so that what is culled here is no hit that
  /// try_update() would take. While there is no hit to stand for it, a tie is not culled.
  /// @param set_bound called with gap and slope if the gap is more than the rounding of single precision; otherwise a
  /// smaller target tests the pair again
  template <class SetBound>
  bool separated(const CastFront::Pending& pair, const SetBound& set_bound) {
    const float unresolved = k_unresolved * ray_.slack;
    if (pair.size <= unresolved * unresolved && separated_in_double(cast_, pair.a, pair.b)) return true;
    const auto separates = [&](DifferenceSupport& support, const Eigen::Vector3d& axis, Backoff& backoff) {
      const double slope = axis.dot(cast_.direction);
      if (slope < 0.0) return false;
      const double value = support.support_value(pair.a, pair.b, axis, k_budget);
      const double gap = cast_.best.translation * slope + axis.dot(cast_.offset) + value - cast_.target;
      const bool culled = gap >= (cast_.best.pair ? -0.5 * tie_ : 0.0);
      backoff.record(culled, pairs_);
      if (gap > static_cast<double>(ray_.slack)) {
        set_bound(static_cast<float>(cast_.target + gap) - ray_.slack, static_cast<float>(slope));
      }
      return culled;
    };
    if (patch_backoff_.due(pairs_) && cast_.patch.is_facing(cast_.best.axis, cast_.direction) &&
        separates(cast_.patch_support, cast_.patch.normal, patch_backoff_)) {
      return true;
    }
    return axis_backoff_.due(pairs_) && separates(cast_.axis_support, cast_.best.separating_axis, axis_backoff_);
  }

 private:
  Cast& cast_;
  const Ray& ray_;
  const double tie_;
  std::uint64_t pairs_ = 0;
  Backoff patch_backoff_, axis_backoff_;
};

class DualTreeTraversal {
 public:
  explicit DualTreeTraversal(Cast& cast)
      : cast_(cast),
        front_(cast.front),
        tree_a_(cast.a.tree()),
        tree_b_(cast.b.tree()),
        ray_(cast),
        ties_(cast, ray_),
        sides_(tree_a_, tree_b_) {}

  void run() {
    if (cast_.target > front_.target) front_.clear();  // its bounds hold for translations up to that of its last target
    const bool grown =
        static_cast<double>(front_.expansions.size()) > k_largest_growth * static_cast<double>(front_.initial_size);
    if (cast_.target != front_.target && grown) front_.clear();
    front_.target = cast_.target;
    front_.pending.clear();
    if (front_.expansions.empty()) {
      expand_larger(0, 0);
      process_pending();
      front_.initial_size = front_.expansions.size();
    } else {
      find_uncovered();
      expand_uncovered();
    }
  }

 private:
  /// @param gap at the translation of the best hit
  void set_bound(const CastFront::Pending& child, float gap, float slope) {
    CastFront::AxisBounds& bounds = front_.bounds[child.expansion];
    bounds.offset[child.lane] = gap - slope * ray_.translation;
    bounds.slope[child.lane] = slope;
  }

  /// A child's bound.
  float gap_of(const CastFront::Pending& child) const {
    const CastFront::AxisBounds& bounds = front_.bounds[child.expansion];
    return bounds.offset[child.lane] + bounds.slope[child.lane] * ray_.translation;
  }

  /// The bounds of the children i, i + 1, ... of an expansion.
  V gaps_of(const CastFront::AxisBounds& bounds, std::size_t i) const {
    return unfused_mul_add(load(bounds.slope + i), set(ray_.translation), load(bounds.offset + i));
  }

  /// The bounds of the children of an expansion, but for the larger ones.
  V least_gaps(std::uint32_t expansion) const {
    V least = set(CastFront::k_not_in_front);
    for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
      least = hn::Min(least, gaps_of(front_.bounds[expansion], i));
    }
    return least;
  }

  bool separated(const CastFront::Pending& pair) {
    return ties_.separated(pair, [&](float gap, float slope) { set_bound(pair, gap, slope); });
  }

  /// Expands the larger of two volumes, or the one that is no leaf.
  void expand_larger(std::uint32_t a, std::uint32_t b) {
    const bool expands_a = is_leaf(b) || (!is_leaf(a) && volume_of(tree_a_, a).squared_diagonal() >=
                                                             volume_of(tree_b_, b).squared_diagonal());
    front_.expansions.push_back({expands_a ? a : b, expands_a ? b : a, expands_a});
    CastFront::AxisBounds& bounds = front_.bounds.emplace_back();
    const std::uint32_t count = (expands_a ? tree_a_.nodes()[a] : tree_b_.nodes()[b]).child_count;
    for (std::uint32_t lane = 0; lane < k_width; ++lane) {
      bounds.offset[lane] = lane < count ? CastFront::k_no_bound : CastFront::k_not_in_front;
      bounds.slope[lane] = 0.0f;
    }
    expand(static_cast<std::uint32_t>(front_.expansions.size() - 1));
  }

  /// Bounds an expansion's children for the best hit. Children that are not culled become pending.
  void expand(std::uint32_t expansion) {
    ++cast_.counts.nodes;
    const CastFront::Expansion from = front_.expansions[expansion];
    Side<k_rounding>& x = from.expands_a ? sides_.a : sides_.b;
    Side<k_rounding>& y = from.expands_a ? sides_.b : sides_.a;
    const Frame& frame = from.expands_a ? ray_.frames.a : ray_.frames.b;
    const Frame& other = from.expands_a ? ray_.frames.b : ray_.frames.a;
    x.take<true>(from.node, true, frame, other);
    y.take<true>(from.other, false, other, frame);
    if (!is_leaf(from.other)) y.prefetch_child(from.other);
    VolumeBounds found;
    bound_volumes(x.volumes(), y.volumes(), 0, from.expands_a, ray_, found);
    const std::size_t first = front_.pending.size();
    for (std::uint32_t left = raise_bounds(front_.bounds[expansion], found); left != 0; left &= left - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
      const std::uint32_t child = x.child(lane);
      const float size = x.volumes().size[lane], size_y = y.volumes().size[0];
      ties_.count_pair();
      if (is_flat(x.volumes(), lane) && is_flat(y.volumes(), 0)) {
        const float error = k_flat_error * 0.5f * (std::sqrt(size) + std::sqrt(size_y));
        if (found.gap[lane] > ray_.target - 2.0f * ray_.slack - error) note_patch(from, lane, size);
      }
      const CastFront::Pending next{from.expands_a ? child : from.other,
                                    from.expands_a ? from.other : child,
                                    expansion,
                                    lane,
                                    found.order[lane],
                                    std::max(size, size_y)};
      if (separated(next)) continue;
      x.prefetch_child(child);
      detail::push_sorted(front_.pending, first, next);
    }
  }

  /// Whether a slab is so thin that it may tie with one that faces it.
  bool is_flat(const Volumes& x, std::size_t i) const { return x.above[i] - x.below[i] <= 2.0f * ray_.slack; }

  void note_patch(const CastFront::Expansion& from, std::size_t lane, float size) {
    const auto& normals = (from.expands_a ? cast_.a : cast_.b).precise_volumes()[from.node].normal;
    const Eigen::Vector3d normal(normals[0][lane], normals[1][lane], normals[2][lane]);
    ties_.note_patch(from.expands_a ? normal : Eigen::Vector3d(cast_.R * normal), size);
  }

  /// Replaces bounds by those found where these are larger.
  /// @return bits of the lanes that no bound culls
  std::uint32_t raise_bounds(CastFront::AxisBounds& bounds, const VolumeBounds& found) const {
    std::uint32_t left = 0;
    for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
      const V known = gaps_of(bounds, i), gap = load(found.gap + i), slope = load(found.slope + i);
      const V offset = unfused_sub_mul(gap, slope, set(ray_.translation));
      const M raises = hn::And(hn::Gt(gap, known), hn::Ne(known, set(CastFront::k_not_in_front)));
      hn::Store(hn::IfThenElse(raises, offset, load(bounds.offset + i)), k_lanes, bounds.offset + i);
      hn::Store(hn::IfThenElse(raises, slope, load(bounds.slope + i)), k_lanes, bounds.slope + i);
      left |= bits_of(hn::Le(hn::Max(gap, known), set(ray_.target)), i);
    }
    return left;
  }

  void process_pending() {
    while (!front_.pending.empty()) {
      const CastFront::Pending top = front_.pending.back();
      front_.pending.pop_back();
      if (gap_of(top) > ray_.target) continue;  // the best hit may have changed since
      if (separated(top)) continue;
      if (is_leaf(top.a) && is_leaf(top.b)) {
        expand_leaves(top);
      } else {
        set_bound(top, CastFront::k_not_in_front, 0.0f);
        expand_larger(top.a, top.b);
      }
    }
  }

  /// Sets the bound of two leaves, and updates the best hit by those of their pairs of triangles that it does not cull.
  void expand_leaves(const CastFront::Pending& pair) {
    ++cast_.counts.leaf_pairs;
    const Tree::Leaf& leaf_a = leaf_of(tree_a_, pair.a);
    const Tree::Leaf& leaf_b = leaf_of(tree_b_, pair.b);
    const LeafBounds bounds = bound_leaves(leaf_a, leaf_b, ray_);
    set_bound(pair, bounds.gap, bounds.slope);
    for (std::size_t n = 0; n < bounds.count; ++n) {
      const std::uint32_t i = bounds.pairs[n] / k_leaf;
      const std::uint32_t j = bounds.pairs[n] % k_leaf;
      if (try_update(cast_, {leaf_a.child.first() + i, leaf_b.child.first() + j})) {
        ray_.set_best(cast_);
        sides_.forget();
      } else {
        ties_.count_pair();
      }
    }
  }

  void find_uncovered() {
    front_.uncovered.clear();
    const auto count = static_cast<std::uint32_t>(front_.expansions.size());
    for (std::uint32_t expansion = 0; expansion < count; ++expansion) {
      const V least = least_gaps(expansion);
      if (hn::AllTrue(k_lanes, hn::Gt(least, set(ray_.target)))) continue;
      front_.uncovered.emplace_back(hn::GetLane(hn::MinOfLanes(k_lanes, least)), expansion);
    }
  }

  /// Expands all that is uncovered, the few with the least gaps first: they improve the best hit.
  void expand_uncovered() {
    constexpr std::ptrdiff_t k_few = 8;
    auto& all = front_.uncovered;
    std::partial_sort(all.begin(), all.begin() + std::min(k_few, std::ssize(all)), all.end());
    for (const auto& [gap, expansion] : all) {
      if (hn::AllTrue(k_lanes, hn::Gt(least_gaps(expansion), set(ray_.target)))) continue;
      expand(expansion);
      process_pending();
    }
  }

  Cast& cast_;
  CastFront& front_;
  const Tree& tree_a_;
  const Tree& tree_b_;
  Ray ray_;
  TieTests ties_;
  Expansion<k_rounding, true> sides_;
};

void find_first_hit(Cast& cast) { DualTreeTraversal(cast).run(); }

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ray_cast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::ray_cast {

namespace {

/// Length of the first interval in which a hit is searched for behind that of a larger target, in units of what the
/// slope of its distance predicts; and by what the interval grows.
constexpr double k_first_interval = 2.0;
constexpr double k_interval_growth = 2.0;

}  // namespace

HWY_EXPORT(find_first_hit);

void find_first_hit(Cast& cast) { HWY_DYNAMIC_DISPATCH(find_first_hit)(cast); }

void RaySearch::start_ray(const Eigen::Vector3d& direction, const Eigen::Vector3d& offset, double least) {
  cast_.direction = direction;
  cast_.offset = offset;
  cast_.least = least;
  cast_.front.clear();
  last_.reset();
  reachable_ = true;
}

const Hit* RaySearch::find_next(double target) {
  if (!reachable_) return nullptr;  // a larger target has no hit, so this has none
  cast_.target = target;
  search_from(cast_.least - k_cast_tie * cast_.size(), cast_.direction);
  if (last_) try_update(cast_, *last_->hit.pair);
  if (!last_ || !find_behind(*last_)) find_first_hit(cast_);
  reachable_ = cast_.best.pair.has_value();
  if (!reachable_) return nullptr;
  last_ = {target, cast_.best};
  return &cast_.best;
}

/// Resets the best hit: there is none, and only larger translations are of interest.
void RaySearch::search_from(double translation, const Eigen::Vector3d& axis) {
  cast_.best = {.translation = translation, .pair = {}, .axis = axis, .separating_axis = axis};
}

/// Searches growing intervals behind the hit of a larger target, as long as they do not reach the best hit. A hit is
/// usually a little behind, and a search from far behind expands much in vain.
/// @return whether there was a hit; if not, the best hit is unchanged
bool RaySearch::find_behind(const LastTarget& last) {
  const Hit guess = cast_.best;
  const double slope = last.hit.axis.dot(cast_.direction);
  // Equal targets predict 0, which could not grow.
  double interval = std::max(k_first_interval * (last.target - cast_.target) / slope, k_cast_tie * cast_.size());
  for (; last.hit.translation - interval > guess.translation; interval *= k_interval_growth) {
    search_from(last.hit.translation - interval, last.hit.axis);
    find_first_hit(cast_);
    if (cast_.best.pair) return true;
  }
  cast_.best = guess;
  return false;
}

}  // namespace sixdof::ray_cast
#endif  // HWY_ONCE
