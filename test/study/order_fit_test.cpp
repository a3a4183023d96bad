#include "bench/study/order_fit.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace sixdof::study {
namespace {

constexpr double k_scatter = 0.1;     // of the planted scatter of 10 %
constexpr double k_rounding = 1e-12;  // of a fit of few points

TEST(OrderFit, FindsAPowerLaw) {
  const std::vector<double> h{0.1, 0.05, 0.02, 0.01};
  std::vector<double> error;
  for (const double x : h) error.push_back(3.0 * std::pow(x, 1.7));
  const auto fit = fit_order(h, error);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->order, 1.7, k_rounding);
  EXPECT_NEAR(fit->standard_error, 0.0, k_rounding);
}

TEST(OrderFit, HasAStandardErrorWhereTheErrorScatters) {
  const std::vector<double> h{1, 2, 4, 8};
  const std::vector<double> error{1.0, 2.2, 3.8, 8.1};
  const auto fit = fit_order(h, error);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->order, 1.0, k_scatter);
  EXPECT_GT(fit->standard_error, 0.01);
  EXPECT_LT(fit->standard_error, 0.1);
}

TEST(OrderFit, NeedsThreePositivePointsOfUnlikeResolution) {
  EXPECT_FALSE(fit_order(std::vector<double>{1, 2}, std::vector<double>{1, 2}));
  EXPECT_FALSE(fit_order(std::vector<double>{1, 2, 3}, std::vector<double>{1, 0, 2}));
  EXPECT_FALSE(fit_order(std::vector<double>{2, 2, 2}, std::vector<double>{1, 2, 3}));
}

}  // namespace
}  // namespace sixdof::study
