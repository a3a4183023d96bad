// Two runs of the same rows: a planted regression is shown as such, noise is not, and answers are compared.

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/report/comparison.h>

#include "result_text.h"

namespace sixdof::report {
namespace {

using test::Json;
using test::lines_with;
using test::number_in;
using test::text_in;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double k_noise = 0.04;       // of the logarithm of a mean, as two runs on one machine have it
constexpr double k_regression = 1.30;  // planted
constexpr int k_planted = 17;

/// 60 rows, each measured `repetitions` times with noise; row k_planted takes `factor` times as long.
std::vector<Json> run_of(unsigned seed, double factor, int repetitions) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise(0.0, k_noise);
  std::vector<Json> rows;
  for (int k = 0; k < 60; ++k) {
    for (int r = 0; r < repetitions; ++r) {
      const double mean = 1000.0 * (1 + k) * std::exp(noise(generator)) * (k == k_planted ? factor : 1.0);
      rows.push_back(test::row("distance", "a" + std::to_string(k), "p", "distance", 5.0, mean, {{"error_max", 1e-3}}));
    }
  }
  return rows;
}

Comparison compare_runs(const std::vector<Json>& before, const std::vector<Json>& after) {
  Results results;
  parse_results(test::file_of(before), "before.json", results);
  parse_results(test::file_of(after), "after.json", results);
  const auto all = comparisons(results, row_groups(results));
  EXPECT_EQ(all.size(), 1u);
  return all.at(0);
}

TEST(Comparison, PlantedRegressionIsShownAndNoiseIsNot) {
  int false_alarms = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Comparison comparison = compare_runs(run_of(seed, 1.0, 1), run_of(seed + 1000, k_regression, 1));
    const auto slower = lines_with(comparison.changes, {{"verdict", "slower"}});
    const auto planted = lines_with(comparison.changes, {{"algorithm", "a" + std::to_string(k_planted)}});
    ASSERT_EQ(planted.size(), 1u);
    const double ratio = number_in(comparison.changes, planted[0], "ratio");
    // With one measurement of each, noise may hide a part of it; the estimate is within four deviations all the same.
    EXPECT_NEAR(std::log(ratio), std::log(k_regression), 4.0 * std::sqrt(2.0) * k_noise) << seed;
    false_alarms += static_cast<int>(slower.size() + lines_with(comparison.changes, {{"verdict", "faster"}}).size());
    if (text_in(comparison.changes, planted[0], "verdict") == "slower") --false_alarms;
  }
  EXPECT_LE(false_alarms, 4) << "of 20 comparisons, each allowed 5 %";
}

TEST(Comparison, WithRepetitionsEveryPlantedRegressionIsShown) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Comparison comparison = compare_runs(run_of(seed, 1.0, 10), run_of(seed + 1000, k_regression, 10));
    const auto planted = lines_with(comparison.changes, {{"algorithm", "a" + std::to_string(k_planted)}});
    EXPECT_EQ(text_in(comparison.changes, planted.at(0), "verdict"), "slower") << seed;
    EXPECT_LT(number_in(comparison.changes, planted[0], "low"), k_regression);
    EXPECT_GT(number_in(comparison.changes, planted[0], "high"), k_regression);
    EXPECT_THAT(comparison.sentences, Contains(HasSubstr("from the repetitions")));
  }
}

/// 200 rows of a run whose noise is 5 to 10 %, each row its own; `between` is noise that a row's repetitions have in
/// common. Row k_planted takes `factor` times as long.
std::vector<Json> uneven_run(unsigned seed, double factor, int repetitions, double between) {
  constexpr int k_rows = 200;
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  std::vector<Json> rows;
  for (int k = 0; k < k_rows; ++k) {
    const double noise = 0.05 + 0.05 * k / k_rows, common = between * normal(generator);
    for (int r = 0; r < repetitions; ++r) {
      const double mean = 1000.0 * std::exp(common + noise * normal(generator)) * (k == k_planted ? factor : 1.0);
      rows.push_back(test::row("distance", "a" + std::to_string(k), "p", "distance", 5.0, mean));
    }
  }
  return rows;
}

