#include <sixdof/algorithm/ist/coverage.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/algorithm/ist/ist.h>
#include <sixdof/algorithm/ist/packing.h>
#include <sixdof/models/recipe.h>
#include <sixdof/stability/answers.h>

namespace sixdof::ist {
namespace {

/// Points drawn evenly from a triangle.
class TrianglePoints {
 public:
  explicit TrianglePoints(const Mesh& mesh) : mesh_(mesh) {}

  const Eigen::Vector3d& corner(std::size_t triangle, std::size_t i) const {
    return mesh_.vertices()[mesh_.triangles()[triangle][i]];
  }
  double area(std::size_t triangle) const {
    const Eigen::Vector3d& p = corner(triangle, 0);
    return 0.5 * (corner(triangle, 1) - p).cross(corner(triangle, 2) - p).norm();
  }
  Eigen::Vector3d draw(std::size_t triangle, std::mt19937_64& random) const {
    std::uniform_real_distribution<double> part(0.0, 1.0);
    double u = part(random), v = part(random);
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    return (1.0 - u - v) * corner(triangle, 0) + u * corner(triangle, 1) + v * corner(triangle, 2);
  }

 private:
  const Mesh& mesh_;
};

/// The sphere nearest to a point, by all of them.
double gap(const Eigen::Vector3d& p, std::span<const Sphere> spheres) {
  double least = std::numeric_limits<double>::infinity();
  for (const Sphere& sphere : spheres) least = std::min(least, (p - sphere.center).norm() - sphere.radius);
  return least;
}

/// The largest gap of many points: the vertices, points drawn evenly from the surface, and many more from the triangles
/// where those found the largest gaps. It is below the surface's by what the points miss.
double largest_gap_by_points(const Mesh& mesh, std::span<const Sphere> spheres) {
  constexpr std::size_t k_points = 20'000, k_searched = 20, k_points_of_each = 2'000;
  std::mt19937_64 random(20261126);
  const TrianglePoints points(mesh);
  std::vector<double> areas, largest(mesh.triangles().size());
  for (std::size_t i = 0; i < largest.size(); ++i) {
    areas.push_back(points.area(i));
    for (std::size_t k = 0; k < 3; ++k) largest[i] = std::max(largest[i], gap(points.corner(i, k), spheres));
  }
  std::discrete_distribution<std::size_t> which(areas.begin(), areas.end());
  const auto look = [&](std::size_t triangle) {
    largest[triangle] = std::max(largest[triangle], gap(points.draw(triangle, random), spheres));
  };
  for (std::size_t i = 0; i < k_points; ++i) look(which(random));
  std::vector<std::size_t> order(largest.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, std::ranges::greater(), [&](std::size_t i) { return largest[i]; });
  order.resize(std::min(order.size(), k_searched));
  for (const std::size_t triangle : order) {
    for (std::size_t i = 0; i < k_points_of_each; ++i) look(triangle);
  }
  return std::ranges::max(largest);
}

/// The surface of the spheres lies within the gap of the mesh's, on both sides.
TEST(Coverage, NoPointOfTheSurfaceIsFartherFromTheSpheresThanTheGap) {
  const Mesh bodies[] = {make_box({}, 12), make_bumpy_sphere({}, 1000), make_circular_box({}, 2000)};
  for (const Mesh& mesh : bodies) {
    for (const std::size_t spheres : {100u, 1000u}) {
      const Packing packing = pack_spheres(mesh, {.spheres = spheres});
      const double declared = largest_gap(mesh, packing.spheres);
      const double found = largest_gap_by_points(mesh, packing.spheres);
      EXPECT_LE(found, declared) << mesh.name() << ' ' << spheres;
      EXPECT_GE((1.0 + 3.0 * k_gap_tolerance) * found, declared) << mesh.name() << ' ' << spheres << ": too large";
    }
  }
}

TEST(Coverage, OfOneSphereInABoxIsTheWayToACorner) {
  const Mesh box = make_box({.size = {2.0, 2.0, 2.0}}, 12);
  const Sphere ball{.center = Eigen::Vector3d::Zero(), .radius = 1.0};
  const double corner = std::sqrt(3.0) - 1.0, found = largest_gap(box, {&ball, 1});
  EXPECT_GE(found, corner);
  EXPECT_LE(found, (1.0 + k_gap_tolerance) * corner);
}

TEST(Coverage, DistancesAreWithinTheDeclaredResolutionOfTheExactOnes) {
  const Mesh a = make_bumpy_sphere({}, 1000), b = make_circular_box({}, 2000);
  const auto exact = make_exact_algorithm();
  const auto truth = exact->prepare(a, b, exact->settings());
  for (const auto& algorithm : {make_ist_algorithm(), make_ist_descent_algorithm()}) {
    for (const char* spheres : {"300", "3000"}) {
      Settings settings = algorithm->settings();
      settings.set("spheres", spheres);
      const auto query = algorithm->prepare(a, b, settings);
      const double resolution = stability::declared_resolution(*query);
      ASSERT_GT(resolution, 0.0);
      double largest = 0.0;
      std::mt19937_64 random(7);
      std::normal_distribution<double> normal;
      for (int i = 0; i < 200; ++i) {
        const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
        const Eigen::Vector3d u(normal(random), normal(random), normal(random));
        const Pose X{q.normalized().toRotationMatrix(), (1.5 + 0.01 * i) * u.normalized()};
        const double error = query->distance(X).value.distance - truth->distance(X).value.distance;
        constexpr double k_rounding = 1e-15;
        EXPECT_GE(error, -k_rounding) << i;
        EXPECT_LE(error, resolution) << i;
        largest = std::max(largest, error);
      }
      EXPECT_GE(largest, 0.1 * resolution) << "a resolution that says nothing";
    }
  }
}

}  // namespace
}  // namespace sixdof::ist
