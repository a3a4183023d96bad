#include <sixdof/algorithm/ist/clearance_model.h>

#include <limits>

#include <sixdof/base/simd_targets.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sixdof/algorithm/ist/clearance_model.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::ist {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<double, ClearanceModels::k_slots> k_doubles;
using V = hn::Vec<decltype(k_doubles)>;

struct Vec3 {
  V x, y, z;
};

HWY_INLINE V set(double value) { return hn::Set(k_doubles, value); }
HWY_INLINE V load(const ClearanceModels::Values& values, std::size_t at) { return hn::Load(k_doubles, &values[at]); }
HWY_INLINE Vec3 load(const std::array<ClearanceModels::Values, 3>& of, std::size_t at) {
  return {load(of[0], at), load(of[1], at), load(of[2], at)};
}
HWY_INLINE Vec3 sub(const Vec3& u, const Vec3& v) { return {hn::Sub(u.x, v.x), hn::Sub(u.y, v.y), hn::Sub(u.z, v.z)}; }
HWY_INLINE V dot(const Vec3& u, const Vec3& v) {
  return hn::Add(hn::Add(hn::Mul(u.x, v.x), hn::Mul(u.y, v.y)), hn::Mul(u.z, v.z));
}
template <class M>
HWY_INLINE Vec3 select(M mask, const Vec3& yes, const Vec3& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y), hn::IfThenElse(mask, yes.z, no.z)};
}
/// u + v s
HWY_INLINE Vec3 moved(const Vec3& u, const Vec3& v, V s) {
  return {hn::Add(u.x, hn::Mul(v.x, s)), hn::Add(u.y, hn::Mul(v.y, s)), hn::Add(u.z, hn::Mul(v.z, s))};
}

struct Nearest {
  V distance;
  Vec3 away;  ///< Unit vector; zero at the centre of a sphere, and on the surface.
};

/// Of equally near obstacles the first.
HWY_INLINE Nearest nearest(const ClearanceModels::Lanes& lanes, std::size_t at, const Vec3& p) {
  const V zero = hn::Zero(k_doubles), one = set(1.0);
  V distance = set(std::numeric_limits<double>::infinity());
  Vec3 direction{zero, zero, zero};
  V length = one;
  for (const auto& obstacle : lanes.obstacles) {
    const Vec3 offset = sub(p, load(obstacle.point, at)), normal = load(obstacle.normal, at);
    const V radius = load(obstacle.radius, at);
    const auto is_plane = hn::Eq(radius, zero);
    const V norm = hn::Sqrt(dot(offset, offset));
    const V here = hn::IfThenElse(is_plane, dot(normal, offset), hn::Sub(norm, radius));
    const auto nearer = hn::Lt(here, distance);
    distance = hn::IfThenElse(nearer, here, distance);
    direction = select(nearer, select(is_plane, normal, offset), direction);
    length = hn::IfThenElse(nearer, hn::IfThenElse(hn::Or(is_plane, hn::Eq(norm, zero)), one, norm), length);
  }
  return {distance, {hn::Div(direction.x, length), hn::Div(direction.y, length), hn::Div(direction.z, length)}};
}

/// Of the slots from `at` on, as many as a vector has lanes.
HWY_INLINE void maximise_vector(ClearanceModels::Lanes& lanes, std::size_t at) {
  constexpr int k_steps = 40;
  constexpr double k_decay = 0.88;  // 0.88^40 = 0.6 %
  const Vec3 start = load(lanes.start, at);
  const V trust = load(lanes.trust, at);
  Vec3 p = start, best = start;
  Nearest here = nearest(lanes, at, p);
  V best_distance = here.distance;
  V length = hn::Mul(set(0.5), trust);
  for (int i = 0; i < k_steps; ++i, length = hn::Mul(length, set(k_decay))) {
    p = moved(p, here.away, length);
    const Vec3 path = sub(p, start);
    const V out = hn::Sqrt(dot(path, path));
    const auto too_far = hn::Gt(out, trust);
    if (!hn::AllFalse(k_doubles, too_far)) p = select(too_far, moved(start, path, hn::Div(trust, out)), p);
    here = nearest(lanes, at, p);
    const auto better = hn::Gt(here.distance, best_distance);
    best = select(better, p, best);
    best_distance = hn::IfThenElse(better, here.distance, best_distance);
  }
  hn::Store(best.x, k_doubles, &lanes.place[0][at]);
  hn::Store(best.y, k_doubles, &lanes.place[1][at]);
  hn::Store(best.z, k_doubles, &lanes.place[2][at]);
  hn::Store(best_distance, k_doubles, &lanes.clearance[at]);
}

void maximise(ClearanceModels::Lanes& lanes) {
  for (std::size_t at = 0; at < ClearanceModels::k_slots; at += hn::Lanes(k_doubles)) maximise_vector(lanes, at);
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::ist
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sixdof::ist {

HWY_EXPORT(maximise);

void ClearanceModels::reset(std::size_t slot) {
  for (auto& obstacle : lanes_.obstacles) obstacle.radius[slot] = -std::numeric_limits<double>::infinity();
  count_[slot] = 0;
}

void ClearanceModels::add(std::size_t slot, const Obstacle& obstacle) {
  auto& target = lanes_.obstacles[count_[slot]++ % k_obstacles];
  for (std::size_t k = 0; k < 3; ++k) {
    target.point[k][slot] = obstacle.point[static_cast<Eigen::Index>(k)];
    target.normal[k][slot] = obstacle.normal[static_cast<Eigen::Index>(k)];
  }
  target.radius[slot] = obstacle.radius;
}

void ClearanceModels::set_start(std::size_t slot, const Eigen::Vector3d& start, double trust) {
  for (std::size_t k = 0; k < 3; ++k) lanes_.start[k][slot] = start[static_cast<Eigen::Index>(k)];
  lanes_.trust[slot] = trust;
}

void ClearanceModels::maximise() { HWY_DYNAMIC_DISPATCH(maximise)(lanes_); }

}  // namespace sixdof::ist
#endif
