// Part of other *-inl.h, here, in oracle/ and in generation/: SIMD lanes as the searches of two trees use them. Taken
// once per instruction set: the guard is Highway's for that.
#if defined(SIXDOF_PROXIMITY_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_PROXIMITY_LANES_INL_H_
#undef SIXDOF_PROXIMITY_LANES_INL_H_
#else
#define SIXDOF_PROXIMITY_LANES_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <sixdof/geometry/tree.h>

HWY_BEFORE_NAMESPACE();
namespace sixdof::lanes {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A node's eight children, or eight pairs of triangles. Where a vector holds fewer lanes, loops take several.
using Lanes = hn::CappedTag<float, Tree::k_width>;
using V = hn::Vec<Lanes>;
using M = hn::Mask<Lanes>;

constexpr Lanes k_lanes;
constexpr std::size_t k_width = Tree::k_width;

/// Squared lengths are raised to at least this, so that nothing is divided by zero.
constexpr float k_smallest_square = 1e-36f;

HWY_INLINE V set(float x) { return hn::Set(k_lanes, x); }
HWY_INLINE V load(const float* p) { return hn::Load(k_lanes, p); }

/// Fused: with one rounding where the instruction set has it, so bits depend on the instruction set.
enum class Rounding {
  fused,
  unfused
};

/// x y + z and z - x y, with two roundings: the same bits on every instruction set.
template <class Vec>
HWY_INLINE Vec unfused_mul_add(Vec x, Vec y, Vec z) {
  return hn::Add(hn::Mul(x, y), z);
}
template <class Vec>
HWY_INLINE Vec unfused_sub_mul(Vec z, Vec x, Vec y) {
  return hn::Sub(z, hn::Mul(x, y));
}

/// x y + z and z - x y.
template <Rounding rounding, class Vec>
HWY_INLINE Vec mul_add(Vec x, Vec y, Vec z) {
  if constexpr (rounding == Rounding::fused) return hn::MulAdd(x, y, z);
  return unfused_mul_add(x, y, z);
}
template <Rounding rounding, class Vec>
HWY_INLINE Vec sub_mul(Vec z, Vec x, Vec y) {
  if constexpr (rounding == Rounding::fused) return hn::NegMulAdd(x, y, z);
  return unfused_sub_mul(z, x, y);
}

/// x . y
template <Rounding rounding = Rounding::unfused>
HWY_INLINE V dot(const V (&x)[3], const V (&y)[3]) {
  return mul_add<rounding>(x[2], y[2], mul_add<rounding>(x[1], y[1], hn::Mul(x[0], y[0])));
}

/// The bits of the lanes of `mask`, from bit `i` on.
HWY_INLINE std::uint32_t bits_of(M mask, std::size_t i) {
  HWY_ALIGN std::uint8_t stored[8] = {};  // as many as StoreMaskBits may write
  hn::StoreMaskBits(k_lanes, mask, stored);
  return static_cast<std::uint32_t>(stored[0]) << i;
}

constexpr std::uint32_t k_leaf = Tree::k_leaf_triangles;
constexpr std::size_t k_pairs = std::size_t{k_leaf} * k_leaf;

/// Bits of the pairs of triangles of two leaves: k_leaf i + j is that of triangle i of A's leaf and triangle j of B's.
HWY_INLINE std::uint32_t pairs_of(std::uint32_t count_a, std::uint32_t count_b) {
  return 0x1111u * ((1u << count_b) - 1) & ((1u << k_leaf * count_a) - 1);
}
/// One of them.
HWY_INLINE TrianglePair pair_of(std::uint32_t first_a, std::uint32_t first_b, std::uint32_t bit) {
  return {first_a + bit / k_leaf, first_b + bit % k_leaf};
}

/// Prefetches what one of the next steps reads: large trees are not in the caches.
template <class T>
HWY_INLINE void prefetch(const T& x) {
  constexpr std::size_t k_cache_line = 64;  // bytes
  const char* const begin = reinterpret_cast<const char*>(&x);
  for (std::size_t offset = 0; offset < sizeof(T); offset += k_cache_line) hwy::Prefetch(begin + offset);
}

/// Frank-Wolfe iteration for the point nearest to the origin of the Minkowski difference S = {b - a} of two triangles,
/// one pair of triangles per SIMD lane. With x in S and s a point of S for which x . s is least, x . s / |x| is a lower
/// bound on the distance of the triangles; the step moves x to the point of the segment from x to s that is nearest to
/// the origin. (M. Frank and P. Wolfe, "An algorithm for quadratic programming", Naval Research Logistics 3, 1956.)
namespace frank_wolfe {

enum class Extreme {
  least,
  greatest
};

/// Support value x . p and support point p.
struct Support {
  V value;
  V point[3];
};

/// The corner of each lane's triangle for which x . corner is least or greatest; the first of equal ones.
/// @param corners [corner][axis][lane]; lanes i, i + 1, ... are read
template <Rounding rounding, Extreme extreme, std::size_t count>
HWY_INLINE Support support(const V (&x)[3], const float (&corners)[3][3][count], std::size_t i) {
  Support best;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    V value = hn::Mul(x[0], load(corners[corner][0] + i));
    for (std::size_t k = 1; k < 3; ++k) value = mul_add<rounding>(x[k], load(corners[corner][k] + i), value);
    if (corner == 0) {
      best.value = value;
      for (std::size_t k = 0; k < 3; ++k) best.point[k] = load(corners[0][k] + i);
      continue;
    }
    const M better = extreme == Extreme::least ? hn::Lt(value, best.value) : hn::Gt(value, best.value);
    best.value = extreme == Extreme::least ? hn::Min(value, best.value) : hn::Max(value, best.value);
    for (std::size_t k = 0; k < 3; ++k) {
      best.point[k] = hn::IfThenElse(better, load(corners[corner][k] + i), best.point[k]);
    }
  }
  return best;
}

/// |x|, at least the square root of k_smallest_square.
template <Rounding rounding>
HWY_INLINE V length(const V (&x)[3]) {
  V squared = hn::Mul(x[0], x[0]);
  for (std::size_t k = 1; k < 3; ++k) squared = mul_add<rounding>(x[k], x[k], squared);
  return hn::Sqrt(hn::Max(squared, set(k_smallest_square)));
}

/// Moves x to the point of the segment from x to s that is nearest to the origin.
template <Rounding rounding>
HWY_INLINE void step(V (&x)[3], const V (&s)[3]) {
  V difference[3];
  V decrease = hn::Zero(k_lanes);
  V squared = set(k_smallest_square);
  for (std::size_t k = 0; k < 3; ++k) {
    difference[k] = hn::Sub(s[k], x[k]);
    decrease = sub_mul<rounding>(decrease, x[k], difference[k]);
    squared = mul_add<rounding>(difference[k], difference[k], squared);
  }
  const V fraction = hn::Min(hn::Max(hn::Div(decrease, squared), hn::Zero(k_lanes)), set(1.0f));
  for (std::size_t k = 0; k < 3; ++k) x[k] = mul_add<rounding>(fraction, difference[k], x[k]);
}

}  // namespace frank_wolfe
}  // namespace HWY_NAMESPACE
}  // namespace sixdof::lanes
HWY_AFTER_NAMESPACE();

#endif  // guard per instruction set
