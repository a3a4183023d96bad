#include "bench/study/equivalent_rows.h"

#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>

namespace sixdof::study {
namespace {

constexpr double k_rounding = 1e-12;  // of means of two values

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A search with a first prediction of eta that is off by `off`, and an answer that is off by a tenth of it.
EquivalentResult result(double eta, double off) {
  const Parameter length = Parameter::number("size", "a length", "1", "0.1", 0.001, 1);
  const Parameter count = Parameter::count("count", "a count", "10", 1, 1000);
  EquivalentResult made{.scenario = "II",
                        .algorithm = "fake",
                        .settings = Settings({length, count}),
                        .law = "depth",
                        .axes = {ResolutionAxis{.parameter = "size"}, ResolutionAxis{.parameter = "count"}},
                        .options = {.target = 9e5},
                        .search = {}};
  made.search.grid = {{.at = {0.5, 20}, .time_ns = 3e5, .eta = 0.4, .bytes = 7, .counters = {{"misses", 0.0}}}};
  SearchStep step{.time_predicted_ns = 9e5, .eta_predicted = eta + off};
  step.measured = {.at = {0.25, 40}, .time_ns = 8e5, .eta = eta, .bytes = 9};
  made.search.steps = {step, step};
  made.search.steps[1].eta_predicted = eta - 0.1 * off;
  made.search.chosen = 1;
  return made;
}

TEST(EquivalentRows, HaveTheAnswerTheStepsAndTheGrid) {
  const std::vector<results::Row> rows = equivalent_rows(result(0.02, 0.01));
  std::vector<std::string> names;
  for (const results::Row& row : rows) names.push_back(row.name);
  const std::string prefix = "equivalent/scenario:II/algorithm:fake/tau:0.9ms";
  EXPECT_THAT(names, ElementsAre(prefix, prefix + "/step:0", prefix + "/step:1", prefix + "/size:0.5/count:20"));
  const auto answer = to_json_object(rows[0]);
  EXPECT_EQ(answer.at("eta_measured"), 0.02);
  EXPECT_NEAR(answer.at("eta_predicted"), 0.019, k_rounding);
  EXPECT_EQ(answer.at("predicted_ns"), 9e5);
  EXPECT_EQ(answer.at("measured_ns"), 8e5);
  EXPECT_EQ(answer.at("cpu_time"), 8e5);
  EXPECT_EQ(answer.at("tau_ns"), 9e5);
  EXPECT_EQ(answer.at("sixdof").at("settings").at("size"), 0.25);
  EXPECT_EQ(answer.at("sixdof").at("settings").at("count"), 40);
  EXPECT_EQ(answer.at("sixdof").at("scenario"), "II");
  EXPECT_THAT(answer.at("label").get<std::string>(), HasSubstr("not-within-tolerance"));
  const auto point = to_json_object(rows[3]);
  EXPECT_EQ(point.at("eta_measured"), 0.4);
  EXPECT_EQ(point.at("misses"), 0.0);
  EXPECT_FALSE(point.contains("eta_predicted"));
}

TEST(EquivalentRows, NameAnEtaThatWasGiven) {
  EquivalentResult reverse = result(0.02, 0.01);
  reverse.options.goal = Goal::eta;
  reverse.options.target = 0.025;
  const results::Row row = equivalent_rows(reverse).front();
  EXPECT_EQ(row.name, "equivalent/scenario:II/algorithm:fake/eta:0.025");
  EXPECT_EQ(to_json_object(row).at("eta_wanted"), 0.025);
}

TEST(EquivalentRows, WithoutAForceSayWhy) {
  EquivalentResult none = result(std::numeric_limits<double>::quiet_NaN(), 0.01);
  const auto json = to_json_object(equivalent_rows(none).front());
  EXPECT_EQ(json.at("error_occurred"), true);
  EXPECT_THAT(json.at("error_message").get<std::string>(), HasSubstr("no force"));
}

TEST(EquivalentRows, HaveTheMeasurementWithTheSettingsAsTheyAre) {
  EquivalentResult made = result(0.02, 0.01);
  made.at_defaults = Measurement{.at = {1.0, 10.0}, .time_ns = 4e5, .eta = 0.7, .bytes = 3};
  const results::Row row = equivalent_rows(made).back();
  EXPECT_EQ(row.name, "equivalent/scenario:II/algorithm:fake/tau:0.9ms/defaults");
  EXPECT_EQ(to_json_object(row).at("eta_measured"), 0.7);
}

TEST(EqualTimeAnswers, AreThoseOfSearchesForATimeWithTheirReadings) {
  EquivalentResult made = result(0.02, 0.01), reverse = made;
  made.search.steps[1].measured.counters = {{"sigma_F", 0.125}};
  made.search.steps[1].reach = Reach::below;
  made.at_defaults = Measurement{.at = {1.0, 10.0}, .time_ns = 4e5, .eta = 0.7, .counters = {{"sigma_F", 0.25}}};
  reverse.options.goal = Goal::eta;
  const std::vector<results::EqualTimeAnswer> answers = equal_time_answers(std::vector{made, reverse});
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].tau_ns, 9e5);
  EXPECT_EQ(answers[0].resolution, "size=0.25 count=40");
  EXPECT_EQ(answers[0].remark, "all faster, not converged");
  EXPECT_EQ(answers[0].found.mean_ns, 8e5);
  EXPECT_EQ(answers[0].found.values.at("sigma_F"), 0.125);
  ASSERT_TRUE(answers[0].at_defaults);
  EXPECT_EQ(answers[0].at_defaults->values.at("sigma_F"), 0.25);
}

TEST(PredictionError, IsAMeanOfDifferencesAndOfShares) {
  const std::vector<EquivalentResult> results{result(0.02, 0.01), result(0.5, -0.03),
                                              result(std::numeric_limits<double>::quiet_NaN(), 0.01)};
  const PredictionError first = prediction_error(results, true);
  EXPECT_EQ(first.searches, 2u);
  EXPECT_NEAR(first.difference, 0.02, k_rounding);
  EXPECT_NEAR(first.relative, (0.5 + 0.06) / 2.0, k_rounding);
  EXPECT_NEAR(prediction_error(results, false).difference, 0.002, k_rounding);
  EXPECT_EQ(prediction_error({}, true).searches, 0u);
}

TEST(Times, AreReadWithTheirUnitAndWritten) {
  EXPECT_EQ(parse_time_ns("0.9ms"), 0.9e6);
  EXPECT_EQ(parse_time_ns("250us"), 250e3);
  EXPECT_EQ(parse_time_ns("40ns"), 40.0);
  EXPECT_EQ(parse_time_ns("2s"), 2e9);
  EXPECT_EQ(time_text(0.9e6), "0.9ms");
  EXPECT_EQ(time_text(12345), "12.345us");
  EXPECT_EQ(time_text(0.01), "0.01ns");
  for (const char* const bad : {"0.9", "ms", "", "0.9 ms", "0.9msec", "0.9MS", "one ms"}) {
    EXPECT_THAT([&] { parse_time_ns(bad); }, ThrowsMessage<BadArgument>(HasSubstr("with a unit"))) << bad;
  }
  for (const char* const bad : {"0ms", "-1ms", "nanms", "infs"}) {
    EXPECT_THROW(parse_time_ns(bad), BadArgument) << bad;
  }
}

}  // namespace
}  // namespace sixdof::study
