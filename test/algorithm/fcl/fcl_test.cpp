#include <sixdof/algorithm/fcl/fcl.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>

namespace sixdof {
namespace {

using Eigen::Vector3d;

/// Both sides compute a few products of numbers of the order of 1, in different orders: less than a hundred roundings.
constexpr double k_rounding = 100 * std::numeric_limits<double>::epsilon();

Pose generic_pose(std::mt19937_64& random, double reach) {
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond q =
      Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized();
  return {q.toRotationMatrix(), reach * Vector3d(normal(random), normal(random), normal(random)).normalized()};
}

/// A closed star-shaped body: a globe of rings x sectors whose radius varies, so that all kinds of closest features
/// occur.
Mesh lumpy_globe(int rings, int sectors, double lump, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> radius(1.0 - lump, 1.0);
  std::vector<Vector3d> vertices = {{0, 0, radius(random)}, {0, 0, -radius(random)}};
  for (int i = 1; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const double theta = std::numbers::pi * i / rings;
      const double phi = 2 * std::numbers::pi * j / sectors;
      vertices.push_back(radius(random) *
                         Vector3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(2 + (i - 1) * sectors + j % sectors); };
  std::vector<Triangle> triangles;
  for (int j = 0; j < sectors; ++j) {
    triangles.push_back({0, at(1, j), at(1, j + 1)});
    triangles.push_back({1, at(rings - 1, j + 1), at(rings - 1, j)});
    for (int i = 1; i + 1 < rings; ++i) {
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return Mesh::build(std::move(vertices), std::move(triangles), "lumpy-globe");
}

std::vector<std::unique_ptr<Algorithm>> with_distance() {
  std::vector<std::unique_ptr<Algorithm>> list;
  list.push_back(make_fcl_obbrss_algorithm());
  list.push_back(make_fcl_rss_algorithm());
  list.push_back(make_fcl_kios_algorithm());
  return list;
}

double brute_force_distance(const Mesh& a, const Mesh& b, const Pose& X_AB) {
  const auto algorithm = make_brute_force_algorithm();
  return algorithm->prepare(a, b, algorithm->settings())->distance(X_AB).value.distance;
}

class FclAgainstBruteForce : public ::testing::Test {
 protected:
  const Mesh a = lumpy_globe(5, 7, 0.4, 11);
  const Mesh b = lumpy_globe(4, 6, 0.3, 12);
};

TEST_F(FclAgainstBruteForce, BoundsTheApproximateDistance) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> reach(2.1, 3.0);
  for (const auto& algorithm : with_distance()) {
    Settings settings = algorithm->settings();
    settings.set("relative_error", "0.25");
    const auto query = algorithm->prepare(a, b, settings);
    int inexact = 0;
    for (int i = 0; i < 60; ++i) {
      const Pose X_AB = generic_pose(random, reach(random));
      const double truth = brute_force_distance(a, b, X_AB);
      const auto answer = query->distance(X_AB);
      ASSERT_TRUE(answer.ok());
      EXPECT_GE(answer.value.distance, truth - k_rounding);
      EXPECT_LE(answer.value.distance, 1.25 * truth + k_rounding);
      inexact += answer.value.distance > truth + k_rounding;
    }
    // The parameter must have an effect.
    EXPECT_GT(inexact, 0) << algorithm->traits().name;
  }
}

TEST(Fcl, CountsSharedTreesOnce) {
  const Mesh a = lumpy_globe(9, 10, 0.2, 5);
  const Mesh same = Mesh::build(a.vertices(), a.triangles(), "another name");
  const Mesh other = lumpy_globe(9, 10, 0.2, 6);
  for (const auto& algorithm : with_distance()) {
    const Footprint shared = algorithm->prepare(a, same, algorithm->settings())->footprint();
    const Footprint apart = algorithm->prepare(a, other, algorithm->settings())->footprint();
    EXPECT_EQ(apart.bytes, 2 * shared.bytes);
    const auto n = static_cast<double>(a.triangles().size());
    // A binary tree with one triangle in each leaf.
    EXPECT_THAT(shared.counts, ::testing::ElementsAre(std::pair("nodes", 2 * n - 1), std::pair("triangles", n)));
    EXPECT_GT(shared.bytes, a.triangles().size() * 2 * sizeof(double) * 15);
  }
}

TEST(Fcl, RegistersAllWithTheLibrarysVersion) {
  Registry registry;
  register_fcl_algorithms(registry);
  EXPECT_THAT(registry.find("fcl-obbrss").traits().version, ::testing::StartsWith("0."));
  EXPECT_FALSE(registry.find("fcl-rss").traits().answers.collide);
  EXPECT_TRUE(registry.find("fcl-cast").traits().answers.cast);
  EXPECT_EQ(registry.all().size(), 7u);
}

}  // namespace
}  // namespace sixdof
