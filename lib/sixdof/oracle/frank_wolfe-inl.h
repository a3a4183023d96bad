// Compiled once per instruction set: part of distance_traversal.cpp and of generation/ray_cast_traversal.cpp.
#if defined(SIXDOF_ORACLE_FRANK_WOLFE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIXDOF_ORACLE_FRANK_WOLFE_INL_H_
#undef SIXDOF_ORACLE_FRANK_WOLFE_INL_H_
#else
#define SIXDOF_ORACLE_FRANK_WOLFE_INL_H_
#endif

#include <cstddef>

#include <hwy/highway.h>

// Frank-Wolfe iteration for the point nearest to the origin of the Minkowski difference S = {b - a} of two triangles,
// one pair of triangles per SIMD lane. With x in S and s a point of S for which x . s is least, x . s / |x| is a lower
// bound on the distance of the triangles; the step moves x to the point of the segment from x to s that is nearest to
// the origin. (M. Frank and P. Wolfe, "An algorithm for quadratic programming", Naval Research Logistics 3, 1956.)

HWY_BEFORE_NAMESPACE();
namespace sixdof::frank_wolfe {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// x y + z with one rounding where the instruction set has it: bits depend on the instruction set.
struct Fused {
  template <class V>
  static HWY_INLINE V multiply_add(V x, V y, V z) {
    return hn::MulAdd(x, y, z);
  }
  template <class V>
  static HWY_INLINE V negated_multiply_add(V x, V y, V z) {
    return hn::NegMulAdd(x, y, z);
  }
};

/// x y + z with two roundings: the same bits on every instruction set.
struct Unfused {
  template <class V>
  static HWY_INLINE V multiply_add(V x, V y, V z) {
    return hn::Add(hn::Mul(x, y), z);
  }
  template <class V>
  static HWY_INLINE V negated_multiply_add(V x, V y, V z) {
    return hn::Sub(z, hn::Mul(x, y));
  }
};

/// Squared lengths are raised to at least this, so that nothing is divided by zero.
constexpr float k_smallest_square = 1e-36f;

enum class Extreme {
  least,
  greatest
};

/// Support value x . p and support point p.
template <class V>
struct Support {
  V value;
  V point[3];
};

/// The corner of each lane's triangle for which x . corner is least or greatest; the first of equal ones.
/// @param corners [corner][axis][lane]; lanes i, i + 1, ... are read
template <class Arithmetic, Extreme extreme, class D, class V = hn::Vec<D>, std::size_t count>
HWY_INLINE Support<V> support(D d, const V (&x)[3], const float (&corners)[3][3][count], std::size_t i) {
  Support<V> best;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    V value = hn::Mul(x[0], hn::Load(d, corners[corner][0] + i));
    for (std::size_t k = 1; k < 3; ++k) {
      value = Arithmetic::multiply_add(x[k], hn::Load(d, corners[corner][k] + i), value);
    }
    if (corner == 0) {
      best.value = value;
      for (std::size_t k = 0; k < 3; ++k) best.point[k] = hn::Load(d, corners[0][k] + i);
      continue;
    }
    if constexpr (extreme == Extreme::least) {
      const auto better = hn::Lt(value, best.value);
      best.value = hn::Min(value, best.value);
      for (std::size_t k = 0; k < 3; ++k) {
        best.point[k] = hn::IfThenElse(better, hn::Load(d, corners[corner][k] + i), best.point[k]);
      }
    } else {
      const auto better = hn::Gt(value, best.value);
      best.value = hn::Max(value, best.value);
      for (std::size_t k = 0; k < 3; ++k) {
        best.point[k] = hn::IfThenElse(better, hn::Load(d, corners[corner][k] + i), best.point[k]);
      }
    }
  }
  return best;
}

/// |x|, at least the square root of k_smallest_square.
template <class Arithmetic, class D, class V = hn::Vec<D>>
HWY_INLINE V length(D d, const V (&x)[3]) {
  V squared = hn::Mul(x[0], x[0]);
  for (std::size_t k = 1; k < 3; ++k) squared = Arithmetic::multiply_add(x[k], x[k], squared);
  return hn::Sqrt(hn::Max(squared, hn::Set(d, k_smallest_square)));
}

/// Moves x to the point of the segment from x to s that is nearest to the origin.
template <class Arithmetic, class D, class V = hn::Vec<D>>
HWY_INLINE void step(D d, V (&x)[3], const V (&s)[3]) {
  V difference[3];
  V decrease = hn::Zero(d);
  V squared = hn::Set(d, k_smallest_square);
  for (std::size_t k = 0; k < 3; ++k) {
    difference[k] = hn::Sub(s[k], x[k]);
    decrease = Arithmetic::negated_multiply_add(x[k], difference[k], decrease);
    squared = Arithmetic::multiply_add(difference[k], difference[k], squared);
  }
  const V fraction = hn::Min(hn::Max(hn::Div(decrease, squared), hn::Zero(d)), hn::Set(d, 1.0f));
  for (std::size_t k = 0; k < 3; ++k) x[k] = Arithmetic::multiply_add(fraction, difference[k], x[k]);
}

}  // namespace HWY_NAMESPACE
}  // namespace sixdof::frank_wolfe
HWY_AFTER_NAMESPACE();

#endif
