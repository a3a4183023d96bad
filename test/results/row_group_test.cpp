// Which rows have a fault, and who wins.

#include <sixdof/results/row_group.h>

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/results/contest.h>

#include "result_rows.h"

namespace sixdof::results {
namespace {

using test::Json;
using test::row;
using ::testing::ElementsAre;

std::vector<std::string> faults_of(const Results& results) {
  std::vector<std::string> texts;
  for (const RowGroup& group : row_groups(results)) texts.push_back(to_string(group.faults));
  return texts;
}

TEST(Faults, AreCounted) {
  EXPECT_THAT(
      faults_of(test::results_of({row("respond", "vps", "p", "volume", 1.0, 1.0,
                                      {{"failed", 2}, {"mismatch", 3}, {"judged", 62}, {"misses", 4}, {"crashed", 1}}),
                                  row("distance", "vps", "p", "distance", 1.0, 1.0, {{"misses", 4}}),
                                  row("distance", "null", "p", "distance", 1.0, 1.0)})),
      ElementsAre("2 of 64 failed, 1 of 64 crashed, 3 of 62 wrong, 4 of 62 without a force though the bodies "
                  "overlap",
                  "", "returns constants: measures the overhead of the harness"))
      << "a miss is a response's";
}

TEST(Faults, AConstantAnswerIsNoneAnywhere) {
  Json hulls = row("collide", "no", "p", "distance", 5.0, 1.0);
  hulls["sixdof"]["body"] = "convex_hull";
  hulls["name"] = "hulls";
  EXPECT_THAT(faults_of(test::results_of({row("collide", "no", "p", "distance", 5.0, 1.0), hulls,
                                          row("collide", "no", "q", "distance", 5.0, 1.0),
                                          row("collide", "no", "p", "volume", 5.0, 1.0, {{"mismatch", 64}})})),
              ElementsAre("no right answer at volume 05 %", "", "", "64 of 64 wrong"))
      << "of the same pair, and about the same bodies";
}

TEST(Faults, ForcesOfBodiesThatAreApart) {
  const Json phantoms = {{"mismatch", 64}};
  Json spheres = row("respond", "ist", "p", "distance", 1.0, 1.0, phantoms);
  spheres["sixdof"]["approximates"] = true;
  EXPECT_THAT(faults_of(test::results_of({spheres, row("respond", "ist", "p", "volume", 1.0, 1.0),
                                          row("respond", "x", "p", "distance", 1.0, 1.0, phantoms),
                                          row("respond", "x", "p", "volume", 1.0, 1.0)})),
              ElementsAre("64 of 64 approximate", "", "64 of 64 with a force though the bodies are apart",
                          "no right answer at distance 01 %"))
      << "approximated bodies that are too large may overlap rightly; a force everywhere is no answer";
}

TEST(Faults, OfOneRepetitionAreTheRows) {
  Json broken = row("distance", "x", "p", "distance", 5.0, 4.0);
  broken.update({{"error_occurred", true}, {"error_message", "out of luck"}});
  const Results results = test::results_of({broken, row("distance", "x", "p", "distance", 5.0, 2.0, {{"failed", 1}}),
                                            row("distance", "x", "p", "distance", 5.0, 4.0, {{"failed", 3}})});
  const std::vector<RowGroup> groups = row_groups(results);
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(to_string(groups[0].faults), "not run: out of luck, 3 of 64 failed");
  EXPECT_EQ(groups[0].value(k_processor_mean), 3.0);
  EXPECT_EQ(groups[0].row().error, "");
}

TEST(Faults, OfAStudyAreNotItsErrors) {
  Json point = row("precision", "x", "p", "distance", 5.0, 4.0, {{"mismatch", 9}, {"misses", 1}});
  point["sixdof"].erase("bucket");
  point["sixdof"]["configurations"] = 32;
  EXPECT_THAT(faults_of(test::results_of({point})), ElementsAre("1 of 32 without a force though the bodies overlap"));
}

TEST(Contest, RanksInterpretedAlgorithmsApart) {
  const auto of = [](const char* algorithm, const char* runtime, double ns) {
    Json json = row("distance", algorithm, "p", "distance", 5.0, ns);
    json["sixdof"]["runtime"] = runtime;
    return json;
  };
  const Results results =
      test::results_of({row("distance", "exact", "p", "distance", 5.0, 300.0), of("parry", "native", 200.0),
                        of("coal", "python", 100.0), of("fcl", "python", 150.0), of("jolt", "wasm", 50.0)});
  const std::vector<RowGroup> groups = row_groups(results);
  const std::vector<Contest> all = contests(groups);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].bodies + ": " + all[0].winner().algorithm(), "p: parry");
  EXPECT_EQ(all[1].bodies + ": " + all[1].winner().algorithm(), "p (python): coal");
  EXPECT_EQ(all[2].bodies + ": " + all[2].winner().algorithm(), "p (wasm): jolt");
}

TEST(Contest, IsWonByTheFastestWithoutAFault) {
  Json motion = row("distance", "slow", "p", "distance", 5.0, 1.0), cold = motion;
  motion["sixdof"]["order"] = "motion";
  motion["name"] = "motion";
  cold["sixdof"]["cache"] = "cold";
  cold["name"] = "cold";
  const Results results = test::results_of({row("distance", "slow", "p", "distance", 5.0, 300.0), motion, cold,
                                            row("distance", "fast", "p", "distance", 5.0, 100.0),
                                            row("distance", "wrong", "p", "distance", 5.0, 10.0, {{"mismatch", 1}})});
  const std::vector<RowGroup> groups = row_groups(results);
  const std::vector<Contest> all = contests(groups);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].winner().algorithm(), "fast");
  EXPECT_EQ(all[0].factor(), 3.0);
  EXPECT_TRUE(all[0].is_clear());
  EXPECT_EQ(all[1].winner().algorithm(), "slow (motion)");
}

}  // namespace
}  // namespace sixdof::results
