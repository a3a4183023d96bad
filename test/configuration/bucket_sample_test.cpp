#include <sixdof/configuration/bucket_sample.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/models/model_catalogue.h>

#include "small_suite.h"

namespace sixdof {
namespace {

using Key = std::tuple<double, double, double, double>;

/// Tells configurations of one set apart.
Key key_of(const Pose& pose) { return {pose.t.x(), pose.t.y(), pose.t.z(), pose.R(0, 1) + 2 * pose.R(1, 2)}; }

std::vector<Key> keys_of(const std::vector<Pose>& poses) {
  std::vector<Key> keys;
  for (const Pose& pose : poses) keys.push_back(key_of(pose));
  return keys;
}

/// Least and greatest of counts.
std::pair<std::size_t, std::size_t> range(const std::vector<std::size_t>& counts) {
  return {std::ranges::min(counts), std::ranges::max(counts)};
}

/// Numbers with a common divisor, without one, equal, and single rotations and directions.
class OrderOfCells : public ::testing::TestWithParam<std::pair<std::size_t, std::size_t>> {};

TEST_P(OrderOfCells, VisitsEveryCellOnce) {
  const auto [rotations, directions] = GetParam();
  const CellOrder order(rotations, directions, 3);
  ASSERT_EQ(order.size(), rotations * directions);
  std::set<std::uint64_t> cells;
  for (std::uint64_t t = 0; t < order.size(); ++t) {
    EXPECT_LT(order[t], order.size());
    EXPECT_TRUE(cells.insert(order[t]).second) << order[t] << " twice";
  }
}

TEST_P(OrderOfCells, EveryPrefixHasRotationsAndDirectionsEquallyOften) {
  const auto [rotations, directions] = GetParam();
  const CellOrder order(rotations, directions, 3);
  std::vector<std::size_t> of_rotation(rotations), of_direction(directions);
  for (std::uint64_t t = 0; t < order.size(); ++t) {
    ++of_rotation[order[t] / directions];
    ++of_direction[order[t] % directions];
    for (const auto& counts : {of_rotation, of_direction}) {
      const auto [least, greatest] = range(counts);
      ASSERT_LE(greatest - least, 1u) << "of the first " << t + 1;
    }
  }
}

TEST_P(OrderOfCells, DependsOnTheSeed) {
  const auto [rotations, directions] = GetParam();
  const auto cells = [&, r = rotations, u = directions](std::uint64_t seed) {
    const CellOrder order(r, u, seed);
    std::vector<std::uint64_t> list;
    for (std::uint64_t t = 0; t < order.size(); ++t) list.push_back(order[t]);
    return list;
  };
  EXPECT_EQ(cells(1), cells(1));
  const bool many_orders = rotations * directions >= 10;
  EXPECT_TRUE(!many_orders || cells(1) != cells(2));
}

INSTANTIATE_TEST_SUITE_P(Grids, OrderOfCells,
                         ::testing::Values(std::pair(48, 6), std::pair(320, 26), std::pair(26, 26), std::pair(7, 12),
                                           std::pair(1, 9), std::pair(40, 1), std::pair(1, 1)));

struct SampledBucket : ::testing::Test {
  const Mesh torus = load_model("torus-1k");
  const ConfigurationSet set{SIXDOF_SMALL_SUITE "/torus-1k.h5"};
  const BucketKey key{BucketKind::distance, 5};

  BucketSample sample(std::size_t most, std::uint64_t seed) {
    return sample_bucket(set, key, torus, torus, most, seed);
  }
};

TEST_F(SampledBucket, HoldsEveryReachableConfigurationOnce) {
  const BucketSample all = sample(0, 1);
  EXPECT_EQ(all.poses.size(), set.summary(key).reachable);
  EXPECT_EQ(all.reachable, all.poses.size());
  std::vector<Pose> expected, in_grid_order;
  const auto translations = set.read(key);
  for (std::size_t i = 0; i < translations.size(); ++i) {
    const Grid& grid = set.grid(key.kind);
    if (std::isnan(translations[i])) continue;
    expected.push_back(ConfigurationRay(torus, torus, grid.rotations[i / grid.directions.size()],
                                        grid.directions[i % grid.directions.size()])
                           .pose(translations[i]));
  }
  for (const std::size_t i : grid_order(all, all.poses.size())) in_grid_order.push_back(all.poses[i]);
  EXPECT_EQ(keys_of(in_grid_order), keys_of(expected));
  EXPECT_NE(keys_of(all.poses), keys_of(expected)) << "the order of drawing is another";
  EXPECT_EQ(keys_of(sample(all.poses.size() + 7, 1).poses), keys_of(all.poses));
}

TEST_F(SampledBucket, DrawsBySeed) {
  const auto first = keys_of(sample(40, 1).poses);
  EXPECT_EQ(first.size(), 40u);
  EXPECT_EQ(keys_of(sample(40, 1).poses), first);
  EXPECT_NE(keys_of(sample(40, 2).poses), first);
  // More of the same begins the same.
  const auto longer = keys_of(sample(80, 1).poses);
  EXPECT_TRUE(std::equal(first.begin(), first.end(), longer.begin()));
}

TEST_F(SampledBucket, SkipsWhatCannotBeReachedInTheOrderOfCells) {
  const Grid& grid = set.grid(key.kind);
  const auto translations = set.read(key);
  std::vector<std::uint64_t> expected;
  const CellOrder order(grid.rotations.size(), grid.directions.size(), 4);
  for (std::uint64_t t = 0; t < order.size(); ++t) {
    if (!std::isnan(translations[order[t]])) expected.push_back(order[t]);
  }
  EXPECT_EQ(sample(0, 4).cells, expected);
}

TEST_F(SampledBucket, ItsFirstConfigurationsHaveAnOrderOfTheGrid) {
  const BucketSample all = sample(0, 1);
  const auto order = grid_order(all, 100);
  ASSERT_EQ(order.size(), 100u);
  EXPECT_TRUE(std::ranges::is_sorted(order, {}, [&](std::size_t i) { return all.cells[i]; }));
  std::vector<std::size_t> first(100);
  std::iota(first.begin(), first.end(), std::size_t{0});
  EXPECT_THAT(order, ::testing::UnorderedElementsAreArray(first));
}

TEST(RandomOrder, IsAPermutationBySeed) {
  const auto one = random_order(100, 9);
  EXPECT_EQ(random_order(100, 9), one);
  EXPECT_NE(random_order(100, 10), one);
  std::vector<std::size_t> sorted(100);
  std::iota(sorted.begin(), sorted.end(), std::size_t{0});
  EXPECT_NE(one, sorted);
  EXPECT_THAT(one, ::testing::UnorderedElementsAreArray(sorted));
}

}  // namespace
}  // namespace sixdof
