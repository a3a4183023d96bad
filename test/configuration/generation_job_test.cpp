#include <sixdof/configuration/generation_job.h>

#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

#include "shard_job.h"

namespace sixdof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(DistinctRotations, ShardsDivideThemEvenlyAndLeaveNoneOut) {
  const DistinctRotations distinct(make_grid("paper").rotations);
  ASSERT_EQ(distinct.first.size(), 6384u);
  for (const std::size_t count : {1u, 7u, 64u, 6384u}) {
    std::vector<std::uint32_t> all;
    std::set<std::size_t> sizes;
    for (std::size_t number = 1; number <= count; ++number) {
      const auto part = rotations_of({.number = number, .count = count}, distinct);
      all.insert(all.end(), part.begin(), part.end());
      sizes.insert(part.size());
    }
    EXPECT_EQ(all, distinct.first) << count;
    EXPECT_LE(*sizes.rbegin() - *sizes.begin(), 1u) << count;
  }
}

TEST(DistinctRotations, EveryRotationHasAnEqualRepresentative) {
  const Grid grid = make_grid("45");
  const DistinctRotations distinct(grid.rotations);
  EXPECT_LT(distinct.first.size(), grid.rotations.size());
  for (std::size_t r = 0; r < grid.rotations.size(); ++r) {
    EXPECT_EQ(grid.rotations[distinct.representative[r]], grid.rotations[r]);
    EXPECT_TRUE(std::ranges::binary_search(distinct.first, distinct.representative[r]));
  }
}

TEST(GenerationJob, HashAndWordsTellEveryDifference) {
  const test::SmallJob small;
  const auto changed = [&](auto change) {
    GenerationJob job = small.job;
    change(job);
    EXPECT_NE(job.hash(), small.job.hash());
    return job.difference(small.job);
  };
  EXPECT_EQ(small.job.difference(test::SmallJob().job), "");
  EXPECT_THAT(changed([](GenerationJob& job) { job.a.hash = "other"; }), HasSubstr("mesh A is lump"));
  EXPECT_THAT(changed([](GenerationJob& job) { job.b.hash = "other"; }), HasSubstr("mesh B is lump"));
  EXPECT_THAT(changed([](GenerationJob& job) { job.a.volume += 1e-9; }), HasSubstr("measures of the meshes"));
  EXPECT_THAT(changed([](GenerationJob& job) { job.grid.hash = "other"; }), HasSubstr("the grid is 90/60"));
  EXPECT_THAT(changed([](GenerationJob& job) { job.volume_grid.reset(); }), HasSubstr("the volumes' grid is none"));
  EXPECT_THAT(changed([](GenerationJob& job) { job.oracle = "other"; }), HasSubstr("by other"));
  EXPECT_THAT(changed([](GenerationJob& job) { job.program = "1.2.3 def"; }), HasSubstr("made by sixdof 1.2.3 def"));
  EXPECT_THAT(changed([](GenerationJob& job) { job.buckets.pop_back(); }), HasSubstr("the buckets are"));
  EXPECT_THAT(changed([](GenerationJob& job) { job.buckets[1].target *= 1.0 + 1e-15; }), HasSubstr("distance/20"));
}

TEST(GenerationJob, DescribesItsSetAgain) {
  const test::SmallJob small;
  const SetDescription set = small.job.describe();
  EXPECT_EQ(set.grid.rotations, small.set.grid.rotations);
  EXPECT_EQ(set.volume_grid->directions, small.set.volume_grid->directions);
  GenerationJob other = small.job;
  other.grid.hash = "other";
  EXPECT_THAT([&] { static_cast<void>(other.describe()); }, ThrowsMessage<BadArgument>(HasSubstr("grid 90/60")));
}

TEST(GenerationJob, RefusesWhatCannotBeDone) {
  const test::SmallJob small;
  const auto with = [&](std::vector<double> distances, std::vector<double> volumes) {
    static_cast<void>(GenerationJob::of("", "raycast", "1", small.a, small.set, distances, volumes));
  };
  EXPECT_THAT([&] { with({}, {}); }, ThrowsMessage<BadArgument>(HasSubstr("no bucket")));
  EXPECT_THAT([&] { with({3, 3}, {}); }, ThrowsMessage<BadArgument>(HasSubstr("distance/03")));
  EXPECT_THAT([&] { with({3}, {101}); }, ThrowsMessage<BadArgument>(HasSubstr("volume 101 %")));
  for (const auto& [number, count] : {std::pair<std::size_t, std::size_t>(0, 3), {4, 3}, {1, 1000}}) {
    EXPECT_THROW(check_shard_number({.number = number, .count = count}, small.set, small.job), BadArgument);
  }
}

}  // namespace
}  // namespace sixdof
