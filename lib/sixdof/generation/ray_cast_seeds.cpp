#include <sixdof/generation/ray_cast_seeds.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <sixdof/generation/ray_cast_pair.h>
#include <sixdof/oracle/seed_corners.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/generation/ray_cast_seeds.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After foreach_target.h: this is compiled once per instruction set, too.
#include <sixdof/oracle/lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::ray_cast {
namespace HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using detail::SeedCorners;

/// Sets the pair of seed corners that comes within `distance` first, and returns the translation at which it does;
/// -Tree::k_empty if none does.
float first_corners(const Cast& cast, float distance, std::pair<std::size_t, std::size_t>& first) {
  const SeedCorners& seeds_a = cast.a.mesh().seeds();
  const SeedCorners& seeds_b = cast.b.mesh().seeds();
  const Eigen::Matrix3f R = cast.b.matrix().cast<float>();
  const Eigen::Vector3f direction = cast.direction.cast<float>();
  const V u[3] = {set(direction[0]), set(direction[1]), set(direction[2])};
  const V squared_distance = set(distance * distance);
  HWY_ALIGN float largest[k_width];
  HWY_ALIGN float index[k_width];  // of the corner of A: an exact small integer
  float best = -Tree::k_empty;
  for (std::size_t i = 0; i < SeedCorners::k_count; i += hn::Lanes(k_lanes)) {
    V q[3];
    for (int k = 0; k < 3; ++k) {
      q[k] = hn::Zero(k_lanes);
      for (int m = 0; m < 3; ++m) q[k] = unfused_mul_add(set(R(k, m)), load(seeds_b.point[m] + i), q[k]);
    }
    V latest = set(-Tree::k_empty);
    V which = hn::Zero(k_lanes);
    for (std::size_t j = 0; j < SeedCorners::k_count; ++j) {
      V s[3];
      for (std::size_t k = 0; k < 3; ++k) s[k] = hn::Sub(q[k], set(seeds_a.point[k][j]));
      const V along = dot(s, u);
      // Of the point of the ray that is nearest: from there it is as far to where the distance is reached.
      const V squared = hn::Sub(squared_distance, unfused_sub_mul(dot(s, s), along, along));
      const V t = hn::Sub(hn::Sqrt(hn::Max(squared, hn::Zero(k_lanes))), along);
      const M better = hn::And(hn::Ge(squared, hn::Zero(k_lanes)), hn::Gt(t, latest));
      which = hn::IfThenElse(better, set(static_cast<float>(j)), which);
      latest = hn::IfThenElse(better, t, latest);
    }
    hn::Store(latest, k_lanes, largest);
    hn::Store(which, k_lanes, index);
    for (std::size_t lane = 0; lane < hn::Lanes(k_lanes); ++lane) {
      if (largest[lane] > best) {
        best = largest[lane];
        first = {static_cast<std::size_t>(index[lane]), i + lane};
      }
    }
  }
  return best;
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ray_cast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::ray_cast {
namespace {

using detail::Corner;
using detail::SeedCorners;

/// Distance of neighbouring seed corners, in units of the tree's radius: 64 on a sphere.
constexpr double k_spread = 0.4;
/// The fastest of 0 .. 6 steps, and of tolerances from 1 to 1.1.
constexpr int k_steps = 2;
constexpr float k_tolerance = 1.02f;

Corner corner_of(const SeedCorners& seeds, std::size_t i) {
  return {std::numeric_limits<float>::infinity(),
          seeds.leaf[i],
          0,
          {seeds.point[0][i], seeds.point[1][i], seeds.point[2][i]}};
}

Eigen::Vector3d point_of(const Corner& c) {
  return {static_cast<double>(c.point[0]), static_cast<double>(c.point[1]), static_cast<double>(c.point[2])};
}

/// Takes the corner of `tree` that is closest to p, if it is closer than the last one.
bool move_to(const Tree& tree, const Eigen::Vector3d& p, Corner& corner, std::vector<detail::CornerVolume>& stack) {
  const float at[3] = {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
  corner.squared = static_cast<float>((point_of(corner) - p).squaredNorm());
  return detail::find_corner(tree, at, k_tolerance, corner, stack);
}

}  // namespace

HWY_EXPORT(first_corners);

void seed_first_hit(Cast& cast) {
  const Tree& tree_a = cast.a.mesh().tree();
  const Tree& tree_b = cast.b.mesh().tree();
  const Eigen::Matrix3d& R = cast.b.matrix();
  const double distance = cast.target + k_spread * std::max(tree_a.radius(), tree_b.radius());
  std::pair<std::size_t, std::size_t> first;
  double t = static_cast<double>(HWY_DYNAMIC_DISPATCH(first_corners)(cast, static_cast<float>(distance), first));
  if (t <= cast.best.translation) return;
  Corner a = corner_of(cast.a.mesh().seeds(), first.first);
  Corner b = corner_of(cast.b.mesh().seeds(), first.second);
  std::vector<detail::CornerVolume>& stack = cast.corners;
  for (int step = 0; step < k_steps; ++step) {
    const bool moved_a = move_to(tree_a, R * point_of(b) + t * cast.direction, a, stack);
    const bool moved_b = move_to(tree_b, R.transpose() * (point_of(a) - t * cast.direction), b, stack);
    if (try_update(cast, {triangle_of(tree_a, a), triangle_of(tree_b, b)})) {
      t = cast.best.translation;
    } else if (!moved_a && !moved_b) {
      return;
    }
  }
}

}  // namespace sixdof::ray_cast
#endif  // HWY_ONCE
