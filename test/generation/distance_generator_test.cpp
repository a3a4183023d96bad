#include <sixdof/generation/distance_generator.h>

#include <atomic>
#include <cmath>
#include <mutex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/base/error.h>

#include "../configuration/shapes.h"

namespace sixdof {
namespace {

using test::same_bits;
using testing::HasSubstr;
using testing::ThrowsMessage;

const std::unique_ptr<Algorithm> k_brute_force = make_brute_force_algorithm();

// Few triangles, since the oracle tests every pair.
const Mesh k_a = test::tetrahedron_mesh({1.0, -2.0, 0.5}, 1.7);
const Mesh k_b = test::tetrahedron_mesh({0.1, 0.2, 3.0}, 0.8);
const std::vector<double> k_percents{0, 30, 5};

Generated generate(const Grid& grid, const RunOptions& run = {}, const Mesh& a = k_a, const Mesh& b = k_b,
                   const std::vector<std::uint32_t>& rotations = {}) {
  return generate_distances(*make_sphere_method(*k_brute_force), a, b, grid, k_percents, run, rotations);
}

TEST(DistanceGenerator, EveryConfigurationHasItsDistance) {
  const Grid grid = make_grid("90");
  for (const auto& [a, b] : {std::pair(&k_a, &k_b), std::pair(&k_b, &k_a)}) {
    const Generated result = generate(grid, {}, *a, *b);
    ASSERT_EQ(result.buckets.size(), 3u);
    const auto query = k_brute_force->prepare(*a, *b, k_brute_force->settings());
    for (std::size_t k = 0; k < k_percents.size(); ++k) {
      const auto& [summary, translations] = result.buckets[k];
      EXPECT_EQ(summary.key, (BucketKey{BucketKind::distance, k_percents[k]}));
      EXPECT_EQ(summary.oracle, "brute-force");
      EXPECT_DOUBLE_EQ(summary.nominal, k_percents[k] * 0.01 * a->diagonal());
      ASSERT_EQ(translations.size(), grid.configurations());
      double largest = 0.0;
      std::size_t reachable = 0;
      for (std::size_t r = 0; r < grid.rotations.size(); ++r) {
        for (std::size_t u = 0; u < grid.directions.size(); ++u) {
          const double s = translations[r * grid.directions.size() + u];
          // The box centre of a tetrahedron may lie outside of it: some rays meet nothing.
          if (std::isnan(s)) continue;
          ++reachable;
          const double d =
              query->distance(ConfigurationRay(*a, *b, grid.rotations[r], grid.directions[u]).pose(s)).value.distance;
          largest = std::max(largest, std::abs(d - summary.target));
        }
      }
      EXPECT_LE(largest, k_distance_tolerance * a->diagonal());
      EXPECT_EQ(largest, summary.largest_residual);
      EXPECT_GT(reachable, grid.configurations() / 2);
    }
  }
}

TEST(DistanceGenerator, ThreadsAndShardsDoNotChangeABit) {
  const Grid grid = make_grid("90/60");
  const Generated whole = generate(grid, {.threads = 1});
  const Generated threaded = generate(grid, {.threads = 2});
  const std::size_t n = grid.rotations.size();
  ASSERT_EQ(n, 6u * 4u * 6u);
  for (std::size_t k = 0; k < k_percents.size(); ++k) {
    EXPECT_TRUE(same_bits(whole.buckets[k].translations, threaded.buckets[k].translations));
    EXPECT_EQ(whole.buckets[k].summary.largest_residual, threaded.buckets[k].summary.largest_residual);
  }
  EXPECT_EQ(whole.measurements, threaded.measurements);
  // The shards divide groups of equal rotations.
  for (const auto& [first, last] : {std::pair<std::size_t, std::size_t>(0, 50), {50, 101}, {101, n}}) {
    const Generated shard = generate(grid, {}, k_a, k_b, test::indices(first, last));
    const std::size_t rows = last - first;
    for (std::size_t k = 0; k < k_percents.size(); ++k) {
      EXPECT_TRUE(same_bits(shard.buckets[k].translations,
                            std::span(whole.buckets[k].translations)
                                .subspan(first * grid.directions.size(), rows * grid.directions.size())));
    }
  }
}

TEST(DistanceGenerator, RepeatedRotationsAreSolvedOnce) {
  Grid grid = make_grid("90");
  const std::uint64_t measurements = generate(grid).measurements;
  grid.rotations.insert(grid.rotations.end(), grid.rotations.begin(), grid.rotations.end());
  EXPECT_EQ(generate(grid).measurements, measurements);
}

TEST(DistanceGenerator, ReportsProgressToTheEndAndStopsWhenAsked) {
  const Grid grid = make_grid("90");
  std::uint64_t last = 0, total = 0;
  int calls = 0;
  RunOptions run{.threads = 2, .progress = [&](std::uint64_t done, std::uint64_t all) {
                   EXPECT_GE(done, last);
                   last = done;
                   total = all;
                   ++calls;
                 }};
  generate(grid, run);
  EXPECT_EQ(last, total);
  EXPECT_GT(calls, 10u);

  std::atomic<int> asked = 0;
  run.progress = nullptr;
  run.cancelled = [&] { return ++asked > 20; };
  EXPECT_THROW(generate(grid, run), Interrupted);
  EXPECT_LT(asked, 40);
}

TEST(DistanceGenerator, RefusesWhatCannotBeDone) {
  const Grid grid = make_grid("90");
  const auto generator = make_sphere_method(*k_brute_force);
  const auto with = [&](const std::vector<double>& percents, const std::vector<std::uint32_t>& rotations = {}) {
    generate_distances(*generator, k_a, k_b, grid, percents, {}, rotations);
  };
  EXPECT_THAT([&] { with({}); }, ThrowsMessage<BadArgument>(HasSubstr("no bucket")));
  EXPECT_THAT([&] { with({5, 7, 5}); }, ThrowsMessage<BadArgument>(HasSubstr("distance 5 %")));
  EXPECT_THAT([&] { with({-1}); }, ThrowsMessage<BadArgument>(HasSubstr("distance -1 %")));
  EXPECT_THAT([&] { with({101}); }, ThrowsMessage<BadArgument>(HasSubstr("distance 101 %")));
  EXPECT_THAT([&] { with({5}, {3, 999}); }, ThrowsMessage<BadArgument>(HasSubstr("rotation 999: the grid has")));
}

/// Fails on one ray.
class Failing final : public DistanceGenerator {
 public:
  const std::string& oracle_name() const override { return name_; }
  const std::string& oracle_version() const override { return name_; }
  std::unique_ptr<RaySolver> prepare(const Mesh& /*a*/, const Mesh& /*b*/) const override {
    struct Solver final : RaySolver {
      void set_rotation(const Eigen::Vector4d& /*rotation*/) override { ++rotation; }
      void solve(const Eigen::Vector3d& direction, std::span<const double> /*targets*/,
                 std::span<double> /*translations*/, std::span<double> /*residuals*/) override {
        if (direction.z() == -1.0) throw Error("lost");
      }
      std::uint64_t measurements() const override { return 0; }
      int rotation = 0;
    };
    return std::make_unique<Solver>();
  }

 private:
  std::string name_ = "failing";
};

TEST(DistanceGenerator, SaysWhichConfigurationFailed) {
  const Grid grid = make_grid("90");
  const std::vector<std::uint32_t> rotations{3};
  EXPECT_THAT([&] { generate_distances(Failing(), k_a, k_b, grid, k_percents, {.threads = 1}, rotations); },
              ThrowsMessage<Error>("rotation 3, direction 5: lost"));
}

}  // namespace
}  // namespace sixdof
