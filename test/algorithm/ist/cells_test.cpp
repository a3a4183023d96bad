#include <sixdof/algorithm/ist/packing.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/base/parallel.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/models/recipe.h>

namespace sixdof::ist {
namespace {

constexpr double k_cell_sampling = 0.15;  // relative: of a volume from rays in some hundred directions

constexpr double k_rounding = 1e-12;  // relative, of sums over some hundred spheres

double total(std::span<const Sphere> spheres, std::span<const double> weights) {
  double sum = 0.0;
  for (std::size_t i = 0; i < spheres.size(); ++i) sum += weights[i] * spheres[i].volume();
  return sum;
}

/// In a convex body a cell is all points for which the sphere's surface is the nearest.
TEST(Cells, AreThePartsOfABoxNearestToEachSphere) {
  const Eigen::Vector3d size(1.3, 1.0, 0.7);
  const Mesh box = make_box({.size = size}, 12);
  const Packing packing = pack_spheres(box, {.spheres = 60});
  const std::vector<double> weights = cell_weights(box, packing.spheres);

  constexpr int k_points = 400'000;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> coordinate(-0.5, 0.5);
  std::vector<int> hits(packing.spheres.size());
  for (int n = 0; n < k_points; ++n) {
    const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
    const Eigen::Vector3d p = size.cwiseProduct(Eigen::Vector3d(x, y, z));
    const auto clearance = [&](const Sphere& s) { return (p - s.center).norm() - s.radius; };
    const auto nearest = std::ranges::min_element(packing.spheres, {}, clearance);
    ++hits[static_cast<std::size_t>(nearest - packing.spheres.begin())];
  }
  double squares = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double expected = hits[i] / static_cast<double>(k_points) * box.volume() / packing.spheres[i].volume();
    EXPECT_NEAR(weights[i], expected, k_cell_sampling * expected) << i;  // 96 rays a sphere, some thousand points
    squares += (weights[i] / expected - 1.0) * (weights[i] / expected - 1.0);
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(weights.size())), 0.06);
}

TEST(Cells, FillTheSolid) {
  for (const char* name : {"torus-knot-1k", "circular-box-1k", "bumpy-sphere-1k"}) {
    const Mesh mesh = load_model(name);
    const Packing packing = pack_spheres(mesh, {.spheres = 300});
    const std::vector<double> weights = cell_weights(mesh, packing.spheres);
    ASSERT_EQ(weights.size(), packing.spheres.size());
    EXPECT_GE(*std::ranges::min_element(weights), 1.0) << name;
    EXPECT_NEAR(total(packing.spheres, weights), mesh.volume(), k_rounding * mesh.volume()) << name;
    // A cell is a few times its sphere at most, since other spheres or the surface are near.
    EXPECT_LT(*std::ranges::max_element(weights), 40.0) << name;
  }
}

TEST(Cells, DoNotDependOnTheNumberOfThreads) {
  const Mesh mesh = load_model("torus-knot-1k");
  const Packing packing = pack_spheres(mesh, {.spheres = 200});
  const auto weights_with = [&](unsigned threads) {
    decltype(cell_weights(mesh, packing.spheres)) weights;
    parallel::with_threads(threads, [&] { weights = cell_weights(mesh, packing.spheres); });
    return weights;
  };
  EXPECT_EQ(weights_with(1), weights_with(2));
}

}  // namespace
}  // namespace sixdof::ist
