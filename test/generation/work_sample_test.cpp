#include <sixdof/generation/work_sample.h>

#include <ctime>

#include <algorithm>
#include <limits>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

#include "../configuration/shard_job.h"

namespace sixdof {
namespace {

/// Uses processor time in known parts and records its arguments. Every target of the direction +z is unreachable.
struct BurningSolver final : RaySolver {
  static void burn(double seconds) {
    const std::clock_t end = std::clock() + static_cast<std::clock_t>(seconds * CLOCKS_PER_SEC);
    while (std::clock() < end) {
    }
  }
  void set_rotation(const Eigen::Vector4d& /*rotation*/) override {
    ++rotations;
    burn(4e-3);
  }
  void solve(const Eigen::Vector3d& direction, std::span<const double> /*targets*/, std::span<double> translations,
             std::span<double> /*residuals*/) override {
    directions.push_back(direction);
    const bool reachable = direction.z() != 1.0;
    std::ranges::fill(translations, reachable ? 1.0 : std::numeric_limits<double>::quiet_NaN());
    burn(reachable ? 1e-3 : 20e-3);
  }
  std::uint64_t measurements() const override { return 0; }

  std::size_t rotations = 0;
  std::vector<Eigen::Vector3d> directions;
};

const Grid k_grid = make_grid("45");
const std::vector<double> k_targets{2.0, 1.0};

TEST(RayRuns, SeedDecidesAndDistinctRotationsAreDrawn) {
  RayRuns one(k_grid, 5), same(k_grid, 5), other(k_grid, 6);
  const DistinctRotations distinct(k_grid.rotations);
  std::set<std::size_t> rotations;
  std::size_t different = 0;
  constexpr std::size_t k_draws = 2000;
  for (std::size_t i = 0; i < k_draws; ++i) {
    const RayRun run = one.next();
    const RayRun again = same.next();
    EXPECT_EQ(run.rotation, again.rotation);
    EXPECT_EQ(run.first_direction, again.first_direction);
    EXPECT_LT(run.first_direction, k_grid.directions.size());
    EXPECT_TRUE(std::ranges::binary_search(distinct.first, run.rotation));
    different += other.next().rotation != run.rotation ? 1 : 0;
    rotations.insert(run.rotation);
  }
  EXPECT_GT(different, k_draws / 2);
  EXPECT_GT(rotations.size(), distinct.first.size() * 9 / 10);
}

TEST(WorkSample, RunsNeighboursAfterOneThatIsNotCounted) {
  BurningSolver solver;
  const RayRun run{.rotation = 7, .first_direction = k_grid.directions.size() - 2, .directions = 4};
  const RunCost cost = time_run(solver, k_grid, run, k_targets);
  EXPECT_EQ(cost.ray_s.size(), 4u);
  EXPECT_EQ(cost.unreachable, 2u);
  const std::size_t n = k_grid.directions.size();
  const std::vector<Eigen::Vector3d> expected{k_grid.directions[n - 3], k_grid.directions[n - 2],
                                              k_grid.directions[n - 1], k_grid.directions[0], k_grid.directions[1]};
  EXPECT_EQ(solver.directions, expected);
  // The rotation takes 4 ms, the third ray 20 ms, the others 1 ms. burn() has a coarse clock.
  EXPECT_GT(cost.set_rotation_s, 2e-3);
  EXPECT_LT(cost.set_rotation_s, 15e-3);
  EXPECT_GT(cost.ray_s[2], 15e-3);
  EXPECT_GT(cost.rays_s, cost.ray_s[2]);
}

TEST(WorkSample, EndsInTimeAfterAtLeastOneRay) {
  BurningSolver solver;
  const WorkCost least = sample_work(solver, k_grid, k_targets, 0.0, 1);
  EXPECT_EQ(least.rays, 1u);
  EXPECT_EQ(solver.directions.size(), 2u);
  EXPECT_EQ(least.ray_standard_error_s, 0.0);
  const WorkCost more = sample_work(solver, k_grid, k_targets, 0.2, 1);
  EXPECT_GT(more.rays, RayRuns::k_length);
  EXPECT_GT(more.ray_s, 0.5e-3);
  EXPECT_DOUBLE_EQ(more.total_s(10, 100), 10.0 * (more.set_rotation_s + 100.0 * more.ray_s));
  EXPECT_EQ(more.configurations, 2 * more.rays);
  EXPECT_THROW(sample_work(solver, k_grid, k_targets, 1.0, 1, {.cancelled = [] { return true; }}), Interrupted);
}

TEST(WorkSample, FindsTheGreatestTimeAndUnreachableConfigurations) {
  BurningSolver solver;
  // Every run has all six directions, of which the first, +z, is slow and unreachable.
  const WorkCost cost = sample_work(solver, make_grid("90"), k_targets, 0.3, 1);
  EXPECT_EQ(cost.greatest_direction, 0u);
  EXPECT_GT(cost.greatest_ray_s, 15e-3);
  EXPECT_LT(cost.median_ray_s, 15e-3);
  EXPECT_LE(cost.p99_ray_s, cost.greatest_ray_s);
  EXPECT_GT(cost.unreachable, 0u);
  EXPECT_LT(cost.unreachable, cost.configurations / 2);
}

/// Compares the estimate with the whole work in one thread. The bounds are wide: other work on the machine evicts
/// caches.
TEST(WorkSample, PredictsTheWork) {
  const test::SmallJob small;
  std::vector<double> targets;
  for (int percent = 30; percent >= 0; --percent) targets.push_back(distance_bucket(small.a, percent).target);
  const auto solver = small.generator->prepare(small.a, small.b);
  const WorkCost cost = sample_work(*solver, k_grid, targets, 0.3, 1);
  const DistinctRotations distinct(k_grid.rotations);

  std::vector<double> translations(targets.size()), residuals(targets.size());
  const std::clock_t start = std::clock();
  for (const std::uint32_t r : distinct.first) {
    solver->set_rotation(k_grid.rotations[r]);
    for (const Eigen::Vector3d& u : k_grid.directions) solver->solve(u, targets, translations, residuals);
  }
  const double real = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  constexpr double k_margin = 3.0;
  const double estimate = cost.total_s(distinct.first.size(), k_grid.directions.size());
  EXPECT_GT(estimate, real / k_margin);
  EXPECT_LT(estimate, real * k_margin);
}

}  // namespace
}  // namespace sixdof
