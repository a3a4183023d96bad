// The words of the summary are those of the numbers.

#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/report/summary.h>

#include "result_text.h"

namespace sixdof::report {
namespace {

using test::Json;
using test::row;
using test::text_in;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Summary, WinnerIsTheFastestWithoutAFault) {
  const Results results = test::results_of(
      {row("distance", "null", "p", "distance", 5.0, 1.0),
       row("distance", "wrong", "p", "distance", 5.0, 2.0, {{"mismatch", 1}}),
       row("distance", "exact", "p", "distance", 5.0, 100.0), row("distance", "fcl-rss", "p", "distance", 5.0, 500.0),
       row("distance", "exact", "p", "distance", 9.0, 100.0), row("distance", "fcl-rss", "p", "distance", 9.0, 110.0)});
  const Summary summary = summarise(results, row_groups(results));
  ASSERT_EQ(summary.winners.rows.size(), 2u);
  EXPECT_EQ(text_in(summary.winners, summary.winners.rows[0], "fastest"), "exact");
  EXPECT_EQ(text_in(summary.winners, summary.winners.rows[0], "verdict"), "clear");
  EXPECT_EQ(test::number_in(summary.winners, summary.winners.rows[0], "times_faster"), 5.0);
  EXPECT_EQ(text_in(summary.winners, summary.winners.rows[1], "verdict"), "tie") << "10 % is within two runs' noise";
  EXPECT_THAT(
      summary.sentences,
      ElementsAre("Distance: the fastest without a wrong answer is exact, in 2 of 2 places, 2.35 times faster on "
                  "average than the next, fcl-rss.",
                  "How far the others are off: wrong answers, wrong 1 of 64 (distance).",
                  HasSubstr("1 of 6 rows have failures or wrong answers and are not ranked (wrong 1)")));
}

TEST(Summary, RowsOfOtherOrdersAndOfColdCachesAreNotRanked) {
  Json motion = row("distance", "exact", "p", "distance", 5.0, 1.0), path = motion, cold = motion;
  motion["sixdof"]["order"] = "motion";
  path["sixdof"]["order"] = "path";
  cold["sixdof"]["cache"] = "cold";
  motion["name"] = motion["name"].get<std::string>() + "/order:motion";
  path["name"] = path["name"].get<std::string>() + "/order:path";
  cold["name"] = cold["name"].get<std::string>() + "/cache:cold";
  const Results results = test::results_of({row("distance", "exact", "p", "distance", 5.0, 300.0),
                                            row("distance", "vps", "p", "distance", 5.0, 100.0), motion, path, cold});
  const auto groups = row_groups(results);
  std::vector<std::string> names;
  for (const RowGroup& group : groups) names.push_back(group.algorithm());
  EXPECT_THAT(names, ElementsAre("exact", "vps", "exact (motion)", "exact (path order)", "exact (cold)"));
  const Summary summary = summarise(results, groups);
  ASSERT_EQ(summary.winners.rows.size(), 1u);
  EXPECT_EQ(text_in(summary.winners, summary.winners.rows[0], "fastest"), "vps");
  EXPECT_EQ(test::number_in(summary.winners, summary.winners.rows[0], "times_faster"), 3.0);
}

TEST(Summary, CastsAreRankedByTheirMotion) {
  const auto cast = [](const char* algorithm, const char* motion, double ns, int wrong) {
    Json json = row("cast", algorithm, "p", "distance", 0.0, ns, {{"mismatch", wrong}});
    json["name"] = std::string(algorithm) + motion;
    json["sixdof"]["order"] = motion;
    return json;
  };
  const Results results =
      test::results_of({cast("exact", "translation/10", 100.0, 0), cast("fcl-cast", "translation/10", 400.0, 0),
                        cast("exact", "tumble/10", 300.0, 0), cast("fcl-cast", "tumble/10", 700.0, 0),
                        cast("sampled", "tumble/10", 3.0, 9)});
  const Summary summary = summarise(results, row_groups(results));
  ASSERT_EQ(summary.winners.rows.size(), 2u);
  EXPECT_EQ(text_in(summary.winners, summary.winners.rows[1], "bucket"), "tumble 10 %");
  EXPECT_THAT(summary.sentences,
              Contains(HasSubstr("First contact: the fastest without a wrong answer is exact, in 2 of 2 places")));
  EXPECT_THAT(summary.sentences, Contains(HasSubstr("wrong answers, sampled 9 of 64 (first contact)")));
}

TEST(Summary, AlgorithmWithAWrongAnswerAnywhereIsNotTheFastest) {
  Json hasty = row("collide", "hasty", "p", "distance", 5.0, 1.0);
  const Results results = test::results_of(
      {hasty, row("collide", "hasty", "p", "distance", 9.0, 1.0, {{"mismatch", 2}}),
       row("collide", "exact", "p", "distance", 5.0, 100.0), row("collide", "exact", "p", "distance", 9.0, 100.0),
       row("collide", "fcl-rss", "p", "distance", 5.0, 50.0), row("collide", "fcl-rss", "p", "distance", 9.0, 400.0)});
  EXPECT_THAT(
      summarise(results, row_groups(results)).sentences,
      ElementsAre(HasSubstr("Yes or no: the fastest without a wrong answer is exact, in 1 of 2 places, 4 times "
                            "faster than the next, fcl-rss; fcl-rss is in 1; faster, but approximate or elsewhere "
                            "wrong: hasty in 1 (50 times)."),
                  "How far the others are off: wrong answers, hasty 2 of 128 (yes or no).", HasSubstr("1 of 6 rows")));
}

TEST(Summary, ApproximationsAreNotTheFastestButNamedWithTheirErrors) {
  Json vps = row("distance", "vps", "p", "distance", 5.0, 1.0, {{"error_max", 0.004}});
  vps["sixdof"]["approximates"] = true;
  const Results results = test::results_of({vps, row("distance", "exact", "p", "distance", 5.0, 100.0)});
  const Summary summary = summarise(results, row_groups(results));
  EXPECT_THAT(summary.sentences,
              ElementsAre("Distance: the fastest without a wrong answer is exact, in 1 of 1 place; faster, but "
                          "approximate or elsewhere wrong: vps in 1 (100 times).",
                          "How far the others are off: distances, vps by up to 0.4 % of A's diagonal.",
                          HasSubstr("All 2 rows ran")));
  ASSERT_EQ(summary.winners.rows.size(), 1u);
  const auto& line = summary.winners.rows[0];
  EXPECT_EQ(text_in(summary.winners, line, "fastest"), "exact");
  EXPECT_EQ(text_in(summary.winners, line, "verdict"), "no other is right");
  EXPECT_EQ(text_in(summary.winners, line, "not_right_but_faster"), "vps");
  EXPECT_EQ(test::number_in(summary.winners, line, "by_factor"), 100.0);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(test::cell(summary.winners, line, "times_faster")))
      << "the figure has no point there";
}

