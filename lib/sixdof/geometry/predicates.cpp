#include <sixdof/geometry/predicates.h>

namespace sixdof {
namespace {

// Multi-term floating-point arithmetic: a number is the exact, unevaluated sum of doubles of increasing magnitude that
// do not overlap. Source, with the theorems cited below: J. R. Shewchuk, "Adaptive precision floating-point arithmetic
// and fast robust geometric predicates", Discrete & Computational Geometry 18 (1997).
//
// Valid in round-to-nearest with plain doubles (no extended precision, no contraction; the build forbids both), as
// long as no intermediate product overflows and every exact product is a multiple of the smallest subnormal: for the
// coordinates that predicates.h allows.

/// high + low == the exact result; high is the result rounded.
struct Two {
  double high, low;
};

/// Exact a + b (theorem 7).
Two two_sum(double a, double b) {
  const double high = a + b;
  const double b_part = high - a;
  const double a_part = high - b_part;
  return {high, (a - a_part) + (b - b_part)};
}

/// Exact a + b where |a| >= |b| or a == 0 (theorem 6).
Two fast_two_sum(double a, double b) {
  const double high = a + b;
  return {high, b - (high - a)};
}

/// Halves of 26 bits whose products are exact (theorem 17).
Two split(double a) {
  constexpr double k_splitter = 134217729.0;  // 2^27 + 1
  const double c = k_splitter * a;
  const double high = c - (c - a);
  return {high, a - high};
}

/// Exact a * b (theorem 18).
Two two_product(double a, double b) {
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
Expansion<2> difference(double a, double b) {
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

struct Row {
  Expansion<2> x, y, z;
  Row(const Eigen::Vector3d& p, const Eigen::Vector3d& origin)
      : x(difference(p.x(), origin.x())), y(difference(p.y(), origin.y())), z(difference(p.z(), origin.z())) {}
};

/// Whether two points are equal: the determinant is zero. By far the most frequent tie.
bool coincident(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Eigen::Vector3d& d) {
  return d == a || d == b || d == c || a == b || b == c || a == c;
}

Expansion<192> determinant(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                           const Eigen::Vector3d& d) {
  const Row u(b, a);
  const Row v(c, a);
  const Row w(d, a);
  const Expansion<16> uv = u.x * v.y - v.x * u.y;
  const Expansion<16> vw = v.x * w.y - w.x * v.y;
  const Expansion<16> wu = w.x * u.y - u.x * w.y;
  return (uv * w.z + vw * u.z) + wu * v.z;
}

/// Exact sign of (b - a)(d - c) - (f - e)(h - g).
int sign_of_difference_of_products(double a, double b, double c, double d, double e, double f, double g, double h) {
  const double left = (b - a) * (d - c);
  const double right = (f - e) * (h - g);
  const double value = left - right;
  // Shewchuk's bound ccwerrboundA: three roundings per product, one for the difference.
  constexpr double k_bound = (3.0 + 16.0 * detail::k_unit_roundoff) * detail::k_unit_roundoff;
  const double bound = k_bound * (std::abs(left) + std::abs(right)) + detail::k_underflow_bound;
  if (value > bound) return 1;
  if (value < -bound) return -1;
  return (difference(b, a) * difference(d, c) - difference(f, e) * difference(h, g)).sign();
}

}  // namespace

int orient2d(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return sign_of_difference_of_products(a.x(), b.x(), a.y(), c.y(), a.x(), c.x(), a.y(), b.y());
}

double orient3d_value(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                      const Eigen::Vector3d& d) {
  const detail::Filtered f = detail::orient3d_filter(a, b, c, d);
  if (std::abs(f.value) * k_orient3d_relative_error > f.bound) return f.value;
  return detail::orient3d_exact_value(a, b, c, d);
}

namespace detail {

double orient3d_exact_value(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                            const Eigen::Vector3d& d) {
  return coincident(a, b, c, d) ? 0.0 : determinant(a, b, c, d).estimate();
}

int lexicographic_cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                        const Eigen::Vector3d& d) {
  const int x = sign_of_difference_of_products(a.y(), b.y(), c.z(), d.z(), a.z(), b.z(), c.y(), d.y());
  if (x != 0) return x;
  const int y = sign_of_difference_of_products(a.z(), b.z(), c.x(), d.x(), a.x(), b.x(), c.z(), d.z());
  if (y != 0) return y;
  return sign_of_difference_of_products(a.x(), b.x(), c.y(), d.y(), a.y(), b.y(), c.x(), d.x());
}

}  // namespace detail
}  // namespace sixdof
