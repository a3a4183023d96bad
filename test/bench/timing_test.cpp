#include "bench/harness/timing.h"

#include <algorithm>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include <sixdof/query/outcome.h>

namespace sixdof::bench {
namespace {

TEST(Latency, IsNearestRank) {
  std::vector<std::int64_t> samples(2000);
  std::iota(samples.begin(), samples.end(), 1);
  std::mt19937_64 random(3);
  std::shuffle(samples.begin(), samples.end(), random);
  const Latency latency = latency_of(samples);
  EXPECT_EQ(latency.p50_ns, 1000);
  EXPECT_EQ(latency.p99_ns, 1980);
  EXPECT_EQ(latency.p999_ns, 1998);
  EXPECT_EQ(latency.max_ns, 2000);
  EXPECT_EQ(latency.over_1ms, 0.0);
}

TEST(Latency, CountsWhatIsBeyondTheDeadline) {
  // Exactly a millisecond is in time.
  const Latency latency = latency_of({1'000'000, 1'000'001, 5'000'000, 3});
  EXPECT_EQ(latency.over_1ms, 0.5);
  EXPECT_EQ(latency.p50_ns, 1'000'000);
  EXPECT_EQ(latency.p999_ns, 5'000'000);
  EXPECT_EQ(latency_of({7}).p50_ns, 7);
  EXPECT_EQ(latency_of({}).max_ns, 0);
}

TEST(TimeEach, AsksEveryPoseInEveryPassInOrder) {
  std::vector<Pose> poses(5);
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].t.x() = static_cast<double>(i);
  std::vector<int> asked;
  time_each(poses, [&](const Pose& pose) {
    asked.push_back(static_cast<int>(pose.t.x()));
    return Outcome<bool>(true);
  });
  ASSERT_EQ(asked.size(), poses.size() * k_latency_passes);
  for (std::size_t i = 0; i < asked.size(); ++i) EXPECT_EQ(asked[i], static_cast<int>(i % poses.size()));
}

TEST(Clock, HasACost) { EXPECT_GT(clock_overhead_ns(), 0.0); }

}  // namespace
}  // namespace sixdof::bench
