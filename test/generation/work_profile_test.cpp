#include <sixdof/generation/work_profile.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/generation/ray_cast.h>
#include <sixdof/generation/volume_generator.h>

#include "../configuration/shapes.h"
#include "../configuration/shard_job.h"

namespace sixdof {
namespace {

TEST(WorkHistogram, QuantilesAreThoseOfTheSortedNumbersToAPart) {
  std::mt19937_64 random(7);
  std::vector<std::uint64_t> values{0, 63, 64, std::numeric_limits<std::uint64_t>::max()};
  for (int i = 0; i < 3000; ++i) values.push_back(random() >> (random() % 64));
  WorkHistogram whole, other;
  for (std::size_t i = 0; i < values.size(); ++i) (i % 3 == 0 ? whole : other).add(values[i]);
  whole.add(other);
  std::ranges::sort(values);
  EXPECT_EQ(whole.count(), values.size());
  for (const double share : {0.01, 0.25, 0.5, 0.9, 0.999, 1.0}) {
    const auto n = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
    const std::uint64_t exact = values[n - 1];
    EXPECT_LE(whole.quantile(share), exact);
    EXPECT_GE(whole.quantile(share), exact - exact / WorkHistogram::k_parts);
  }
  EXPECT_EQ(WorkHistogram().quantile(0.5), 0u);
}

TEST(ProfileRotations, HoldAllThatTurnAxesOntoAxes) {
  const Grid grid = make_grid("45/30");
  const ProfileRotations right(grid, 0, 1);
  EXPECT_EQ(right.aligned, right.indices.size());
  // All rotations by right angles are there, and far from all rotations.
  const std::vector<Eigen::Vector4d> square = zyz_rotations(2);
  for (const Eigen::Vector4d& q : square) {
    EXPECT_TRUE(std::ranges::any_of(right.indices, [&](std::uint32_t r) {
      return std::abs(grid.rotations[r].dot(q)) > 1.0 - 1e-12;  // rounding of products of cosines
    }));
  }
  EXPECT_LT(right.aligned, grid.rotations.size() / 2);

  const ProfileRotations some(grid, 20, 1), same(grid, 20, 1), others(grid, 20, 2), all(grid, 1'000'000, 1);
  EXPECT_EQ(some.indices.size(), right.aligned + 20);
  EXPECT_EQ(some.indices, same.indices);
  EXPECT_NE(some.indices, others.indices);
  EXPECT_TRUE(std::ranges::includes(some.indices, right.indices));
  EXPECT_EQ(all.indices.size(), DistinctRotations(grid.rotations).first.size());
}

/// Says that a configuration took what its place says, and that those with an odd sum are unreachable.
class Counting final : public RaySolver {
 public:
  explicit Counting(const Grid& grid) : grid_(grid) {}
  static std::uint64_t work_at(std::size_t r, std::size_t u, std::size_t k) { return 1 + (r * 131 + u * 17 + k) % 997; }

  void set_rotation(const Eigen::Vector4d& rotation) override {
    rotation_ = static_cast<std::size_t>(std::ranges::find(grid_.rotations, rotation) - grid_.rotations.begin());
  }
  void solve(const Eigen::Vector3d& direction, std::span<const double> targets, std::span<double> translations,
             std::span<double> residuals) override {
    const auto u = static_cast<std::size_t>(std::ranges::find(grid_.directions, direction) - grid_.directions.begin());
    work_.clear();
    for (std::size_t k = 0; k < targets.size(); ++k) {
      work_.push_back(work_at(rotation_, u, k));
      translations[k] = (u + k) % 2 == 0 ? 1.0 : std::numeric_limits<double>::quiet_NaN();
      residuals[k] = 0.0;
    }
  }
  std::uint64_t measurements() const override { return 0; }
  std::span<const std::uint64_t> work() const override { return work_; }

 private:
  const Grid& grid_;
  std::size_t rotation_ = 0;
  std::vector<std::uint64_t> work_;
};

TEST(WorkProfile, FindsTheWorstConfigurationAndCountsTheReachable) {
  const Grid grid = make_grid("45/90");
  const ProfileRotations rotations(grid, 5, 3);
  const std::vector<double> targets{3.0, 2.0, 1.0};
  const auto profile = [&](unsigned threads) {
    return profile_work([&] { return std::make_unique<Counting>(grid); }, grid, targets, rotations.indices,
                        {.threads = threads});
  };
  const WorkProfile one = profile(1), two = profile(2);
  std::uint64_t worst = 0;
  for (const std::uint32_t r : rotations.indices) {
    for (std::size_t u = 0; u < grid.directions.size(); ++u) {
      for (std::size_t k = 0; k < targets.size(); ++k) worst = std::max(worst, Counting::work_at(r, u, k));
    }
  }
  for (const WorkProfile& p : {one, two}) {
    EXPECT_EQ(p.work.count(), rotations.indices.size() * grid.directions.size() * targets.size());
    EXPECT_EQ(p.worst_work, worst);
    EXPECT_EQ(Counting::work_at(p.worst.rotation, p.worst.direction, p.worst.target), worst);
    EXPECT_EQ(p.worst.rotation, one.worst.rotation);
    EXPECT_EQ(p.worst.direction, one.worst.direction);
    const std::uint64_t even = rotations.indices.size() * ((grid.directions.size() + 1) / 2);
    const std::uint64_t odd = rotations.indices.size() * (grid.directions.size() / 2);
    EXPECT_THAT(p.reachable, testing::ElementsAre(even, odd, even));
    EXPECT_GE(p.worst_ray_s, p.median_ray_s);
  }
  EXPECT_THROW(profile_work([&] { return std::make_unique<Counting>(grid); }, grid, targets, {}), BadArgument);
  EXPECT_THROW(profile_work([&] { return std::make_unique<Counting>(grid); }, grid, targets, rotations.indices,
                            {.cancelled = [] { return true; }}),
               Interrupted);
}

TEST(WorkProfile, CountsOfRealWorkDoNotDependOnThreads) {
  const Mesh a = test::boxes_mesh({{{0.1, 0.2, 0.3}, {0.4, 0.3, 0.2}}});
  const Mesh b = test::lump_mesh(3, {0.4, -0.2, 1.0});
  const Grid grid = make_grid("45/90");
  const ProfileRotations rotations(grid, 0, 1);
  const auto touching = make_ray_cast();
  const VolumeGenerator volumes(*touching, a, b);
  const auto same = [&](const auto& prepare, const std::vector<double>& targets) {
    const WorkProfile one = profile_work(prepare, grid, targets, rotations.indices, {.threads = 1});
    const WorkProfile two = profile_work(prepare, grid, targets, rotations.indices, {.threads = 2});
    EXPECT_GT(one.work.quantile(0.5), 0u);
    EXPECT_GE(one.worst_work, one.work.quantile(0.999));
    EXPECT_EQ(one.worst_work, two.worst_work);
    EXPECT_EQ(one.work.quantile(0.5), two.work.quantile(0.5));
    EXPECT_EQ(one.reachable, two.reachable);
  };
  same([&] { return touching->prepare(a, b); },
       {distance_bucket(a, 10).target, distance_bucket(a, 3).target, distance_bucket(a, 0).target});
  same([&] { return volumes.prepare(); }, {volume_bucket(a, 0).target, volume_bucket(a, 2).target, volume_bucket(a, 10).target});
}

}  // namespace
}  // namespace sixdof
