#include <sixdof/measure/latency.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

TEST(LatencyOf, QuantilesAreNearestRanks) {
  // 500, 1000, ..., 1 000 000 ns in random order.
  std::vector<double> times;
  for (int k = 1; k <= 2000; ++k) times.push_back(500.0 * k);
  std::mt19937_64 random(7);
  std::shuffle(times.begin(), times.end(), random);
  const Latency all = latency(times);
  EXPECT_EQ(all.mean, 500250.0);
  EXPECT_EQ(all.p10, 100000.0);
  EXPECT_EQ(all.p25, 250000.0);
  EXPECT_EQ(all.p50, 500000.0);
  EXPECT_EQ(all.p75, 750000.0);
  EXPECT_EQ(all.p90, 900000.0);
  EXPECT_EQ(all.p99, 990000.0);
  EXPECT_EQ(all.p999, 999000.0);
  EXPECT_EQ(all.max, 1e6);
  EXPECT_EQ(all.over_deadline, 0.0) << "a time of exactly 1 ms is in time";
  for (double& t : times) t += 100000.0;
  EXPECT_EQ(latency(times).over_deadline, 0.1);
}

TEST(LatencyOf, PercentilesNeedTwoTimesAboveThem) {
  std::vector<double> times(k_fewest_for_p99 - 1, 1.0);
  times.front() = 3.0;
  EXPECT_FALSE(latency(times).p99);
  times.push_back(2.0);
  EXPECT_EQ(latency(times).p99, 1.0) << "2 and 3 lie above";
  times.resize(k_fewest_for_p999 - 1, 1.0);
  EXPECT_FALSE(latency(times).p999);
  times.push_back(1.0);
  EXPECT_EQ(latency(times).p999, 1.0) << "2 and 3 lie above";
}

TEST(LatencyOf, FewTimes) {
  const std::vector<double> three{9.0, 4.0, 5.0};
  EXPECT_EQ(latency(three).p50, 5.0);
  EXPECT_EQ(latency(three).max, 9.0);
  EXPECT_EQ(latency(three).mean, 6.0);
  EXPECT_EQ(latency({}).mean, 0.0);
  EXPECT_EQ(latency({}).max, 0.0);
  const std::vector<double> broken{1.0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_THROW(latency(broken), BadArgument);
}

}  // namespace
}  // namespace sixdof
