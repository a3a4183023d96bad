#include <sixdof/geometry/triangulate.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

using Points = std::vector<Eigen::Vector3d>;

// Sums of a few hundred products of numbers near 1.
constexpr double k_rounding = 1e-11;

std::vector<std::uint32_t> all_of(const Points& points) {
  std::vector<std::uint32_t> corners(points.size());
  std::iota(corners.begin(), corners.end(), 0u);
  return corners;
}

/// Maps a polygon of the plane into a generic plane in space.
Points in_space(const std::vector<Eigen::Vector2d>& flat, double scale = 1.0) {
  const Eigen::Vector3d u = Eigen::Vector3d(0.31, -0.77, 0.42).normalized();
  const Eigen::Vector3d v = u.cross(Eigen::Vector3d(-0.2, 0.9, 0.7)).normalized();
  Points points;
  for (const auto& p : flat) points.push_back(scale * (Eigen::Vector3d(0.7, -1.3, 2.9) + p.x() * u + p.y() * v));
  return points;
}

Eigen::Vector3d area_vector(const Points& p, const std::vector<Triangle>& triangles) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Triangle& t : triangles) sum += 0.5 * (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
  return sum;
}

double area(const Points& p, const std::vector<Triangle>& triangles) {
  double sum = 0.0;
  for (const Triangle& t : triangles) sum += 0.5 * (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).norm();
  return sum;
}

Eigen::Vector3d polygon_area(const Points& p) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < p.size(); ++i) sum += 0.5 * (p[i] - p[0]).cross(p[i + 1] - p[0]);
  return sum;
}

/// A covering without folds: as many triangles as it takes, and their areas add up to the polygon's.
void expect_covered(const Points& points, const std::string& what) {
  std::vector<Triangle> triangles;
  ASSERT_EQ(triangulate(all_of(points), points, triangles), PolygonShape::simple) << what;
  ASSERT_EQ(triangles.size(), points.size() - 2) << what;
  const Eigen::Vector3d exact = polygon_area(points);
  EXPECT_LE((area_vector(points, triangles) - exact).norm(), k_rounding * exact.norm()) << what;
  EXPECT_LE(std::abs(area(points, triangles) - exact.norm()), k_rounding * exact.norm()) << what;
}

TEST(Triangulate, ConvexPolygonBecomesAFan) {
  std::vector<Eigen::Vector2d> flat;
  for (int i = 0; i < 7; ++i) flat.emplace_back(2.0 * std::cos(0.9 * i), 1.1 * std::sin(0.9 * i));
  const Points points = in_space(flat);
  std::vector<Triangle> triangles;
  ASSERT_EQ(triangulate(all_of(points), points, triangles), PolygonShape::simple);
  EXPECT_EQ(triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 6}}));
}

TEST(Triangulate, ConcaveFacesGetTheirOwnSurfaceFromEveryStartAndAtEveryScale) {
  const std::vector<Eigen::Vector2d> arrow{{0.0, 0.0}, {2.1, -1.3}, {0.7, 0.1}, {1.9, 1.7}};
  const std::vector<Eigen::Vector2d> comb{{0, 0},   {7, 0.2}, {6.9, 3}, {6, 3.1}, {5.9, 1},   {5, 1.1},
                                          {4.8, 3}, {4, 3.2}, {3.9, 1}, {3, 1.2}, {2.8, 3.3}, {0.1, 3}};
  for (const auto& shape : {arrow, comb}) {
    for (const double scale : {1.0, 1e-6, 1e6, 1e-200}) {
      std::vector<Eigen::Vector2d> flat = shape;
      for (std::size_t start = 0; start < flat.size(); ++start) {
        std::rotate(flat.begin(), flat.begin() + 1, flat.end());
        if (scale > 1e-100) expect_covered(in_space(flat, scale), "start " + std::to_string(start));
        std::vector<Triangle> triangles;
        const Points points = in_space(flat, scale);
        EXPECT_EQ(triangulate(all_of(points), points, triangles), PolygonShape::simple);
        Points backwards(points.rbegin(), points.rend());
        if (scale > 1e-100) expect_covered(backwards, "backwards");
      }
    }
  }
}

