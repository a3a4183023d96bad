#include <sixdof/algorithm/ist/coverage.h>

#include <cmath>
#include <limits>
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

/// The vertices, and points drawn evenly from the surface.
std::vector<Eigen::Vector3d> surface_points(const Mesh& mesh, std::size_t count) {
  std::mt19937_64 random(20261126);
  std::vector<double> areas;
  const auto corner = [&](const Triangle& t, std::size_t i) -> const Eigen::Vector3d& { return mesh.vertices()[t[i]]; };
  for (const Triangle& t : mesh.triangles()) {
    areas.push_back((corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).norm());
  }
  std::discrete_distribution<std::size_t> which(areas.begin(), areas.end());
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::vector<Eigen::Vector3d> points = mesh.vertices();
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle& t = mesh.triangles()[which(random)];
    double u = part(random), v = part(random);
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    points.push_back((1.0 - u - v) * corner(t, 0) + u * corner(t, 1) + v * corner(t, 2));
  }
  return points;
}

/// The sphere nearest to a point, by all of them.
double gap(const Eigen::Vector3d& p, std::span<const Sphere> spheres) {
  double least = std::numeric_limits<double>::infinity();
  for (const Sphere& sphere : spheres) least = std::min(least, (p - sphere.center).norm() - sphere.radius);
  return least;
}

/// The surface of the spheres lies within the gap of the mesh's, on both sides.
TEST(Coverage, NoPointOfTheSurfaceIsFartherFromTheSpheresThanTheGap) {
  constexpr std::size_t k_points = 20'000;
  const Mesh bodies[] = {make_box({}, 12), make_bumpy_sphere({}, 1000), make_circular_box({}, 2000)};
  for (const Mesh& mesh : bodies) {
    for (const std::size_t spheres : {100u, 1000u}) {
      const Packing packing = pack_spheres(mesh, {.spheres = spheres});
      const double declared = largest_gap(mesh, packing.spheres);
      double found = 0.0;
      for (const Eigen::Vector3d& p : surface_points(mesh, k_points)) found = std::max(found, gap(p, packing.spheres));
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