/// Rows of three places: "right" and "slow" are right, "hasty" is the fastest but wrong in the last place, "rough" is
/// an approximation.
Results results_of_one_rule(const std::string& query, const std::string& kind) {
  std::vector<Json> rows;
  for (const double percent : {1.0, 5.0, 9.0}) {
    const Json force = query == "respond" ? Json{{"gamma_F_deg", 0.1}} : Json::object();
    rows.push_back(row(query, "right", "p", kind, percent, 100.0, force));
    rows.push_back(row(query, "slow", "p", kind, percent, percent == 1.0 ? 50.0 : 400.0, force));
    rows.push_back(row(query, "hasty", "p", kind, percent, 10.0, force));
    if (percent == 9.0) rows.back()["mismatch"] = 1;
    rows.push_back(row(query, "rough", "p", kind, percent, 20.0,
                       query == "respond" ? Json{{"gamma_F_deg", 15.0}} : Json::object()));
    if (query != "respond") rows.back()["sixdof"]["approximates"] = true;
  }
  return test::results_of(rows);
}

TEST(Summary, TableAndSentencesFollowOneRule) {
  for (const auto& [query, kind] :
       {std::pair("collide", "distance"), {"distance", "distance"}, {"respond", "volume"}}) {
    const Results results = results_of_one_rule(query, kind);
    const Summary summary = summarise(results, row_groups(results));
    std::map<std::string, int> places, faster;
    for (const auto& line : summary.winners.rows) {
      ++places[text_in(summary.winners, line, "fastest")];
      ++faster[text_in(summary.winners, line, "not_right_but_faster")];
      EXPECT_EQ(test::number_in(summary.winners, line, "times_faster"),
                text_in(summary.winners, line, "fastest") == "slow" ? 2.0 : 4.0);
    }
    EXPECT_EQ(places, (std::map<std::string, int>{{"right", 2}, {"slow", 1}})) << query;
    EXPECT_EQ(faster, (std::map<std::string, int>{{"hasty", 2}, {"rough", 1}})) << query;
    EXPECT_THAT(summary.sentences.front(),
                HasSubstr(" is right, in 2 of 3 places, 4 times faster on average than the next, slow; slow is in 1; "
                          "faster, but approximate or elsewhere wrong: hasty in 2 (7.07 times), rough in 1 (5 times)."))
        << query;
  }
}

