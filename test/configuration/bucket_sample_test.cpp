#include <sixdof/configuration/bucket_sample.h>

#include <algorithm>
#include <cmath>
#include <tuple>

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

struct SampledBucket : ::testing::Test {
  const Mesh torus = load_model("torus-1k");
  const ConfigurationSet set{SIXDOF_SMALL_SUITE "/torus-1k.h5"};
  const BucketKey key{BucketKind::distance, 5};

  BucketSample sample(std::size_t most, std::uint64_t seed) {
    return sample_bucket(set, key, torus, torus, most, seed);
  }
};

TEST_F(SampledBucket, HoldsEveryReachableConfigurationInTheSetsOrder) {
  const BucketSample all = sample(0, 1);
  EXPECT_EQ(all.poses.size(), set.summary(key).reachable);
  EXPECT_EQ(all.reachable, all.poses.size());
  std::vector<Pose> expected;
  const auto translations = set.read(key);
  for (std::size_t i = 0; i < translations.size(); ++i) {
    const Grid& grid = set.grid(key.kind);
    if (std::isnan(translations[i])) continue;
    expected.push_back(ConfigurationRay(torus, torus, grid.rotations[i / grid.directions.size()],
                                        grid.directions[i % grid.directions.size()])
                           .pose(translations[i]));
  }
  EXPECT_EQ(keys_of(all.poses), keys_of(expected));
  EXPECT_EQ(keys_of(sample(all.poses.size(), 5).poses), keys_of(expected));
}

TEST_F(SampledBucket, DrawsBySeed) {
  const auto first = keys_of(sample(40, 1).poses);
  EXPECT_GE(first.size(), 40u);
  EXPECT_LT(first.size(), 40u + BucketSample::k_run);
  EXPECT_EQ(keys_of(sample(40, 1).poses), first);
  EXPECT_NE(keys_of(sample(40, 2).poses), first);
  // More of the same begins the same.
  const auto longer = keys_of(sample(80, 1).poses);
  EXPECT_TRUE(std::equal(first.begin(), first.end(), longer.begin()));
}

TEST_F(SampledBucket, ShufflesTheSameConfigurations) {
  const auto all = sample(0, 1).poses;
  const auto one = keys_of(shuffled(all, 100, 9));
  EXPECT_EQ(keys_of(shuffled(all, 100, 9)), one);
  EXPECT_NE(keys_of(shuffled(all, 100, 10)), one);
  const auto path = keys_of({all.begin(), all.begin() + 100});
  EXPECT_NE(one, path);
  EXPECT_THAT(one, ::testing::UnorderedElementsAreArray(path));
}

}  // namespace
}  // namespace sixdof
