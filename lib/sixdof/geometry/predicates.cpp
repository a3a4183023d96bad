#include <sixdof/geometry/predicates.h>

#include <sixdof/geometry/expansion.h>

namespace sixdof {
namespace {

using expansion::Expansion;

struct Row {
  Expansion<2> x, y, z;
  Row(const Eigen::Vector3d& p, const Eigen::Vector3d& origin)
      : x(expansion::difference(p.x(), origin.x())),
        y(expansion::difference(p.y(), origin.y())),
        z(expansion::difference(p.z(), origin.z())) {}
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
  using expansion::difference;
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

int orient3d_exact(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                   const Eigen::Vector3d& d) {
  return coincident(a, b, c, d) ? 0 : determinant(a, b, c, d).sign();
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
