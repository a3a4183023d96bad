#include "bench/harness/timing.h"

#include <chrono>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/measure/latency.h>

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
  Query query;
  Failures failures;
  const SingleTimes times = time_each(poses, GuardedQuery(query, ask, failures));
  ASSERT_EQ(asked.size(), poses.size() * k_latency_passes);
  for (std::size_t i = 0; i < asked.size(); ++i) EXPECT_EQ(asked[i], static_cast<int>(i % poses.size()));
  EXPECT_EQ(poses.size(), 5u);
  EXPECT_GE(times.once.max, times.once.p50);
  EXPECT_EQ(failures.count(), 0u);
}

/// Of the queries that are made slow; they count as missed deadlines.
constexpr double k_planted_ns = 2.0 * k_haptic_deadline_ns;

/// Waits by the clock, so that the answer takes no less.
void spend_planted() {
  using Clock = std::chrono::steady_clock;
  const std::chrono::duration<double, std::nano> delay(k_planted_ns);
  for (const auto start = Clock::now(); Clock::now() - start < delay;) {
  }
}

TEST(TimeEach, OfTheFirstPassStandsBesideTheLeastOfThree) {
  std::vector<Pose> poses = numbered_poses(static_cast<int>(k_fewest_for_p99));
  std::size_t asked = 0;
  // The first pass takes long at one pose in 20, the others at pose 0 only.
  const auto ask = [&](const Pose& pose) {
    const bool first_pass = asked++ < poses.size();
    const int number = static_cast<int>(pose.t.x());
    if (number == 0 || (first_pass && number % 20 == 0)) spend_planted();
    return Outcome<bool>(true);
  };
  Query query;
  Failures failures;
  const SingleTimes times = time_each(poses, GuardedQuery(query, ask, failures));
  EXPECT_GE(*times.once.p99, k_planted_ns);
  EXPECT_GE(times.once.over_deadline, 0.05);
  EXPECT_LT(*times.least.p99, *times.once.p99);
  EXPECT_GE(times.least.max, k_planted_ns);
  EXPECT_FALSE(times.once.p999);
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
  Query query;
  Failures failures;
  time_each(poses, GuardedQuery(query, ask, failures));
  ASSERT_EQ(poses.size(), 8u);
  EXPECT_EQ(poses[3].t.x(), 4.0);
  EXPECT_EQ(poses[7].t.x(), 9.0);
  EXPECT_EQ(failures.count(), 2u) << "a configuration counts once, however often it fails";
  EXPECT_EQ(failures.first(), "only once");
}

}  // namespace
}  // namespace sixdof::bench
