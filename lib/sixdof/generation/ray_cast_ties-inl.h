// Compiled once per instruction set: part of ray_cast_traversal.cpp, included by nothing else.
#if defined(SIXDOF_GENERATION_RAY_CAST_TIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_GENERATION_RAY_CAST_TIES_INL_H_
#undef SIXDOF_GENERATION_RAY_CAST_TIES_INL_H_
#else
#define SIXDOF_GENERATION_RAY_CAST_TIES_INL_H_
#endif

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include <hwy/highway.h>

#include <sixdof/generation/ray_cast_bounds-inl.h>
#include <sixdof/generation/ray_cast_ties.h>
#include <sixdof/generation/ray_cast_traversal.h>

// Culls pairs of volumes that tie with the best hit. See ray_cast_ties.h.

HWY_BEFORE_NAMESPACE();
namespace sixdof::ray_cast {
namespace HWY_NAMESPACE {

/// What one query of a DifferenceSupport adds to its budget: for pairs that may tie, and for others. Support values
/// cull some of the others because volumes reach beyond their triangles: on smooth surfaces they halve the number of
/// expanded nodes. Of 1, 2, 4 .. 64, 8 is the fastest for the others.
constexpr std::uint64_t k_budget_near = 16;
constexpr std::uint64_t k_budget_far = 8;

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

  /// Whether the slabs of two volumes, given by slots, tie with the best hit or are farther apart.
  bool slabs_tie(std::uint32_t a, std::uint32_t b) const {
    if (a == CastFront::k_root || b == CastFront::k_root) return false;
    const CastSlab slab_a = cast_.a.slab(a);
    const CastSlab slab_b = cast_.b.slab(b);
    return slab_separates(slab_a, slab_b, cast_.b.volume(b)) || slab_separates(slab_b, slab_a, cast_.a.volume(a));
  }

  /// Takes the larger of two flat volumes for cast.patch if it is larger than that.
  void note_patch(std::uint32_t a, std::uint32_t b) {
    if (!cast_.best.pair || a == CastFront::k_root || b == CastFront::k_root) return;
    const bool larger_a = cast_.a.volume(a).size >= cast_.b.volume(b).size;
    const CastTree& tree = larger_a ? cast_.a : cast_.b;
    const std::uint32_t larger = larger_a ? a : b;
    const float size = tree.volume(larger).size;
    if (size > cast_.patch.size() || !cast_.patch.is_facing(cast_.best.axis, cast_.direction)) {
      cast_.patch.replace(tree.slab(larger).normal, size, cast_.best.axis, cast_.direction);
    }
  }

  /// Whether two subtrees are separated by the target along the patch's normal, or along best.separating_axis, up to
  /// half a tie; each is tested only when it is due. Half a tie is more than the rounding of this test and of
  /// try_update(), so that what is culled here is no hit that try_update() would take. While there is no hit to stand
  /// for it, a tie is not culled.
  /// @param near whether they may tie
  /// @param set_bound called with gap and slope if the gap is more than the rounding of single precision; otherwise a
  /// smaller target tests the pair again
  template <class SetBound>
  bool separated(std::uint32_t a, std::uint32_t b, bool near, const SetBound& set_bound) {
    if (a == CastFront::k_root || b == CastFront::k_root) return false;
    const auto separates = [&](DifferenceSupport& support, const Eigen::Vector3d& axis, Backoff& backoff) {
      const double slope = axis.dot(cast_.direction);
      if (slope < 0.0) return false;
      const double gap = cast_.best.translation * slope +
                         support.support_value(a, b, axis, near ? k_budget_near : k_budget_far) - cast_.target;
      const bool culled = gap >= (cast_.best.pair ? -0.5 * tie_ : 0.0);
      backoff.record(culled, pairs_);
      if (gap > ray_.slack) set_bound(static_cast<float>(gap), static_cast<float>(slope));
      return culled;
    };
    if (patch_backoff_.due(pairs_) && cast_.patch.is_facing(cast_.best.axis, cast_.direction) &&
        separates(cast_.patch_support, cast_.patch.normal(), patch_backoff_)) {
      return true;
    }
    return axis_backoff_.due(pairs_) && separates(cast_.axis_support, cast_.best.separating_axis, axis_backoff_);
  }

 private:
  /// Whether slab `x` is separated along its normal by the target, up to a tie, from slab `y` with a box around it.
  bool slab_separates(const CastSlab& x, const CastSlab& y, const CastVolume& box) const {
    const double rate = x.normal.dot(cast_.direction);
    const double sign = rate < 0.0 ? -1.0 : 1.0;
    const Eigen::Vector3d n = sign * x.normal;
    const double along = n.dot(y.normal);
    // n is `along` times y's normal plus a rest, for which the box is used.
    double least = sign * x.middle - x.half + along * y.middle - std::abs(along) * y.half;
    const Eigen::Vector3d rest = n - along * y.normal;
    for (int k = 0; k < 3; ++k) {
      const double half = static_cast<double>(box.half[k]) + static_cast<double>(ray_.slack);
      least += rest[k] * static_cast<double>(box.center[k]) - std::abs(rest[k]) * half;
    }
    return least + cast_.best.translation * std::abs(rate) >= cast_.target - tie_;
  }

  Cast& cast_;
  const Ray& ray_;
  const double tie_;
  std::uint64_t pairs_ = 0;
  Backoff patch_backoff_, axis_backoff_;
};

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ray_cast
HWY_AFTER_NAMESPACE();

#endif
