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

/// Whether two points are equal, or all have a coordinate in common: the determinant is zero. By far the most frequent
/// ties: shared vertices, and faces across an axis.
bool surely_coplanar(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                     const Eigen::Vector3d& d) {
  for (int k = 0; k < 3; ++k) {
    if (a[k] == b[k] && a[k] == c[k] && a[k] == d[k]) return true;
  }
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

/// A number of twice the precision: high + low, of which high is the sum rounded.
struct Double2 {
  double high, low;
};

Double2 operator*(const Double2& x, const Double2& y) {
  const Two p = two_product(x.high, y.high);
  const Two s = fast_two_sum(p.high, p.low + (x.high * y.low + x.low * y.high));
  return {s.high, s.low};
}

Double2 operator+(const Double2& x, const Double2& y) {
  const Two high = two_sum(x.high, y.high);
  const Two low = two_sum(x.low, y.low);
  const Two s = fast_two_sum(high.high, high.low + low.high);
  const Two t = fast_two_sum(s.high, s.low + low.low);
  return {t.high, t.low};
}

Double2 operator-(const Double2& x, const Double2& y) { return x + Double2{-y.high, -y.low}; }

/// The determinant of b - a, c - a, d - a. A sum or product has a relative error below 2^-100, of the result or of the
/// terms that cancel; fewer than 32 of them add up to less than k_double2_bound times the permanent.
constexpr double k_double2_bound = 0x1p-92;

int sign_in_double2(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                    const Eigen::Vector3d& d) {
  const auto minus_a = [&a](const Eigen::Vector3d& p, int k) {
    const Two x = two_sum(p[k], -a[k]);
    return Double2{x.high, x.low};
  };
  const Double2 u[3] = {minus_a(b, 0), minus_a(b, 1), minus_a(b, 2)};
  const Double2 v[3] = {minus_a(c, 0), minus_a(c, 1), minus_a(c, 2)};
  const Double2 w[3] = {minus_a(d, 0), minus_a(d, 1), minus_a(d, 2)};
  Double2 sum{0.0, 0.0};
  double permanent = 0.0;
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3, m = (k + 2) % 3;
    const Double2 left = u[l] * v[m], right = u[m] * v[l];
    sum = sum + (left - right) * w[k];
    permanent += (std::abs(left.high) + std::abs(right.high)) * std::abs(w[k].high);
  }
  const double bound = k_double2_bound * permanent + detail::k_underflow_bound;
  return (sum.high > bound ? 1 : 0) - (sum.high < -bound ? 1 : 0);
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
  return surely_coplanar(a, b, c, d) ? 0.0 : determinant(a, b, c, d).estimate();
}

int orient3d_exact_sign(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                        const Eigen::Vector3d& d) {
  if (surely_coplanar(a, b, c, d)) return 0;
  const int sign = sign_in_double2(a, b, c, d);
  return sign != 0 ? sign : determinant(a, b, c, d).sign();
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
