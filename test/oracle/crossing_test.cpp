#include <sixdof/oracle/crossing.h>

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_int.hpp>

/// The crossing of two triangles against rational arithmetic, with B translated by a small rational vector.
namespace sixdof {
namespace {

using Eigen::Vector3d;
using Rational = boost::multiprecision::cpp_rational;
using Point = std::array<Rational, 3>;

Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Point operator*(const Rational& s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
Point cross_product(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Rational dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

using ExactTriangle = std::array<Point, 3>;

struct Piercing {
  int side;
  Point at;
};

/// Sides of `edges` that pass through the inside of `triangle`; none of them meets its border.
void collect_piercings(const ExactTriangle& edges, const ExactTriangle& triangle, int first_side,
                       std::vector<Piercing>& found) {
  const Point n = cross_product(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &p = edges[i], &q = edges[(i + 1) % 3];
    const Rational at_p = dot(n, p - triangle[0]), at_q = dot(n, q - triangle[0]);
    if (at_p.sign() * at_q.sign() >= 0) continue;
    const Point x = p + (at_p / (at_p - at_q)) * (q - p);
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point &u = triangle[k], &v = triangle[(k + 1) % 3];
      inside = inside && dot(n, cross_product(v - u, x - u)) > 0;
    }
    if (inside) found.push_back({first_side + static_cast<int>(i), x});
  }
}

/// Lattice coordinates: faces, edges and corners coincide all the time, and triangles are often degenerate.
TriangleCorners lattice_triangle(std::mt19937_64& random, int top) {
  std::uniform_int_distribution<int> digit(0, top);
  TriangleCorners t;
  for (Vector3d& c : t) c = Vector3d(digit(random), digit(random), digit(random));
  return t;
}

TEST(Crossing, TiesAreThoseOfATranslatedBody) {
  // Determinants of lattice points are whole numbers below 1000, so this translation changes signs of zeros only.
  const Rational eps = Rational(1) / (1 << 24);
  const Point e{eps, eps * eps, eps * eps * eps};
  const double tolerance = 1e-6;  // a piercing point moves by eps times the steepness, below 10
  std::mt19937_64 random(17);
  int crossings = 0;
  for (int i = 0; i < 5000; ++i) {
    const TriangleCorners a = lattice_triangle(random, 2), b = lattice_triangle(random, 2);
    ExactTriangle exact_a, exact_b;
    for (std::size_t k = 0; k < 3; ++k) {
      exact_a[k] = {a[k].x(), a[k].y(), a[k].z()};
      exact_b[k] = Point{b[k].x(), b[k].y(), b[k].z()} + e;
    }
    std::vector<Piercing> truth;
    collect_piercings(exact_a, exact_b, 0, truth);
    collect_piercings(exact_b, exact_a, 3, truth);
    const std::optional<Segment> segment = cross(a, b);
    ASSERT_EQ(segment.has_value(), !truth.empty()) << i;
    if (!segment) continue;
    ++crossings;
    ASSERT_EQ(truth.size(), 2u);
    const bool in_order = truth[0].side == segment->start_side;
    const Piercing& start = truth[in_order ? 0 : 1];
    const Piercing& end = truth[in_order ? 1 : 0];
    EXPECT_EQ(segment->start_side, start.side);
    EXPECT_EQ(segment->end_side, end.side);
    const auto expect_near = [&](const Vector3d& x, const Point& y) {
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(x[k], static_cast<double>(y[static_cast<std::size_t>(k)]), tolerance);
    };
    expect_near(segment->start, start.at);
    expect_near(segment->end, end.at);
    // The direction is that of the normals' product, unless a triangle is degenerate and the segment a point.
    const Point d = cross_product(cross_product(exact_a[1] - exact_a[0], exact_a[2] - exact_a[0]),
                                  cross_product(exact_b[1] - exact_b[0], exact_b[2] - exact_b[0]));
    EXPECT_GE(dot(d, end.at - start.at), 0);
  }
  EXPECT_GT(crossings, 250);
}

/// A triangle in the plane through the origin across (1, 2, 3), in units that round: off the plane by a few 1e-17.
TriangleCorners triangle_in_plane(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  const Vector3d u = Vector3d(3.0, 0.0, -1.0).normalized();
  const Vector3d v = Vector3d(1.0, 2.0, 3.0).normalized().cross(u);
  TriangleCorners t;
  const double x = coordinate(random), y = coordinate(random);
  for (Vector3d& c : t) c = (x + size * coordinate(random)) * u + (y + size * coordinate(random)) * v;
  return t;
}

TEST(Crossing, TrianglesAcrossAnEdgeGetTheSamePoint) {
  std::mt19937_64 random(20);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const TriangleCorners b{Vector3d(-9.0, -9.0, 0.0), Vector3d(9.0, -9.0, 0.0), Vector3d(0.0, 9.0, 0.0)};
  for (int i = 0; i < 500; ++i) {
    // The edge from p to q is bisected by the plane of b in every other case.
    const Vector3d p(u(random), u(random), 0.3), q(u(random), u(random), i % 2 == 0 ? -0.3 : -0.4);
    const TriangleCorners left{p, q, Vector3d(u(random), u(random), 0.5)};
    const TriangleCorners right{q, p, Vector3d(u(random), u(random), -0.5)};
    const std::optional<Segment> of_left = cross(left, b), of_right = cross(right, b);
    ASSERT_TRUE(of_left && of_right);
    EXPECT_EQ(of_left->start_side == 0 ? of_left->start : of_left->end,
              of_right->start_side == 0 ? of_right->start : of_right->end);
  }
}

Point exact_point(const Vector3d& p) { return {Rational(p.x()), Rational(p.y()), Rational(p.z())}; }

TEST(Crossing, TrianglesInOnePlaneUpToRoundingAreDecidedExactly) {
  std::mt19937_64 random(19);
  int crossings = 0, apart = 0;
  for (int i = 0; i < 6000; ++i) {
    const TriangleCorners a = triangle_in_plane(random, 0.7), b = triangle_in_plane(random, i % 2 == 0 ? 0.7 : 0.1);
    ExactTriangle exact_a, exact_b;
    for (std::size_t k = 0; k < 3; ++k) {
      exact_a[k] = exact_point(a[k]);
      exact_b[k] = exact_point(b[k]);
    }
    std::vector<Piercing> truth;
    collect_piercings(exact_a, exact_b, 0, truth);
    collect_piercings(exact_b, exact_a, 3, truth);
    const std::optional<Segment> segment = cross(a, b);
    ASSERT_EQ(segment.has_value(), !truth.empty()) << i;
    ++(segment ? crossings : apart);
    EXPECT_FALSE(segment && certainly_apart(a, b));
    EXPECT_EQ(certainly_apart(a, b), certainly_apart(b, a));
  }
  EXPECT_GT(crossings, 150);
  EXPECT_GT(apart, 2000);
}

/// Two fans over the same circle, from apexes beside each other on it, in a plane across no axis.
std::vector<TriangleCorners> fan(int corners, double turn) {
  const Vector3d u = Vector3d(3.0, 0.0, -1.0).normalized();
  const Vector3d v = Vector3d(1.0, 2.0, 3.0).normalized().cross(u);
  const auto rim = [&](int i) {
    const double angle = turn + 2.0 * 3.14159265358979 * i / corners;
    return Vector3d(std::cos(angle) * u + std::sin(angle) * v);
  };
  std::vector<TriangleCorners> triangles;
  for (int i = 1; i + 1 < corners; ++i) triangles.push_back({rim(0), rim(i), rim(i + 1)});
  return triangles;
}

TEST(Crossing, OfFansOverEachOtherFewPairsNeedExactSigns) {
  // The apexes are half a side apart. A triangle overlaps those that it meets on the rim and those near the apexes.
  constexpr int k_corners = 256;
  const std::vector<TriangleCorners> a = fan(k_corners, 0.0);
  const std::vector<TriangleCorners> b = fan(k_corners, 3.14159265358979 / k_corners);
  std::size_t doubtful = 0;
  for (const TriangleCorners& s : a) {
    for (const TriangleCorners& t : b) doubtful += certainly_apart(s, t) ? 0 : 1;
  }
  EXPECT_GE(doubtful, a.size());
  EXPECT_LE(doubtful, a.size() * b.size() / 2 + 8 * a.size());
}

TEST(Crossing, EdgesPierceWhereSegmentsEnd) {
  std::mt19937_64 random(18);
  for (int i = 0; i < 20000; ++i) {
    const TriangleCorners a = lattice_triangle(random, 3), b = lattice_triangle(random, 3);
    const std::optional<Segment> segment = cross(a, b);
    int down = 0, up = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const int of_a = pierce(a[k], a[(k + 1) % 3], b, Perturbed::triangle);
      const int of_b = pierce(b[k], b[(k + 1) % 3], a, Perturbed::edge);
      const int side = static_cast<int>(k);
      for (const auto& [sign, number] : {std::pair(of_a, side), std::pair(-of_b, side + 3)}) {
        // A's sides leave the segment downwards, B's upwards.
        if (sign > 0) {
          ++down;
          ASSERT_TRUE(segment.has_value());
          EXPECT_EQ(segment->end_side, number);
        } else if (sign < 0) {
          ++up;
          ASSERT_TRUE(segment.has_value());
          EXPECT_EQ(segment->start_side, number);
        }
      }
    }
    EXPECT_EQ(down, segment.has_value() ? 1 : 0);
    EXPECT_EQ(up, down);
  }
}

}  // namespace
}  // namespace sixdof
