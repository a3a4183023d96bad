#include <sixdof/geometry/predicates.h>

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_int.hpp>

namespace sixdof {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Rational = boost::multiprecision::cpp_rational;
using RationalVector = std::array<Rational, 3>;

RationalVector exact(const Vector3d& p) { return {Rational(p.x()), Rational(p.y()), Rational(p.z())}; }

RationalVector operator-(const RationalVector& a, const RationalVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

RationalVector operator+(const RationalVector& a, const RationalVector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

RationalVector cross(const RationalVector& a, const RationalVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Rational dot(const RationalVector& a, const RationalVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Rational determinant(const RationalVector& a, const RationalVector& b, const RationalVector& c,
                     const RationalVector& d) {
  return dot(cross(b - a, c - a), d - a);
}

/// A translation too small to change a sign that is not a tie: the coordinates used here are multiples of 2^-60 below
/// 10^4, so their determinants are multiples of 2^-180.
RationalVector infinitesimal() {
  const Rational eps = Rational(1) / pow(boost::multiprecision::cpp_int(2), 400);
  return {eps, eps * eps, eps * eps * eps};
}

int sign(const Rational& x) { return x.sign(); }

class Points {
 public:
  explicit Points(unsigned seed) : random_(seed) {}

  Vector3d generic(double size) { return size * Vector3d(uniform(), uniform(), uniform()); }
  /// On a coarse lattice, where many quadruples are coplanar or collinear.
  Vector3d lattice() { return Vector3d(digit(), digit(), digit()); }
  /// Up to three units in the last place away from a point of the plane through three points.
  Vector3d near_plane(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const double s = uniform(), t = uniform();
    Vector3d p = a + s * (b - a) + t * (c - a);
    for (int k = 0; k < 3; ++k) {
      for (int steps = digit(); steps > 0; --steps) p[k] = std::nextafter(p[k], uniform() > 0.0 ? 1e9 : -1e9);
    }
    return p;
  }
  double uniform() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  int digit() { return std::uniform_int_distribution<int>(0, 3)(random_); }

 private:
  std::mt19937_64 random_;
};

struct Quadruple {
  Vector3d a, b, c, d;
};

std::vector<Quadruple> quadruples() {
  Points points(20261121);
  std::vector<Quadruple> result;
  constexpr int k_each = 400;
  for (int i = 0; i < k_each; ++i) {
    const double size = std::ldexp(1.0, 10 * points.digit() - 15);
    const Vector3d a = points.generic(size), b = points.generic(size), c = points.generic(size);
    result.push_back({a, b, c, points.generic(size)});
    result.push_back({a, b, c, points.near_plane(a, b, c)});
    result.push_back({a, b, points.near_plane(a, b, b), points.near_plane(a, b, a)});
    result.push_back({points.lattice(), points.lattice(), points.lattice(), points.lattice()});
    // Far from the origin, with differences in the last digits only.
    const Vector3d far(1.0e6 / 3.0, -2.0e6 / 7.0, 5.0e5 / 9.0);
    result.push_back({far + 1e-9 * a, far + 1e-9 * b, far + 1e-9 * c, far + 1e-9 * points.lattice()});
    // Coordinates of very different magnitudes.
    result.push_back({a, 1e-25 * b, 1e25 * c, points.near_plane(a, b, c)});
  }
  return result;
}

TEST(Predicates, Orient3dHasTheExactSign) {
  int ties = 0;
  for (const auto& [a, b, c, d] : quadruples()) {
    const Rational truth = determinant(exact(a), exact(b), exact(c), exact(d));
    ties += truth.is_zero();
    EXPECT_EQ(orient3d(a, b, c, d), sign(truth));
    EXPECT_EQ(orient3d(b, a, c, d), -sign(truth));
    EXPECT_EQ(orient3d(d, c, b, a), sign(truth));  // an even permutation
    EXPECT_EQ(detail::sign_of(detail::orient3d_exact_value(c, d, a, b)), sign(truth));
    EXPECT_EQ(detail::orient3d_exact_sign(c, d, a, b), sign(truth));
  }
  EXPECT_GT(ties, 100);
}

TEST(Predicates, SignsAreExactWhateverPrecisionTheyTake) {
  // A corner lifted off a plane across no axis by 2^-20 .. 2^-140 of the size: floats, numbers of twice the precision,
  // and expansions decide some each. All coordinates are multiples of 2^-160.
  const Vector3d a(0.0, 0.0, 0.0), b(1.0, 0.0, 0.5), c(0.0, 1.0, 0.25);
  int positive = 0;
  for (int power = 20; power <= 140; ++power) {
    for (const double s : {1.0, -1.0, 0.0}) {
      const Vector3d d(0.0, 0.0, s * std::ldexp(1.0, -power));
      for (const Vector3d& shift : {Vector3d(0, 0, 0), Vector3d(1, 2, 1), Vector3d(3, -1, 1.25)}) {
        // In the plane z = x / 2 + y / 4, shifted along it: the rest of d's height is lost where the sum rounds.
        const Vector3d at(shift.x(), shift.y(), 0.5 * shift.x() + 0.25 * shift.y());
        const Vector3d p = at + d;
        const int truth = sign(determinant(exact(a), exact(b), exact(c), exact(p)));
        EXPECT_EQ(orient3d(a, b, c, p), truth) << power;
        EXPECT_EQ(detail::orient3d_exact_sign(a, b, c, p), truth) << power;
        EXPECT_EQ(detail::orient3d_exact_sign(b, a, c, p), -truth) << power;
        positive += truth > 0;
      }
    }
  }
  EXPECT_GT(positive, 150);
}

TEST(Predicates, Orient3dValueIsAccurateAtAnyMagnitude) {
  for (const auto& [a, b, c, d] : quadruples()) {
    const Rational truth = determinant(exact(a), exact(b), exact(c), exact(d));
    const Rational error = abs(Rational(orient3d_value(a, b, c, d)) - truth);
    EXPECT_LE(error, Rational(k_orient3d_relative_error) * abs(truth));
  }
}

TEST(Predicates, Orient2dHasTheExactSign) {
  for (const auto& [a, b, c, d] : quadruples()) {
    const RationalVector u = exact(b) - exact(a), v = exact(c) - exact(a);
    EXPECT_EQ(orient2d(a.head<2>(), b.head<2>(), c.head<2>()), sign(u[0] * v[1] - u[1] * v[0]));
    EXPECT_EQ(orient2d(a.tail<2>(), c.tail<2>(), b.tail<2>()), -sign(u[1] * v[2] - u[2] * v[1]));
  }
}

TEST(Predicates, AreExactInTheDocumentedRange) {
  Points points(7);
  for (int i = 0; i < 300; ++i) {
    for (const double size : {4.0 * k_smallest_exact_coordinate, k_largest_exact_coordinate / 4.0}) {
      // Integer multiples, so that every coordinate is in the range; some are changed in the last bit.
      const auto point = [&] {
        Vector3d p = size * points.lattice();
        if (points.digit() == 0) p.x() = std::nextafter(p.x(), size);
        return p;
      };
      const Vector3d a = point(), b = point(), c = point(), d = point();
      const auto in_range = [](const Vector3d& p) {
        return (p.array() == 0.0 || p.array().abs() >= k_smallest_exact_coordinate).all();
      };
      if (!in_range(a) || !in_range(b) || !in_range(c) || !in_range(d)) continue;
      EXPECT_EQ(orient3d(a, b, c, d), sign(determinant(exact(a), exact(b), exact(c), exact(d)))) << size;
    }
  }
}

TEST(Predicates, BreakTiesByOneTranslationOfB) {
  const RationalVector e = infinitesimal();
  int ties = 0;
  Points points(99);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d a = points.lattice(), b = points.lattice(), c = points.lattice(), d = points.lattice();
    ties += orient3d(a, b, c, d) == 0;
    EXPECT_EQ(side_of_perturbed_point(a, b, c, d), sign(determinant(exact(a), exact(b), exact(c), exact(d) + e)));
    EXPECT_EQ(side_of_perturbed_plane(a, b, c, d),
              sign(determinant(exact(a) + e, exact(b) + e, exact(c) + e, exact(d))));
    EXPECT_EQ(side_of_perturbed_edge(a, b, c, d), sign(determinant(exact(a), exact(b), exact(c) + e, exact(d) + e)));
  }
  EXPECT_GT(ties, 150);
}

TEST(Predicates, AreZeroForDegenerateFiguresOnly) {
  Points points(5);
  for (int i = 0; i < 3000; ++i) {
    const Vector3d a = points.lattice(), b = points.lattice(), c = points.lattice(), d = points.lattice();
    const bool collinear = (b - a).cross(c - a).isZero(0.0);  // small integers: exact
    const bool parallel = (b - a).cross(d - c).isZero(0.0);
    EXPECT_EQ(side_of_perturbed_point(a, b, c, d) == 0, collinear);
    EXPECT_EQ(side_of_perturbed_plane(a, b, c, d) == 0, collinear);
    if (side_of_perturbed_edge(a, b, c, d) == 0) {
      EXPECT_TRUE(parallel);
    }
  }
}

}  // namespace
}  // namespace sixdof
