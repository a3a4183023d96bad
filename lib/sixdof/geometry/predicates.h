#pragma once

#include <cmath>

#include <Eigen/Core>

/// Exact signs of geometric determinants of double coordinates, and the rule that breaks their ties.
///
/// **Exact.** A floating-point filter decides most cases; where its error bound does not decide, expansion arithmetic
/// gives the exact value. Signs are exact and the same on every machine if every coordinate is zero or
/// has a magnitude between k_smallest_exact_coordinate and k_largest_exact_coordinate: products of three differences
/// neither underflow nor overflow there.
///
/// **Ties** between two bodies A and B are broken by symbolic perturbation: B is translated by e = (eps, eps^2, eps^3)
/// with an infinitesimal eps > 0. Each determinant of points of A and B is linear in e, so its sign at a tie is the
/// sign of the first non-zero component of its gradient. All functions on "perturbed" points of B use the same e, so
/// their answers are consistent. A sign stays zero only for a triangle with collinear vertices, which no edge crosses,
/// and for an edge of A parallel to an edge of B; then neither edge crosses the plane of a triangle at the other.
namespace sixdof {

inline constexpr double k_smallest_exact_coordinate = 0x1p-300;
inline constexpr double k_largest_exact_coordinate = 0x1p+300;

/// Sign of det(b - a, c - a) in the plane: +1 if a, b, c are counter-clockwise, 0 if they are collinear.
int orient2d(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

/// Six times the signed volume of the tetrahedron, det(b - a, c - a, d - a): positive if d lies on the side to which
/// the normal of the counter-clockwise triangle a, b, c points (length^3). Its sign is exact and its relative error at
/// most k_orient3d_relative_error.
double orient3d_value(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                      const Eigen::Vector3d& d);
inline constexpr double k_orient3d_relative_error = 0x1p-40;

namespace detail {

/// The determinant by expansions alone, rounded; its sign is exact.
double orient3d_exact_value(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                            const Eigen::Vector3d& d);

/// Its sign alone, which takes half as long: in numbers of twice the precision, and by expansions where those leave
/// doubt.
int orient3d_exact_sign(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                        const Eigen::Vector3d& d);

/// Sign of the first non-zero component of (b - a) x (d - c); 0 if all are zero.
int lexicographic_cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                        const Eigen::Vector3d& d);

inline int sign_of(double x) { return (x > 0.0 ? 1 : 0) - (x < 0.0 ? 1 : 0); }

/// Shewchuk's bound for the first stage: |error| <= (7 + 56 u) u * permanent, u = 2^-53.
inline constexpr double k_unit_roundoff = 0x1p-53;
inline constexpr double k_orient3d_bound = (7.0 + 56.0 * k_unit_roundoff) * k_unit_roundoff;
/// Added to the bound for gradual underflow: fewer than 32 roundings of at most 2^-1074, each multiplied by at most two
/// differences below 2^301.
inline constexpr double k_underflow_bound = 0x1p-460;

struct Filtered {
  double value;  ///< The determinant in plain floating point.
  double bound;  ///< Largest possible |error| of value.
};

inline Filtered orient3d_filter(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                                const Eigen::Vector3d& d) {
  const double bx = b.x() - a.x(), by = b.y() - a.y(), bz = b.z() - a.z();
  const double cx = c.x() - a.x(), cy = c.y() - a.y(), cz = c.z() - a.z();
  const double dx = d.x() - a.x(), dy = d.y() - a.y(), dz = d.z() - a.z();
  const double bxcy = bx * cy, cxby = cx * by;
  const double cxdy = cx * dy, dxcy = dx * cy;
  const double dxby = dx * by, bxdy = bx * dy;
  const double value = dz * (bxcy - cxby) + bz * (cxdy - dxcy) + cz * (dxby - bxdy);
  const double permanent = std::abs(dz) * (std::abs(bxcy) + std::abs(cxby)) +
                           std::abs(bz) * (std::abs(cxdy) + std::abs(dxcy)) +
                           std::abs(cz) * (std::abs(dxby) + std::abs(bxdy));
  return {value, k_orient3d_bound * permanent + k_underflow_bound};
}

}  // namespace detail

/// The plane of triangle a, b, c: orient3d() of several points, with the triangle's part of the filter computed once.
/// Keeps references to the corners.
class TrianglePlane {
 public:
  TrianglePlane(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) : a_(a), b_(b), c_(c) {
    const Eigen::Vector3d u = b - a, v = c - a;
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3, m = (k + 2) % 3;
      const double left = u[l] * v[m], right = u[m] * v[l];
      minor_[k] = left - right;
      magnitude_[k] = std::abs(left) + std::abs(right);
    }
  }

  /// The determinant in floating point; usually it decides().
  detail::Filtered filter(const Eigen::Vector3d& d) const {
    const double x = d.x() - a_.x(), y = d.y() - a_.y(), z = d.z() - a_.z();
    const double value = x * minor_[0] + y * minor_[1] + z * minor_[2];
    const double permanent = std::abs(x) * magnitude_[0] + std::abs(y) * magnitude_[1] + std::abs(z) * magnitude_[2];
    // The sums of products of orient3d_filter(), expanded along another row: the same bound holds.
    return {value, detail::k_orient3d_bound * permanent + detail::k_underflow_bound};
  }

  /// Sign of det(b - a, c - a, d - a), exact.
  /// @param f the point's filter()
  int sign(const Eigen::Vector3d& d, const detail::Filtered& f) const {
    if (std::abs(f.value) > f.bound) return f.value > 0.0 ? 1 : -1;
    return detail::orient3d_exact_sign(a_, b_, c_, d);
  }

  /// The determinant, as accurate as orient3d_value().
  double value(const Eigen::Vector3d& d, const detail::Filtered& f) const {
    if (std::abs(f.value) * k_orient3d_relative_error > f.bound) return f.value;
    return detail::orient3d_exact_value(a_, b_, c_, d);
  }

 private:
  const Eigen::Vector3d &a_, &b_, &c_;
  double minor_[3], magnitude_[3];
};

/// Exact sign of det(b - a, c - a, d - a); see orient3d_value().
inline int orient3d(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                    const Eigen::Vector3d& d) {
  const detail::Filtered f = detail::orient3d_filter(a, b, c, d);
  if (f.value > f.bound) return 1;
  if (f.value < -f.bound) return -1;
  return detail::orient3d_exact_sign(a, b, c, d);
}

/// Side of the plane of triangle (a, b, c) of A on which the perturbed vertex `d` of B lies: +1 where the normal
/// points. 0 only if a, b, c are collinear.
inline int side_of_perturbed_point(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                                   const Eigen::Vector3d& d) {
  const int sign = orient3d(a, b, c, d);
  return sign != 0 ? sign : detail::lexicographic_cross(a, b, a, c);
}

/// Side of the plane of the perturbed triangle (a, b, c) of B on which vertex `d` of A lies: +1 where the normal
/// points. 0 only if a, b, c are collinear.
inline int side_of_perturbed_plane(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                                   const Eigen::Vector3d& d) {
  const int sign = orient3d(a, b, c, d);
  return sign != 0 ? sign : -detail::lexicographic_cross(a, b, a, c);
}

/// Sign of det(q - p, r - p, s - p) for an edge p, q of A and a perturbed edge r, s of B: the side on which one line
/// passes the other (Plücker's side operator). 0 only if they are parallel.
inline int side_of_perturbed_edge(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r,
                                  const Eigen::Vector3d& s) {
  const int sign = orient3d(p, q, r, s);
  return sign != 0 ? sign : detail::lexicographic_cross(r, s, p, q);
}

}  // namespace sixdof
