// Eight pairs of triangles or eight volumes, one per SIMD lane, in doubles: for crossings and distances of triangles
// (oracle/) and the ray cast (generation/). Taken once per instruction set: the guard is Highway's for that.
#if defined(SIXDOF_PROXIMITY_DOUBLE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_PROXIMITY_DOUBLE_LANES_INL_H_
#undef SIXDOF_PROXIMITY_DOUBLE_LANES_INL_H_
#else
#define SIXDOF_PROXIMITY_DOUBLE_LANES_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include <hwy/highway.h>

// No multiplication is fused, so every instruction set finds the same bits.

HWY_BEFORE_NAMESPACE();
namespace sixdof::double_lanes {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t k_batch = 8;  ///< Pairs.

/// Where a vector holds fewer lanes, loops take several.
using Lanes = hn::CappedTag<double, k_batch>;
using V = hn::Vec<Lanes>;
using M = hn::Mask<Lanes>;
constexpr Lanes k_lanes;

HWY_INLINE V set(double x) { return hn::Set(k_lanes, x); }
HWY_INLINE M no_lane() { return hn::Lt(hn::Zero(k_lanes), hn::Zero(k_lanes)); }

/// The bits of the lanes of `mask`, from bit `i` on.
template <class D>
HWY_INLINE std::uint32_t bits_of(D d, hn::Mask<D> mask, std::size_t i) {
  HWY_ALIGN std::uint8_t stored[8] = {};  // as many as StoreMaskBits may write
  hn::StoreMaskBits(d, mask, stored);
  return static_cast<std::uint32_t>(stored[0]) << i;
}
HWY_INLINE std::uint32_t bits_of(M mask, std::size_t i) { return bits_of(k_lanes, mask, i); }

/// A vector per lane, of doubles or of floats.
template <class Vec>
struct Vector3 {
  Vec x, y, z;
};
using V3 = Vector3<V>;

template <class Vec>
HWY_INLINE Vector3<Vec> operator-(const Vector3<Vec>& a, const Vector3<Vec>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class Vec>
HWY_INLINE Vector3<Vec> operator+(const Vector3<Vec>& a, const Vector3<Vec>& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
template <class Vec>
HWY_INLINE Vector3<Vec> operator*(Vec s, const Vector3<Vec>& a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}
template <class Vec>
HWY_INLINE Vector3<Vec> operator-(const Vector3<Vec>& a) {
  return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)};
}
/// In the order of Eigen.
template <class Vec>
HWY_INLINE Vec sum(const Vector3<Vec>& a) {
  return hn::Add(hn::Add(a.x, a.y), a.z);
}
template <class Vec>
HWY_INLINE Vec dot(const Vector3<Vec>& a, const Vector3<Vec>& b) {
  return sum(Vector3<Vec>{hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)});
}
template <class Vec>
HWY_INLINE Vector3<Vec> cross(const Vector3<Vec>& a, const Vector3<Vec>& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
template <class Vec>
HWY_INLINE Vector3<Vec> abs(const Vector3<Vec>& a) {
  return {hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)};
}
template <class Mask, class Vec>
HWY_INLINE Vec select(Mask mask, Vec yes, Vec no) {
  return hn::IfThenElse(mask, yes, no);
}
template <class Mask, class Vec>
HWY_INLINE Vector3<Vec> select(Mask mask, const Vector3<Vec>& yes, const Vector3<Vec>& no) {
  return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}

HWY_INLINE V3 load(const double (&p)[3][k_batch], std::size_t i) {
  return {hn::Load(k_lanes, p[0] + i), hn::Load(k_lanes, p[1] + i), hn::Load(k_lanes, p[2] + i)};
}
HWY_INLINE void store(const V3& v, double (&p)[3][k_batch], std::size_t i) {
  hn::Store(v.x, k_lanes, p[0] + i);
  hn::Store(v.y, k_lanes, p[1] + i);
  hn::Store(v.z, k_lanes, p[2] + i);
}

/// One lane.
HWY_INLINE Eigen::Vector3d point(const double (&p)[3][k_batch], std::size_t lane) {
  return {p[0][lane], p[1][lane], p[2][lane]};
}
HWY_INLINE void put(const Eigen::Vector3d& x, double (&p)[3][k_batch], std::size_t lane) {
  for (int k = 0; k < 3; ++k) p[k][lane] = x[k];
}

/// Corners of one body's triangle of each pair.
template <class Vec>
struct CornersOf {
  Vector3<Vec> corner[3];
};
using Corners = CornersOf<V>;

HWY_INLINE Corners load(const double (&p)[3][3][k_batch], std::size_t i) {
  return {{load(p[0], i), load(p[1], i), load(p[2], i)}};
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::double_lanes
HWY_AFTER_NAMESPACE();

#endif  // guard per instruction set
