#include "bench/common/study_progress.h"

#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sixdof {
namespace {

using ::testing::ElementsAre;
using ::testing::MatchesRegex;
using ::testing::SizeIs;

constexpr double k_day_s = 86'400.0;

struct Lines {
  std::vector<std::string> lines;
  std::function<void(const std::string&)> print() {
    return [this](const std::string& line) { lines.push_back(line); };
  }
};

TEST(StudyProgress, TheFirstPartTellsHowLongAllTakes) {
  Lines told;
  StudyProgress progress("agree", k_day_s, told.print());
  progress.begin("2 pairs", 4.0);
  progress.finished("bunny", 1.0);
  progress.finished("ship", 3.0);
  EXPECT_THAT(told.lines, ElementsAre("agree: 2 pairs", MatchesRegex("agree: about .* in all, the budget is 24 h"),
                                      MatchesRegex("agree: bunny: 25 % done, [0-9:]+ left"),
                                      MatchesRegex("agree: ship: 100 % done, 0:00:00 left")));
}

TEST(StudyProgress, AnEstimateMayComeBeforeAndTheWorkMayGrow) {
  Lines told;
  StudyProgress progress("equivalent", StudyProgress::k_no_limit, told.print());
  progress.begin("6 searches", 1.0);
  progress.estimate(90.0, 90.0);
  progress.set_remaining(100.0);
  progress.finished("a", 50.0);
  progress.set_remaining(150.0);
  progress.finished("b", 50.0);
  EXPECT_THAT(told.lines, ElementsAre("equivalent: 6 searches", "equivalent: about 1.5 min in all",
                                      MatchesRegex("equivalent: a: 50 % done, .* left"),
                                      MatchesRegex("equivalent: b: 50 % done, .* left")));
}

TEST(StudyProgress, NothingMayBeLeft) {
  Lines told;
  StudyProgress progress("equivalent", StudyProgress::k_no_limit, told.print());
  progress.begin("1 search", 1.0);
  progress.estimate(0.0, 0.0);
  EXPECT_EQ(told.lines.back(), "equivalent: nothing is left to measure");
}

TEST(StudyProgress, ManySmallPartsHaveTwentyLines) {
  Lines told;
  StudyProgress progress("stress", StudyProgress::k_no_limit, told.print());
  progress.begin("cells", 1000.0);
  for (std::size_t done = 0; done <= 1000; ++done) progress.counted(done, 1000, "cells");
  ASSERT_THAT(told.lines, SizeIs(22));
  EXPECT_THAT(told.lines[2], MatchesRegex("stress: 50 of 1000 cells: 5 % done, .* left"));
  EXPECT_THAT(told.lines.back(), MatchesRegex("stress: 1000 of 1000 cells: 100 % done, 0:00:00 left"));
}

TEST(StudyProgress, TheTimeLeftIsThatOfTheBudgetAtMost) {
  Lines told;
  StudyProgress progress("precision", 1e-9, told.print());
  progress.begin("points", 1e9);
  progress.finished("one", 1.0);
  EXPECT_LT(progress.left_s(), 0.0);
  EXPECT_EQ(told.lines.back(), "precision: one: 0 % done, 0:00:00 left");
}

TEST(StudyProgress, SaysWhatWasLeftOutAndWhy) {
  Lines told;
  StudyProgress nothing("agree", StudyProgress::k_no_limit, told.print());
  nothing.end();
  StudyProgress some("agree", StudyProgress::k_no_limit, told.print());
  some.leave_out("brute-force", "slow");
  some.end();
  EXPECT_THAT(told.lines, ElementsAre("agree: nothing was left out", "agree: left out: brute-force: slow"));
  EXPECT_THAT(some.left_out(), SizeIs(1));
}

}  // namespace
}  // namespace sixdof