TEST(Summary, ForcesAreRightToADegreeAndOthersAreNamedFarthestFirst) {
  const Results results =
      test::results_of({row("respond", "exact", "p", "volume", 5.0, 9.0, {{"gamma_F_deg", 0.0}}),
                        row("respond", "vps", "p", "volume", 5.0, 3.0, {{"gamma_F_deg", 12.0}}),
                        row("respond", "ist-descent", "p", "volume", 5.0, 18.0, {{"gamma_F_deg", 0.9}}),
                        row("respond", "ist", "p", "volume", 5.0, 18.0, {{"gamma_F_deg", 20.0}})});
  EXPECT_THAT(summarise(results, row_groups(results)).sentences,
              ElementsAre("Force and torque: the fastest with forces within 1 degree of the exact ones is exact, in 1 "
                          "of 1 place, 2 times faster than the next, ist-descent; faster, but approximate or "
                          "elsewhere wrong: vps in 1 (3 times).",
                          "How far the others are off: directions of forces on average, ist by 20 degrees, vps by 12 "
                          "degrees.",
                          HasSubstr("All 4 rows ran")));
}

TEST(Summary, NextOneIsNamed) {
  const Results results = test::results_of(
      {row("distance", "exact", "p", "distance", 1.0, 10.0), row("distance", "fcl-rss", "p", "distance", 1.0, 20.0),
       row("distance", "ode", "p", "distance", 1.0, 30.0), row("distance", "exact", "p", "distance", 5.0, 10.0),
       row("distance", "fcl-rss", "p", "distance", 5.0, 30.0), row("distance", "ode", "p", "distance", 5.0, 20.0),
       row("distance", "exact", "p", "distance", 9.0, 10.0), row("distance", "fcl-rss", "p", "distance", 9.0, 20.0)});
  EXPECT_EQ(summarise(results, row_groups(results)).sentences.front(),
            "Distance: the fastest without a wrong answer is exact, in 3 of 3 places, 2 times faster on average than "
            "the next, most often fcl-rss.");
}

TEST(Summary, InterpretedAlgorithmsAreRankedAmongThemselves) {
  std::vector<Json> rows{row("distance", "quick", "p", "distance", 5.0, 1.0),
                         row("distance", "slow", "p", "distance", 5.0, 2.0)};
  for (Json& each : rows) each["sixdof"]["runtime"] = "python";
  rows.push_back(row("distance", "exact", "p", "distance", 5.0, 10.0));
  rows.push_back(row("distance", "fcl-rss", "p", "distance", 5.0, 20.0));
  const Results results = test::results_of(rows);
  const Summary summary = summarise(results, row_groups(results));
  EXPECT_EQ(summary.sentences.front(),
            "Distance: the fastest without a wrong answer is exact, in 1 of 1 place, 2 times faster than the next, "
            "fcl-rss.");
  ASSERT_EQ(summary.winners.rows.size(), 2u);
  EXPECT_EQ(text_in(summary.winners, summary.winners.rows[0], "body"), "meshes (python)");
  EXPECT_EQ(text_in(summary.winners, summary.winners.rows[0], "fastest"), "quick");
  EXPECT_EQ(text_in(summary.winners, summary.winners.rows[1], "body"), "meshes");
  EXPECT_EQ(text_in(summary.winners, summary.winners.rows[1], "fastest"), "exact");
}

TEST(Summary, HardCasesAreCountedByAlgorithm) {
  Results results;
  parse_results(R"([{"family":"scale","algorithm":"ode","verdict":"wrong"},
                    {"family":"offset","algorithm":"ode","verdict":"crashed"},
                    {"family":"scale","algorithm":"vps","verdict":"within declared resolution"},
                    {"family":"offset","algorithm":"vps","verdict":"declared unsupported"}])",
                "s.json", results);
  EXPECT_THAT(
      summarise(results, row_groups(results)).sentences,
      ElementsAre("Hard cases: 1 of 2 algorithms pass every family (vps); families with a wrong or missing answer: "
                  "ode in 2."));
}

TEST(Summary, SaysThatARunWasInterruptedOrIsEmpty) {
  const Results broken =
      test::results_of({row("distance", "exact", "p", "distance", 5.0, 1.0)}, {{"interrupted", "true"}});
  EXPECT_THAT(summarise(broken, row_groups(broken)).sentences, Contains("[1] run was interrupted: rows are missing."));
  const Results empty = test::results_of({});
  EXPECT_THAT(summarise(empty, row_groups(empty)).sentences, ElementsAre("There are no rows to compare."));
}

}  // namespace
}  // namespace sixdof::report
