#include <sixdof/algorithm/ist/cells.h>

#include <random>

#include <gtest/gtest.h>

#include <sixdof/algorithm/ist/packing.h>
#include <sixdof/base/parallel.h>
#include <sixdof/models/boxes.h>
#include <sixdof/models/model_catalogue.h>

namespace sixdof::ist {
namespace {

constexpr double k_rounding = 1e-12;  // relative, of sums over some hundred spheres

double total(std::span<const Sphere> spheres, std::span<const double> shares) {
  double sum = 0.0;
  for (std::size_t i = 0; i < spheres.size(); ++i) sum += shares[i] * spheres[i].volume();
  return sum;
}

/// In a convex body nothing is behind a wall: every point counts for the sphere whose surface is nearest.
TEST(Cells, AreThePartsOfABoxNearestToEachSphere) {
  const Eigen::Vector3d size(1.3, 1.0, 0.7);
  const Mesh box = make_box({.size = size}, 12);
  const Tree tree(box);
  const Packing packing = pack_spheres(box, tree, {.spheres = 60});
  const std::vector<double> shares = cell_shares(box, tree, packing.spheres);

  constexpr int k_points = 400'000;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(-0.5, 0.5);
  std::vector<int> hits(packing.spheres.size());
  for (int n = 0; n < k_points; ++n) {
    const double x = place(random), y = place(random), z = place(random);
    const Eigen::Vector3d p = size.cwiseProduct(Eigen::Vector3d(x, y, z));
    const auto clearance = [&](const Sphere& s) { return (p - s.center).norm() - s.radius; };
    const auto nearest = std::ranges::min_element(packing.spheres, {}, clearance);
    ++hits[static_cast<std::size_t>(nearest - packing.spheres.begin())];
  }
  double squares = 0.0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double share = hits[i] / static_cast<double>(k_points) * box.volume() / packing.spheres[i].volume();
    EXPECT_NEAR(shares[i], share, 0.15 * share) << i;  // 96 rays a sphere, some thousand points
    squares += (shares[i] / share - 1.0) * (shares[i] / share - 1.0);
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(shares.size())), 0.06);
}

TEST(Cells, FillTheSolid) {
  for (const char* name : {"torus-knot-1k", "circular-box-1k", "bumpy-sphere-1k"}) {
    const Mesh mesh = load_model(name);
    const Tree tree(mesh);
    const Packing packing = pack_spheres(mesh, tree, {.spheres = 300});
    const std::vector<double> shares = cell_shares(mesh, tree, packing.spheres);
    ASSERT_EQ(shares.size(), packing.spheres.size());
    EXPECT_GE(*std::ranges::min_element(shares), 1.0) << name;
    EXPECT_NEAR(total(packing.spheres, shares), mesh.volume(), k_rounding * mesh.volume()) << name;
    // A sphere stands for a few times itself at most: its neighbours and the wall are near.
    EXPECT_LT(*std::ranges::max_element(shares), 40.0) << name;
  }
}

TEST(Cells, DoNotDependOnTheNumberOfThreads) {
  const Mesh mesh = load_model("torus-knot-1k");
  const Tree tree(mesh);
  const Packing packing = pack_spheres(mesh, tree, {.spheres = 200});
  const auto shares_with = [&](std::size_t threads) {
    const parallel::ThreadLimit limit(threads);
    return cell_shares(mesh, tree, packing.spheres);
  };
  EXPECT_EQ(shares_with(1), shares_with(2));
}

}  // namespace
}  // namespace sixdof::ist