TEST(Triangulate, StarsOfManyCornersAreCovered) {
  std::mt19937_64 generator(20240607);
  std::uniform_real_distribution<double> radius(0.2, 3.0);
  for (const std::size_t n : {5u, 12u, 40u, 211u}) {
    std::vector<Eigen::Vector2d> flat;
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
      flat.push_back(radius(generator) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    expect_covered(in_space(flat), std::to_string(n) + " corners");
  }
}

TEST(Triangulate, CornersOnAStraightSideSurvive) {
  // Coordinates that keep the corners of a side exactly on a line.
  const Points points{{0, 0, 3}, {1, 0, 3}, {2, 0, 3}, {3, 0, 3}, {3, 2, 3}, {1.5, 2, 3}, {0, 2, 3}};
  expect_covered(points, "sides with corners on them");
  std::vector<Triangle> triangles;
  triangulate(all_of(points), points, triangles);
  for (const Triangle& t : triangles) EXPECT_GT(area(points, {t}), 0.0);
}

TEST(Triangulate, KeyholeAndRepeatedCornerAreCovered) {
  // A square with a square hole, cut open along a bridge that is run through twice.
  const Points keyhole{{0, 0, 1}, {4, 0, 1}, {4, 4, 1}, {0, 4, 1}, {0, 0, 1},
                       {1, 1, 1}, {1, 3, 1}, {3, 3, 1}, {3, 1, 1}, {1, 1, 1}};
  expect_covered(keyhole, "keyhole");
  const Points repeated{{0, 0, 1}, {4, 0, 1}, {4, 0, 1}, {4, 4, 1}, {0, 4, 1}};
  expect_covered(repeated, "repeated corner");
}

TEST(Triangulate, NoAreaYieldsFlatTrianglesThatKeepTheSurfaceClosed) {
  const Points line{{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {3, 0, 1}};
  std::vector<Triangle> triangles;
  EXPECT_EQ(triangulate(all_of(line), line, triangles), PolygonShape::simple);
  EXPECT_EQ(triangles.size(), 2u);
}

TEST(Triangulate, PolygonsThatCrossThemselvesAreTriangulatedWithTheirBoundary) {
  std::vector<Eigen::Vector2d> pentagram;
  for (int i = 0; i < 5; ++i)
    pentagram.emplace_back(std::cos(0.8 * std::numbers::pi * i), std::sin(0.8 * std::numbers::pi * i));
  const Points star = in_space(pentagram);
  std::vector<Triangle> triangles;
  EXPECT_EQ(triangulate(all_of(star), star, triangles), PolygonShape::crossing);
  EXPECT_EQ(triangles.size(), 3u);
  EXPECT_LE((area_vector(star, triangles) - polygon_area(star)).norm(), k_rounding);
  // Opposite areas, equal and unequal.
  for (const double x : {1.0, 1.3}) {
    const Points bow_tie = in_space({{0, 0}, {x, 1}, {1, 0}, {0, 1}});
    triangles.clear();
    EXPECT_EQ(triangulate(all_of(bow_tie), bow_tie, triangles), PolygonShape::crossing) << x;
    EXPECT_EQ(triangles.size(), 2u) << x;
  }
  // Random polygons: most of them cross themselves, often many times.
  std::mt19937_64 generator(20250311);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  for (const std::size_t n : {4u, 7u, 30u, 300u}) {
    std::vector<Eigen::Vector2d> flat;
    for (std::size_t i = 0; i < n; ++i) flat.emplace_back(coordinate(generator), coordinate(generator));
    const Points points = in_space(flat);
    triangles.clear();
    triangulate(all_of(points), points, triangles);
    EXPECT_EQ(triangles.size(), n - 2);
    EXPECT_LE((area_vector(points, triangles) - polygon_area(points)).norm(), k_rounding);
  }
}

TEST(Triangulate, PolygonsThatAreNotFlatAreNamedAtEveryScale) {
  const std::vector<Eigen::Vector2d> square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const std::vector<Eigen::Vector2d> arrow{{0.0, 0.0}, {2.1, -1.3}, {0.7, 0.1}, {1.9, 1.7}};
  for (const auto& shape : {square, arrow}) {
    for (const double scale : {1e-100, 1.0, 1e6}) {
      Points points = in_space(shape, scale);
      std::vector<Triangle> triangles;
      const double largest = points[2].cwiseAbs().maxCoeff();
      const Eigen::Vector3d normal = polygon_area(in_space(shape)).normalized();
      points[2] += 0.5 * k_flatness * largest * normal;
      EXPECT_EQ(triangulate(all_of(points), points, triangles), PolygonShape::simple) << scale;
      // The other corners' plane follows a lifted corner: a quarter of its height is left in a square.
      points[2] += 8.0 * k_flatness * largest * normal;
      EXPECT_EQ(triangulate(all_of(points), points, triangles), PolygonShape::not_flat) << scale;
    }
  }
}

TEST(Triangulate, ConcaveGiantsAreTooLarge) {
  std::vector<Triangle> triangles;
  std::vector<Eigen::Vector2d> flat;
  const std::size_t n = k_most_corners_of_a_concave_polygon + 1;
  for (std::size_t i = 0; i < n; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
    flat.push_back((i == 77 ? 0.5 : 1.0) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  const Points giant = in_space(flat);
  EXPECT_EQ(triangulate(all_of(giant), giant, triangles), PolygonShape::too_large);
  EXPECT_TRUE(triangles.empty());
  flat[77] *= 2.0;  // convex again: a fan has no such limit
  const Points round = in_space(flat);
  EXPECT_EQ(triangulate(all_of(round), round, triangles), PolygonShape::simple);
  EXPECT_EQ(triangles.size(), n - 2);
}

}  // namespace
}  // namespace sixdof
