#include "bench/harness/timing.h"

#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace sixdof::bench {
namespace {

std::vector<Pose> numbered_poses(int count) {
  std::vector<Pose> poses(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) poses[static_cast<std::size_t>(i)].t.x() = i;
  return poses;
}

TEST(TimeEach, AsksEveryPoseInEveryPassInOrder) {
  std::vector<Pose> poses = numbered_poses(5);
  std::vector<int> asked;
  const auto ask = [&](const Pose& pose) {
    asked.push_back(static_cast<int>(pose.t.x()));
    return Outcome<bool>(true);
  };
  const Query query;
  Failures failures;
  const Latency latency = time_each(poses, GuardedQuery(query, ask, failures));
  ASSERT_EQ(asked.size(), poses.size() * k_latency_passes);
  for (std::size_t i = 0; i < asked.size(); ++i) EXPECT_EQ(asked[i], static_cast<int>(i % poses.size()));
  EXPECT_EQ(poses.size(), 5u);
  EXPECT_GE(latency.max, latency.p50);
  EXPECT_EQ(failures.count(), 0u);
}

TEST(TimeEach, RemovesPosesThatFailInOnePass) {
  std::vector<Pose> poses = numbered_poses(10);
  int asked = 0;
  const auto ask = [&](const Pose& pose) -> Outcome<bool> {
    ++asked;
    if (pose.t.x() == 3.0 && asked > 10) throw std::runtime_error("only once");
    if (pose.t.x() == 7.0 && asked > 20) return Status::failed;
    return true;
  };
  const Query query;
  Failures failures;
  time_each(poses, GuardedQuery(query, ask, failures));
  ASSERT_EQ(poses.size(), 8u);
  EXPECT_EQ(poses[3].t.x(), 4.0);
  EXPECT_EQ(poses[7].t.x(), 9.0);
  EXPECT_EQ(failures.count(), 2u) << "a configuration counts once, however often it fails";
  EXPECT_EQ(failures.first(), "only once");
}

TEST(Clock, HasACost) { EXPECT_GT(clock_overhead_ns(), 0.0); }

}  // namespace
}  // namespace sixdof::bench
