#pragma once

#include <cmath>

/// Multi-term floating-point arithmetic: a number is the exact, unevaluated sum of doubles of increasing magnitude that
/// do not overlap. Source, with the theorems cited below: J. R. Shewchuk, "Adaptive precision floating-point arithmetic
/// and fast robust geometric predicates", Discrete & Computational Geometry 18 (1997).
///
/// Valid in round-to-nearest with plain doubles (no extended precision, no contraction; the build forbids both), as
/// long as no intermediate product overflows and every exact product is a multiple of the smallest subnormal: for the
/// coordinates that predicates.h allows.
namespace sixdof::expansion {

/// high + low == the exact result; high is the result rounded.
struct Two {
  double high, low;
};

/// Exact a + b (theorem 7).
inline Two two_sum(double a, double b) {
  const double high = a + b;
  const double b_part = high - a;
  const double a_part = high - b_part;
  return {high, (a - a_part) + (b - b_part)};
}

/// Exact a + b where |a| >= |b| or a == 0 (theorem 6).
inline Two fast_two_sum(double a, double b) {
  const double high = a + b;
  return {high, b - (high - a)};
}

/// Halves of 26 bits whose products are exact (theorem 17).
inline Two split(double a) {
  constexpr double k_splitter = 134217729.0;  // 2^27 + 1
  const double c = k_splitter * a;
  const double high = c - (c - a);
  return {high, a - high};
}

/// Exact a * b (theorem 18).
inline Two two_product(double a, double b) {
  const double high = a * b;
  const Two u = split(a);
  const Two v = split(b);
  return {high, u.low * v.low - (((high - u.high * v.high) - u.low * v.high) - u.high * v.low)};
}

/// A sum of at most N doubles without zeros; the empty sum is zero.
template <int N>
struct Expansion {
  int size = 0;
  double term[N];

  void push(double x) {
    if (x != 0.0) term[size++] = x;
  }
  int sign() const { return size == 0 ? 0 : (term[size - 1] > 0.0 ? 1 : -1); }

  /// The number with a relative rounding error of a few units in the last place.
  double estimate() const {
    double sum = 0.0;
    for (int i = 0; i < size; ++i) sum += term[i];
    return sum;
  }
};

/// Exact a - b.
inline Expansion<2> difference(double a, double b) {
  const Two d = two_sum(a, -b);
  Expansion<2> e;
  e.push(d.low);
  e.push(d.high);
  return e;
}

/// Exact e + f (FAST-EXPANSION-SUM with zero elimination, theorem 13).
template <int N, int M>
Expansion<N + M> operator+(const Expansion<N>& e, const Expansion<M>& f) {
  Expansion<N + M> sum;
  int i = 0;
  int j = 0;
  const auto smallest = [&] {
    if (j == f.size || (i < e.size && std::abs(e.term[i]) < std::abs(f.term[j]))) return e.term[i++];
    return f.term[j++];
  };
  const int count = e.size + f.size;
  if (count == 0) return sum;
  double carry = smallest();
  for (int k = 1; k < count; ++k) {
    const Two s = two_sum(carry, smallest());
    sum.push(s.low);
    carry = s.high;
  }
  sum.push(carry);
  return sum;
}

template <int N>
Expansion<N> operator-(Expansion<N> e) {
  for (int i = 0; i < e.size; ++i) e.term[i] = -e.term[i];
  return e;
}

template <int N, int M>
Expansion<N + M> operator-(const Expansion<N>& e, const Expansion<M>& f) {
  return e + (-f);
}

/// Exact e * b (SCALE-EXPANSION with zero elimination, theorem 19).
template <int N>
Expansion<2 * N> scale(const Expansion<N>& e, double b) {
  Expansion<2 * N> product;
  if (e.size == 0 || b == 0.0) return product;
  Two p = two_product(e.term[0], b);
  product.push(p.low);
  double carry = p.high;
  for (int i = 1; i < e.size; ++i) {
    p = two_product(e.term[i], b);
    const Two s = two_sum(carry, p.low);
    product.push(s.low);
    const Two t = fast_two_sum(p.high, s.high);
    product.push(t.low);
    carry = t.high;
  }
  product.push(carry);
  return product;
}

/// Exact e * f.
template <int N>
Expansion<4 * N> operator*(const Expansion<N>& e, const Expansion<2>& f) {
  Expansion<4 * N> product;
  const Expansion<2 * N> low = scale(e, f.size > 0 ? f.term[0] : 0.0);
  const Expansion<2 * N> high = scale(e, f.size > 1 ? f.term[1] : 0.0);
  return low + high;
}

}  // namespace sixdof::expansion
