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
  // 1000, 2000, ..., 1 000 000 ns in random order.
  std::vector<double> times;
  for (int k = 1; k <= 1000; ++k) times.push_back(1000.0 * k);
  std::mt19937_64 random(7);
  std::shuffle(times.begin(), times.end(), random);
  const Latency all = latency(times);
  EXPECT_EQ(all.mean, 500500.0);
  EXPECT_EQ(all.p50, 500000.0);
  EXPECT_EQ(all.p99, 990000.0);
  EXPECT_EQ(all.p999, 999000.0);
  EXPECT_EQ(all.max, 1e6);
  EXPECT_EQ(all.over_deadline, 0.0) << "a time of exactly 1 ms is in time";
  for (double& t : times) t += 100000.0;
  EXPECT_EQ(latency(times).over_deadline, 0.1);
}

TEST(LatencyOf, FewTimes) {
  const std::vector<double> three{9.0, 4.0, 5.0};
  EXPECT_EQ(latency(three).p50, 5.0);
  EXPECT_EQ(latency(three).p99, 9.0);
  EXPECT_EQ(latency(three).mean, 6.0);
  EXPECT_EQ(latency({}).mean, 0.0);
  EXPECT_EQ(latency({}).max, 0.0);
  const std::vector<double> broken{1.0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_THROW(latency(broken), BadArgument);
}

}  // namespace
}  // namespace sixdof
