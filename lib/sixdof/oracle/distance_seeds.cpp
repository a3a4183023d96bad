#include <sixdof/oracle/distance_search.h>

#include <limits>
#include <vector>

#include <sixdof/base/simd_targets.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/oracle/distance_seeds.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/oracle/distance_bounds-inl.h>

// Where a search starts: from the closest pair of corners that are spread over both surfaces, in turn to the closest
// corner of the other surface, so that most of the search is pruned by a distance that is nearly the smallest.

HWY_BEFORE_NAMESPACE();
namespace sixdof::detail {
namespace HWY_NAMESPACE {

/// p_N of p_F.
void transform(const Frame& f, const float* p, float* out) {
  for (std::size_t k = 0; k < 3; ++k) {
    out[k] = f.translation[k] + f.axis[0][k] * p[0] + f.axis[1][k] * p[1] + f.axis[2][k] * p[2];
  }
}

/// Indices of the closest pair of seed corners, and their squared distance.
struct ClosestSeeds {
  std::size_t a = 0;
  std::size_t b = 0;
  float squared = std::numeric_limits<float>::infinity();

  /// @param f from B's frame to A's
  ClosestSeeds(const SeedCorners& seeds_a, const SeedCorners& seeds_b, const Frame& f) {
    HWY_ALIGN float least[k_width];
    HWY_ALIGN float index[k_width];  // of the corner of A: an exact small integer
    for (std::size_t i = 0; i < SeedCorners::k_count; i += hn::Lanes(k_lanes)) {
      V p[3];
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = set(f.translation[k]);
        for (std::size_t m = 0; m < 3; ++m) {
          p[k] = hn::MulAdd(set(f.axis[m][k]), load(seeds_b.point[m] + i), p[k]);
        }
      }
      V closest = set(std::numeric_limits<float>::infinity());
      V which = hn::Zero(k_lanes);
      for (std::size_t j = 0; j < SeedCorners::k_count; ++j) {
        V sum = hn::Zero(k_lanes);
        for (std::size_t k = 0; k < 3; ++k) {
          const V d = hn::Sub(p[k], set(seeds_a.point[k][j]));
          sum = hn::MulAdd(d, d, sum);
        }
        which = hn::IfThenElse(hn::Lt(sum, closest), set(static_cast<float>(j)), which);
        closest = hn::Min(closest, sum);
      }
      hn::Store(closest, k_lanes, least);
      hn::Store(which, k_lanes, index);
      for (std::size_t lane = 0; lane < hn::Lanes(k_lanes); ++lane) {
        if (least[lane] < squared) {
          squared = least[lane];
          a = static_cast<std::size_t>(index[lane]);
          b = i + lane;
        }
      }
    }
  }
};

void seed_search(DistanceSearch& search) {
  const SeedCorners& seeds_a = search.a.seeds;
  const SeedCorners& seeds_b = search.b.seeds;
  const QueryFrames frames(search.a.tree, search.b.tree, search.X_AB);
  const ClosestSeeds closest(seeds_a, seeds_b, frames.a);
  // A pair of the last query may be closer.
  if (search.found && search.best * search.best <= static_cast<double>(closest.squared)) return;

  float best = closest.squared;
  Corner a{best, seeds_a.leaf[closest.a], 0, {}};
  Corner b{best, seeds_b.leaf[closest.b], 0, {}};
  for (std::size_t k = 0; k < 3; ++k) {
    a.point[k] = seeds_a.point[k][closest.a];
    b.point[k] = seeds_b.point[k][closest.b];
  }
  float from[3];
  bool search_b = true;
  // The nearest corner of a few leaves: a step that looks at more takes longer than it spares in the search.
  constexpr CornerEffort k_effort{.leaf_areas = 2.0f, .most_leaves = 6};
  constexpr int k_steps = 16;  // at most; few need as many
  for (int i = 0, misses = 0; i < k_steps && misses < 2; ++i, search_b = !search_b) {
    transform(search_b ? frames.b : frames.a, search_b ? a.point : b.point, from);
    Corner& corner = search_b ? b : a;
    corner.squared = best;
    if (!find_corner(search_b ? search.b.tree : search.a.tree, from, k_effort, corner, search.corners)) ++misses;
    best = corner.squared;
  }
  try_update(search, TrianglePair{triangle_of(search.a.tree, a), triangle_of(search.b.tree, b)});
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::detail {

HWY_EXPORT(seed_search);

void seed_search(DistanceSearch& search) { HWY_DYNAMIC_DISPATCH(seed_search)(search); }

}  // namespace sixdof::detail
#endif  // HWY_ONCE
