#include <sixdof/oracle/penetration_verdict.h>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

const PenetrationDepth k_truth{.lo = 0.199, .hi = 0.2, .closed = true};
constexpr double k_slack = 1e-6;

TEST(DepthVerdict, WithinTheIntervalIsRight) {
  for (const double claimed : {0.199 - 0.5 * k_slack, 0.1995, 0.2 + 0.5 * k_slack}) {
    EXPECT_EQ(judge_depth(k_truth, claimed, k_slack).verdict, DepthVerdict::right) << claimed;
  }
}

TEST(DepthVerdict, HalfOfItIsTooShallowAndTwiceTooDeep) {
  const JudgedDepth half = judge_depth(k_truth, 0.0995, k_slack), twice = judge_depth(k_truth, 0.4, k_slack);
  EXPECT_EQ(half.verdict, DepthVerdict::too_shallow);
  EXPECT_NEAR(half.shallow, 0.5, 1e-12);
  EXPECT_EQ(twice.verdict, DepthVerdict::too_deep);
  EXPECT_NEAR(twice.deep, 1.0, 1e-12);
}

TEST(DepthVerdict, NoneIsMissedUnlessTheBodiesOnlyTouch) {
  EXPECT_EQ(judge_depth(k_truth, 0.0, k_slack).verdict, DepthVerdict::missed);
  EXPECT_EQ(judge_depth(k_truth, -0.1, k_slack).shallow, 1.0);
  EXPECT_EQ(judge_depth({.hi = 1e-10, .closed = true}, 0.0, k_slack).verdict, DepthVerdict::right);
  EXPECT_EQ(judge_depth({.closed = true}, 0.1, k_slack).verdict, DepthVerdict::too_deep);
}

TEST(DepthVerdict, AnOpenIntervalJudgesNothing) {
  PenetrationDepth open = k_truth;
  open.closed = false;
  for (const double claimed : {0.0, 0.1, 0.3}) {
    EXPECT_EQ(judge_depth(open, claimed, k_slack).verdict, DepthVerdict::not_judged);
  }
}

}  // namespace
}  // namespace sixdof
