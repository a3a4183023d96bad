#include <sixdof/results/rivals.h>

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "result_rows.h"

namespace sixdof::results {
namespace {

using test::Json;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::vector<std::string> k_fcl{"fcl-*"};

Json row(const char* algorithm, double us, const Json& values = Json::object(), double percent = 5.0) {
  return test::row("distance", algorithm, "knot", "distance", percent, 1e3 * us, values);
}

std::vector<Rivalry> of_files(const std::vector<std::vector<Json>>& files, const std::string& algorithm = "exact",
                              const std::vector<std::string>& against = k_fcl) {
  Results results;
  for (const auto& rows : files) parse_results(test::file_of(rows), "seed.json", results);
  return rivalries(row_groups(results), algorithm, against);
}

TEST(Rivalries, TakeTheFastestOtherOfEachFile) {
  // The median of the ratios is not that of the times.
  const auto found = of_files({{row("exact", 10), row("fcl-a", 200), row("fcl-b", 300), row("ode", 1)},
                               {row("exact", 10), row("fcl-a", 400), row("fcl-b", 300)},
                               {row("exact", 20), row("fcl-a", 240), row("fcl-b", 300)},
                               {row("exact", 20)}});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].bodies + " " + found[0].query + " " + found[0].place, "knot distance distance 5 %");
  EXPECT_THAT(found[0].ratios(), ElementsAre(20.0, 30.0, 12.0));
  EXPECT_THAT(found[0].rivals, ElementsAre("fcl-a", "fcl-b", "fcl-a"));
  EXPECT_EQ(median(found[0].ratios()), 20.0);
}

TEST(Rivalries, LeaveOutFaultsAndOtherOrders) {
  Json motion = row("fcl-b", 1);
  motion["sixdof"]["order"] = "motion";
  motion["name"] = "motion";
  EXPECT_THAT(of_files({{row("exact", 10), row("fcl-a", 20, {{"failed", 1}}), row("fcl-c", 50), motion}})[0].rivals,
              ElementsAre("fcl-c"));
  EXPECT_THAT(of_files({{row("exact", 10, {{"mismatch", 1}}), row("fcl-a", 20)}}), IsEmpty());
}

TEST(Rivalries, CompareTheTimeOfAConfigurationOrOfAFrame) {
  const auto with_fields = [](Json json, const char* name, const Json& fields) {
    json["sixdof"].erase("bucket");
    json["sixdof"].update(fields);
    json["name"] = name;
    return json;
  };
  const Json made = {{"query", "generate"}, {"target", "distance"}},
             played = {{"query", "scene"}, {"scenario", "pile"}, {"question", "near"}};
  EXPECT_THAT(of_files({{with_fields(row("raycast", 9, {{"ns_per_configuration", 2e4}}), "g/a", made),
                         with_fields(row("fcl", 1, {{"ns_per_configuration", 3e6}}), "g/b", made)}},
                       "raycast", {"fcl"})[0]
                  .ratios(),
              ElementsAre(150.0));
  const auto scenes = of_files({{with_fields(row("exact", 9, {{"processor_ns", 5e3}}), "s/a", played),
                                 with_fields(row("fcl-sap", 1, {{"processor_ns", 1e4}}), "s/b", played)}});
  ASSERT_EQ(scenes.size(), 1u);
  EXPECT_EQ(scenes[0].place, "pile, near");
  EXPECT_THAT(scenes[0].ratios(), ElementsAre(2.0));
}

TEST(Patterns, HaveStarsForAnyPart) {
  const std::vector<std::string> patterns{"fcl-*", "ode"};
  for (const char* const name : {"fcl-rss", "fcl-", "ode"}) EXPECT_TRUE(fits(name, patterns)) << name;
  for (const char* const name : {"fcl", "ode-2", "xfcl-rss", ""}) EXPECT_FALSE(fits(name, patterns)) << name;
}

}  // namespace
}  // namespace sixdof::results
