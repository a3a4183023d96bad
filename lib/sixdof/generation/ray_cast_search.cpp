#include <sixdof/generation/ray_cast_search.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include <sixdof/generation/ray_cast_pair.h>
#include <sixdof/generation/ray_cast_seeds.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/generation/ray_cast_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/generation/ray_cast_bounds-inl.h>

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
/// their triangles: on smooth surfaces they halve the number of expanded nodes. Of 0, 2, 4, 8 .. 64, 16 is the fastest.
constexpr std::uint64_t k_budget = 16;

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

  /// Whether the slabs of two children tie with the best hit or are farther apart.
  bool slabs_tie(std::uint32_t a, std::uint32_t b) const {
    return a != CastVolume::k_root && b != CastVolume::k_root && ray_cast::slabs_tie(cast_, a, b);
  }

  /// Counts a pair that single-precision bounds did not cull.
  void count_pair() { ++pairs_; }

  /// Takes the larger of two flat volumes for cast.patch if it is larger than that.
  /// @param size_a, size_b squared diagonals
  void note_patch(std::uint32_t a, float size_a, std::uint32_t b, float size_b) {
    if (!cast_.best.pair || a == CastVolume::k_root || b == CastVolume::k_root) return;
    const bool larger_a = size_a >= size_b;
    const CastTree& tree = larger_a ? cast_.a : cast_.b;
    const std::uint32_t larger = larger_a ? a : b;
    const float size = std::max(size_a, size_b);
    if (size <= cast_.patch.size && cast_.patch.is_facing(cast_.best.axis, cast_.direction)) return;
    const Eigen::Vector3d normal = tree.slab(larger).normal;
    const CoplanarPatch patch{normal.dot(cast_.direction) < 0.0 ? Eigen::Vector3d(-normal) : normal, size};
    if (patch.is_facing(cast_.best.axis, cast_.direction)) cast_.patch = patch;
  }

  /// Whether two subtrees are separated by the target, up to half a tie: along the patch's normal, or along
  /// best.separating_axis, each tested only when it is due; where both are unresolved, by separated_in_double(). Half a
  /// tie is more than the rounding of this test and of try_update(), so that what is culled here is no hit that
  /// try_update() would take. While there is no hit to stand for it, a tie is not culled.
  /// @param a, b slots of children
  /// @param size the larger of their squared diagonals
  /// @param set_bound called with gap and slope if the gap is more than the rounding of single precision; otherwise a
  /// smaller target tests the pair again
  template <class SetBound>
  bool separated(std::uint32_t a, std::uint32_t b, float size, const SetBound& set_bound) {
    if (a == CastVolume::k_root || b == CastVolume::k_root) return false;
    const float unresolved = k_unresolved * ray_.slack;
    if (size <= unresolved * unresolved && separated_in_double(cast_, a, b)) return true;
    const auto separates = [&](DifferenceSupport& support, const Eigen::Vector3d& axis, Backoff& backoff) {
      const double slope = axis.dot(cast_.direction);
      if (slope < 0.0) return false;
      const double gap = cast_.best.translation * slope + support.support_value(a, b, axis, k_budget) - cast_.target;
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

/// The whole tree.
constexpr CastVolume k_root{CastVolume::k_root, CastChild::node(0)};

class DualTreeTraversal {
 public:
  explicit DualTreeTraversal(Cast& cast)
      : cast_(cast), front_(cast.front), tree_a_(cast.a), tree_b_(cast.b), ray_(cast), ties_(cast, ray_) {}

  void run() {
    if (cast_.target > front_.target) front_.clear();  // its bounds hold for translations up to that of its last target
    const bool grown =
        static_cast<double>(front_.expansions.size()) > k_largest_growth * static_cast<double>(front_.initial_size);
    if (cast_.target != front_.target && grown) front_.clear();
    front_.target = cast_.target;
    front_.pending.clear();
    if (front_.expansions.empty()) {
      expand_larger({k_root, k_root});
      process_pending();
      front_.initial_size = front_.expansions.size();
    } else {
      find_uncovered();
      expand_uncovered();
    }
  }

 private:
  /// A pair of volumes.
  struct VolumePair {
    CastVolume a, b;
  };

  static VolumePair pair_of(const CastFront::Expansion& expansion, std::uint32_t lane, CastChild child) {
    const CastVolume own{static_cast<std::uint32_t>(expansion.node * k_width + lane), child};
    return expansion.expands_a ? VolumePair{own, expansion.other} : VolumePair{expansion.other, own};
  }

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

  /// The least of an expansion's bounds.
  float least_gap(std::uint32_t expansion) const {
    const CastFront::AxisBounds& bounds = front_.bounds[expansion];
    V least = set(CastFront::k_not_in_front);
    for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
      const V slope = load(bounds.slope + i);
      least = hn::Min(least, unfused_mul_add(slope, set(ray_.translation), load(bounds.offset + i)));
    }
    return hn::GetLane(hn::MinOfLanes(k_lanes, least));
  }

  /// Whether a pair that single-precision bounds do not cull is separated in double precision.
  bool separated(const CastFront::Pending& child, VolumePair pair) {
    return ties_.separated(pair.a.slot, pair.b.slot, child.size,
                           [&](float gap, float slope) { set_bound(child, gap, slope); });
  }

  /// Expands the larger of two volumes, or the one that is no leaf.
  void expand_larger(VolumePair pair) {
    const CastChild a = pair.a.child, b = pair.b.child;
    const bool expands_a =
        b.is_leaf() || (!a.is_leaf() && tree_a_.volume(a).squared_diagonal() >= tree_b_.volume(b).squared_diagonal());
    const std::uint32_t index = (expands_a ? a : b).index();
    front_.expansions.push_back({index, expands_a ? pair.b : pair.a, expands_a});
    CastFront::AxisBounds& bounds = front_.bounds.emplace_back();
    const std::uint32_t count = (expands_a ? tree_a_ : tree_b_).nodes()[index].child_count;
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
    const CastTree& tree = from.expands_a ? tree_a_ : tree_b_;
    const CastTree& other = from.expands_a ? tree_b_ : tree_a_;
    const Tree::Node& node = tree.nodes()[from.node];
    const Tree::Volume& fixed_volume = other.volume(from.other.child);
    if (!from.other.child.is_leaf()) prefetch(other.nodes()[from.other.child.index()]);
    VolumeBounds found;
    bound_children(node, fixed_volume, from.expands_a, ray_, expanded_, fixed_, found);
    std::uint32_t left = raise_bounds(front_.bounds[expansion], node.child_count, found);
    std::vector<CastFront::Pending>& pending = front_.pending;
    const std::size_t first = pending.size();
    const float fixed_size = fixed_volume.squared_diagonal();
    const bool fixed_flat = is_flat(fixed_volume.slab_lower, fixed_volume.slab_upper);
    for (; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
      const float size = squared_diagonal(node, lane);
      const bool flat = fixed_flat && is_flat(node.slab_lower[lane], node.slab_upper[lane]);
      const float error = flat ? k_flat_error * 0.5f * (std::sqrt(size) + std::sqrt(fixed_size)) : 0.0f;
      const bool near = found.gap[lane] > ray_.target - 2.0f * ray_.slack - error;
      ties_.count_pair();
      const CastChild child = child_of(node, lane);
      const VolumePair pair = pair_of(from, lane, child);
      if (near && flat) {
        if (ties_.slabs_tie(pair.a.slot, pair.b.slot)) continue;
        const float size_a = from.expands_a ? size : fixed_size, size_b = from.expands_a ? fixed_size : size;
        ties_.note_patch(pair.a.slot, size_a, pair.b.slot, size_b);
      }
      const CastFront::Pending next{expansion, lane, child, found.projection[lane], std::max(size, fixed_size)};
      if (separated(next, pair)) continue;
      child.is_leaf() ? prefetch(tree.leaves()[child.index()]) : prefetch(tree.nodes()[child.index()]);
      std::size_t at = pending.size();
      pending.push_back(next);
      for (; at > first && pending[at - 1].projection < next.projection; --at) pending[at] = pending[at - 1];
      pending[at] = next;
    }
  }

  /// Whether a slab is so thin that it may tie with one that faces it.
  bool is_flat(float slab_lower, float slab_upper) const { return slab_upper - slab_lower <= 2.0f * ray_.slack; }

  static float squared_diagonal(const Tree::Node& node, std::size_t lane) {
    float squared = 0.0f;
    for (std::size_t k = 0; k < 3; ++k) {
      const float side = node.upper[k][lane] - node.lower[k][lane];
      squared += side * side;
    }
    return squared;
  }

  /// Replaces bounds by those found where these are larger.
  /// @param count children of the node
  /// @return bits of the lanes that no bound culls
  std::uint32_t raise_bounds(CastFront::AxisBounds& bounds, std::uint32_t count, const VolumeBounds& found) const {
    std::uint32_t left = 0;
    for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
      const V offset = load(bounds.offset + i);
      const V slope = load(bounds.slope + i);
      const V known = unfused_mul_add(slope, set(ray_.translation), offset);
      const V gap = load(found.gap + i);
      const V new_slope = load(found.slope + i);
      const V new_offset = unfused_sub_mul(gap, new_slope, set(ray_.translation));
      const M raises = hn::And(hn::Gt(gap, known), hn::FirstN(k_lanes, count > i ? count - i : 0));
      hn::Store(hn::IfThenElse(raises, new_offset, offset), k_lanes, bounds.offset + i);
      hn::Store(hn::IfThenElse(raises, new_slope, slope), k_lanes, bounds.slope + i);
      left |= bits_of(hn::Le(hn::Max(gap, known), set(ray_.target)), i);
    }
    return left;
  }

  void process_pending() {
    while (!front_.pending.empty()) {
      const CastFront::Pending top = front_.pending.back();
      front_.pending.pop_back();
      const float gap = gap_of(top);
      if (gap > ray_.target) continue;  // the best hit may have changed since
      const VolumePair pair = pair_of(front_.expansions[top.expansion], top.lane, top.child);
      if (separated(top, pair)) continue;
      if (pair.a.child.is_leaf() && pair.b.child.is_leaf()) {
        expand_leaves(pair.a.child.index(), pair.b.child.index(), top);
      } else {
        set_bound(top, CastFront::k_not_in_front, 0.0f);
        expand_larger(pair);
      }
    }
  }

  /// Sets the bound of two leaves, and updates the best hit by those of their pairs of triangles that it does not cull.
  void expand_leaves(std::uint32_t a, std::uint32_t b, const CastFront::Pending& pending) {
    ++cast_.counts.leaf_pairs;
    const Tree::Leaf& leaf_a = tree_a_.leaves()[a];
    const Tree::Leaf& leaf_b = tree_b_.leaves()[b];
    const LeafBounds bounds = bound_leaves(leaf_a, leaf_b, ray_);
    set_bound(pending, bounds.gap, bounds.slope);
    for (std::size_t n = 0; n < bounds.count; ++n) {
      const std::uint32_t i = bounds.pairs[n] / k_leaf;
      const std::uint32_t j = bounds.pairs[n] % k_leaf;
      if (try_update(cast_, {leaf_a.child.first() + i, leaf_b.child.first() + j})) {
        ray_.set_best(cast_);
      } else {
        ties_.count_pair();
      }
    }
  }

  void find_uncovered() {
    front_.uncovered.clear();
    const V enough = set(ray_.target);
    const V translation = set(ray_.translation);
    const auto count = static_cast<std::uint32_t>(front_.expansions.size());
    for (std::uint32_t expansion = 0; expansion < count; ++expansion) {
      const CastFront::AxisBounds& bounds = front_.bounds[expansion];
      bool culled = true;
      for (std::size_t i = 0; i < k_width; i += hn::Lanes(k_lanes)) {
        const V value = unfused_mul_add(load(bounds.slope + i), translation, load(bounds.offset + i));
        culled = culled && hn::AllTrue(k_lanes, hn::Gt(value, enough));
      }
      if (!culled) front_.uncovered.push_back(expansion);
    }
  }

  /// Expands all that is uncovered: the few with the least gaps first, for as long as they improve the best hit.
  void expand_uncovered() {
    std::vector<std::uint32_t>& all = front_.uncovered;
    double before = -1.0;
    while (!all.empty()) {
      if (cast_.best.translation != before) {
        before = cast_.best.translation;
        expand_few_uncovered();
      } else {
        const std::uint32_t expansion = all.back();
        all.pop_back();
        expand(expansion);
        process_pending();
      }
    }
  }

  /// Expands the few that are uncovered by most, and drops those that no longer are uncovered.
  void expand_few_uncovered() {
    constexpr std::size_t k_few = 8;
    struct {
      float gap;
      std::uint32_t expansion;
    } least[k_few];  // ascending
    std::size_t few = 0;
    std::size_t left = 0;
    std::vector<std::uint32_t>& all = front_.uncovered;
    for (const std::uint32_t expansion : all) {
      const float gap = least_gap(expansion);
      if (gap > ray_.target) continue;
      if (few == k_few && gap >= least[k_few - 1].gap) {
        all[left++] = expansion;
        continue;
      }
      if (few == k_few) all[left++] = least[--few].expansion;
      std::size_t at = few++;
      for (; at > 0 && least[at - 1].gap > gap; --at) least[at] = least[at - 1];
      least[at] = {gap, expansion};
    }
    all.resize(left);
    for (std::size_t i = 0; i < few; ++i) {
      if (i > 0 && least_gap(least[i].expansion) > ray_.target) continue;
      expand(least[i].expansion);
      process_pending();
    }
  }

  Cast& cast_;
  CastFront& front_;
  const CastTree& tree_a_;
  const CastTree& tree_b_;
  Ray ray_;
  TieTests ties_;
  Volumes expanded_, fixed_;  // scratch of expand()
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

void RaySearch::clear() {
  cast_.clear();
  last_ray_.clear();
}

void RaySearch::start_ray(const Eigen::Vector3d& direction, std::size_t targets) {
  cast_.direction = direction;
  cast_.front.clear();
  last_.reset();
  last_ray_.resize(targets);
  next_ = 0;
  reachable_ = true;
}

const Hit* RaySearch::find_next(double target) {
  const std::size_t index = next_++;
  if (!reachable_) return nullptr;  // a larger target has no hit, so this has none
  cast_.target = target;
  search_from(-k_cast_tie * cast_.size(), cast_.direction);
  if (last_) try_update(cast_, *last_->hit.pair);
  if (last_ray_[index]) try_update(cast_, *last_ray_[index]);
  if (!last_) seed_first_hit(cast_);
  if (!last_ || !find_behind(*last_)) find_first_hit(cast_);
  reachable_ = cast_.best.pair.has_value();
  if (!reachable_) return nullptr;
  last_ = {target, cast_.best};
  last_ray_[index] = cast_.best.pair;
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