/// Of `count` comparisons: those with a false alarm, and those that show the planted regression.
std::pair<int, int> count_alarms(unsigned count, double factor, int repetitions, double between) {
  int alarms = 0, shown = 0;
  for (unsigned seed = 1; seed <= count; ++seed) {
    const Comparison comparison = compare_runs(uneven_run(seed, 1.0, repetitions, between),
                                               uneven_run(seed + 1000, factor, repetitions, between));
    std::size_t changed = lines_with(comparison.changes, {{"verdict", "slower"}}).size() +
                          lines_with(comparison.changes, {{"verdict", "faster"}}).size();
    const auto planted = lines_with(comparison.changes, {{"algorithm", "a" + std::to_string(k_planted)}});
    const bool is_shown = factor != 1.0 && text_in(comparison.changes, planted.at(0), "verdict") == "slower";
    shown += is_shown ? 1 : 0;
    alarms += changed > (is_shown ? 1u : 0u) ? 1 : 0;
  }
  return {alarms, shown};
}

TEST(Comparison, NoiseOfDifferentSizeHasTheStatedRateOfFalseAlarms) {
  // 5 % of 40 are 2; more than 6 are one chance in a hundred.
  EXPECT_LE(count_alarms(40, 1.0, 1, 0.0).first, 6);
}

TEST(Comparison, RepetitionsShowARegressionInUnevenNoise) {
  const auto [alarms, shown] = count_alarms(10, k_regression, 10, 0.0);
  EXPECT_LE(alarms, 3);
  EXPECT_GE(shown, 9);
}

TEST(Comparison, WhatRepetitionsHaveInCommonIsNoChange) {
  const auto [alarms, shown] = count_alarms(10, k_regression, 10, 0.03);
  EXPECT_LE(alarms, 3);
  EXPECT_GE(shown, 6) << "nine of ten on average";
}

TEST(Comparison, QuietRunShowsTheRegressionWithoutRepetitions) {
  std::vector<Json> before = run_of(1, 1.0, 1), after = before;
  after[k_planted]["cpu_time"] = k_regression * before[k_planted]["cpu_time"].get<double>();
  const Comparison comparison = compare_runs(before, after);
  const auto slower = lines_with(comparison.changes, {{"verdict", "slower"}});
  ASSERT_EQ(slower.size(), 1u);
  EXPECT_EQ(text_in(comparison.changes, slower[0], "algorithm"), "a" + std::to_string(k_planted));
  EXPECT_THAT(comparison.sentences, Contains(HasSubstr("1 slower, 0 faster, 59 without a change")));
}

TEST(Comparison, AllRowsSlowerIsNoNoise) {
  std::vector<Json> before = run_of(1, 1.0, 1), after = before;
  for (Json& row : after) row["cpu_time"] = 1.5 * row["cpu_time"].get<double>();
  const Comparison comparison = compare_runs(before, after);
  EXPECT_EQ(lines_with(comparison.changes, {{"verdict", "slower"}}).size(), 60u);
}

TEST(Comparison, AnswersComeFirstAndOnlyOfTheSameConfigurations) {
  std::vector<Json> before = run_of(1, 1.0, 1), after = before;
  after[3]["error_max"] = 2e-3;
  after[4]["error_max"] = 2e-3;
  after[4]["configurations"] = 32;
  after[5]["p50_ns"] = 1.0;
  const Comparison comparison = compare_runs(before, after);
  ASSERT_EQ(comparison.answers.rows.size(), 1u);
  EXPECT_EQ(text_in(comparison.answers, comparison.answers.rows[0], "value"), "error_max");
  EXPECT_THAT(text_in(comparison.answers, comparison.answers.rows[0], "row"), HasSubstr("algorithm:a3/"));
  EXPECT_THAT(comparison.sentences[0], HasSubstr("values that changed: 1"));
  EXPECT_THAT(comparison.sentences[1], HasSubstr("whose answers are not compared: 1"));
}

TEST(Comparison, WordsOfAnswersHaveDigitsThatDiffer) {
  std::vector<Json> before = run_of(1, 1.0, 1), after = before;
  before[3]["error_max"] = 0.199575;
  after[3]["error_max"] = 0.199575001;
  const Comparison comparison = compare_runs(before, after);
  ASSERT_EQ(comparison.answers.rows.size(), 1u);
  EXPECT_EQ(text_in(comparison.answers, comparison.answers.rows[0], "words"), "0.199575 -> 0.199575001");
}

TEST(Comparison, FilesWithoutCommonRowsAreNotCompared) {
  Results results;
  parse_results(test::file_of(run_of(1, 1.0, 1)), "a.json", results);
  parse_results(test::file_of({test::row("collide", "x", "q", "distance", 1.0, 5.0)}), "b.json", results);
  EXPECT_TRUE(comparisons(results, row_groups(results)).empty());
}

}  // namespace
}  // namespace sixdof::report
