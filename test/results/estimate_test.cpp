#include <sixdof/results/estimate.h>

#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace sixdof::results {
namespace {

TEST(Median, OfAnEvenNumberIsTheMeanOfTheMiddleTwo) {
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_EQ(median({7.0}), 7.0);
}

TEST(Quantile, IsInterpolatedBetweenOrderStatistics) {
  const std::vector<double> values{10.0, 1.0, 3.0, 2.0};
  EXPECT_DOUBLE_EQ(quantile(values, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(quantile(values, 0.1), 1.3);
  EXPECT_DOUBLE_EQ(quantile(values, 1.0), 10.0);
  EXPECT_DOUBLE_EQ(quantile({7.0}, 0.9), 7.0);
}

TEST(MeanOfRepetitions, IsGeometricWithStudentsInterval) {
  const Estimate mean = mean_of_repetitions({1.0, 1.0, 8.0});
  const double half = 4.30265 * std::log(2.0);  // t of two degrees of freedom at 97.5 %; the logarithms' deviation is s
  EXPECT_DOUBLE_EQ(mean.value, 2.0);
  EXPECT_NEAR(std::log(mean.high / mean.value), half, 1e-4 * half);
  EXPECT_NEAR(std::log(mean.value / mean.low), half, 1e-4 * half);
}

TEST(MeanOfRepetitions, OfTwoHasTheNoiseOfRuns) {
  const Estimate mean = mean_of_repetitions({1.0, 3.0});
  EXPECT_EQ(mean.value, 2.0);
  EXPECT_DOUBLE_EQ(mean.low, 2.0 * (1.0 - k_run_to_run));
  EXPECT_DOUBLE_EQ(mean.high, 2.0 * (1.0 + k_run_to_run));
}

TEST(MedianOfRounds, HasItsIntervalByRanks) {
  std::vector<double> rounds(15);
  std::iota(rounds.begin(), rounds.end(), 1.0);
  const Estimate median = median_of_rounds(rounds);
  EXPECT_EQ(median.value, 8.0);
  EXPECT_EQ(median.low, 4.0) << "P(at most 3 of 15 below) = 0.018, at most 4: 0.059";
  EXPECT_EQ(median.high, 12.0);
  rounds.resize(8);
  EXPECT_EQ(median_of_rounds(rounds).low, 1.0) << "least to largest";
  EXPECT_EQ(median_of_rounds({}).value, 0.0);
  EXPECT_DOUBLE_EQ(median_of_rounds({5.0}).high, 5.0 * (1.0 + k_run_to_run));
}

}  // namespace
}  // namespace sixdof::results
