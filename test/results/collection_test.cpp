#include <sixdof/results/collection.h>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/results/row_group.h>

#include "result_rows.h"

namespace sixdof::results {
namespace {

using test::Json;
using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// What a row belongs to.
struct Of {
  std::string object, partner = "self", kind = "boxy";
  int triangles = 1000;
  double volume_unit = 1.0;
};

Json labelled(Json json, const Of& of) {
  json["sixdof"].update({{"object", of.object}, {"partner", of.partner}, {"kind", of.kind}});
  json["sixdof"].update({{"triangles", of.triangles}, {"volume_unit", of.volume_unit}});
  return json;
}

Json row(const Of& of, const char* algorithm, double us, const Json& values = Json::object()) {
  return labelled(test::row("distance", algorithm, of.object + "." + of.partner, "distance", 5.0, 1e3 * us, values),
                  of);
}

Json error_row(const Of& of, const char* query, const char* algorithm, const char* why) {
  const std::string pair = of.object + "." + of.partner;
  return labelled(
      {{"name", fmt::format("{}/algorithm:{}/pair:{}", query, algorithm, pair)},
       {"error_occurred", true},
       {"error_message", why},
       {"sixdof", {{"query", query}, {"algorithm", algorithm}, {"settings", Json::object()}, {"pair", pair}}}},
      of);
}

nlohmann::json summary_of(const std::vector<Json>& rows) {
  const Results results = test::results_of(rows);
  return to_json_object(collection_of(row_groups(results)));
}

nlohmann::json of_algorithm(const nlohmann::json& list, const std::string& name) {
  for (const auto& each : list) {
    if (each.at("algorithm") == name) return each;
  }
  throw std::out_of_range(name);
}

TEST(Collection, MeanAndSpreadAreOverObjects) {
  const auto summary = summary_of({row({"a"}, "exact", 1), row({"b"}, "exact", 2), row({"c"}, "exact", 3),
                                   row({"d"}, "exact", 10), row({"e"}, "exact", 4)});
  ASSERT_EQ(summary.at("cells").size(), 1u);
  const auto& cell = summary.at("cells")[0];
  EXPECT_EQ(cell.at("objects"), 5);
  EXPECT_DOUBLE_EQ(cell.at("mean_us"), 4.0);
  EXPECT_DOUBLE_EQ(cell.at("median_us"), 3.0);
  EXPECT_DOUBLE_EQ(cell.at("p10_us"), 1.4);
  EXPECT_DOUBLE_EQ(cell.at("p90_us"), 7.6);
  EXPECT_EQ(cell.at("least_us"), 1.0);
  EXPECT_EQ(cell.at("greatest_us"), 10.0);
  EXPECT_EQ(cell.at("greatest_object"), "d");
}

TEST(Collection, RatiosNameTheObjectsWhereAnAlgorithmIsWorstAndBest) {
  std::vector<Json> rows;
  for (const auto& [object, us] : {std::pair{"a", 4.0}, {"b", 64.0}, {"c", 16.0}, {"d", 1.0}}) {
    rows.push_back(row({object}, "exact", 2));
    rows.push_back(row({object}, "slow", us));
  }
  const auto slow = of_algorithm(summary_of(rows).at("against_exact"), "slow");
  EXPECT_DOUBLE_EQ(slow.at("ratio"), std::pow(2.0 * 32.0 * 8.0 * 0.5, 0.25));
  EXPECT_EQ(slow.at("objects"), 4);
  EXPECT_EQ(slow.at("faster"), 1);
  EXPECT_EQ(slow.at("least").at("object"), "d");
  std::vector<std::string> worst;
  for (const auto& each : slow.at("worst")) worst.push_back(each.at("object"));
  EXPECT_THAT(worst, ElementsAre("b", "c", "a"));
  EXPECT_DOUBLE_EQ(slow.at("worst")[0].at("ratio"), 32.0);
}

TEST(Collection, ARatioIsTheGeometricMeanOverBuckets) {
  std::vector<Json> rows;
  for (const auto& [percent, us] : {std::pair{1.0, 3.0}, {5.0, 12.0}}) {
    rows.push_back(labelled(test::row("distance", "exact", "a", "distance", percent, 1e3), {"a"}));
    rows.push_back(labelled(test::row("distance", "slow", "a", "distance", percent, us * 1e3), {"a"}));
  }
  EXPECT_DOUBLE_EQ(of_algorithm(summary_of(rows).at("against_exact"), "slow").at("ratio"), 6.0);
}

TEST(Collection, ARowAtFaultCountsForNoTimeAndIsListed) {
  const auto summary = summary_of({row({"a"}, "exact", 1), row({"a"}, "bad", 1, {{"mismatch", 2}}),
                                   row({"a"}, "lost", 1, {{"failed", 1}}), row({"a"}, "null", 1)});
  ASSERT_EQ(summary.at("cells").size(), 1u);
  EXPECT_EQ(summary.at("cells")[0].at("algorithm"), "exact");
  ASSERT_EQ(summary.at("faults").size(), 3u);
  EXPECT_EQ(summary.at("faults")[0].at("why"), "2 of 64 wrong");
  EXPECT_EQ(summary.at("faults")[0].at("unit"), "a.self");
  EXPECT_THAT(summary.at("faults")[0].at("row").get<std::string>(), HasSubstr("algorithm:bad"));
  EXPECT_EQ(summary.at("faults")[1].at("why"), "1 of 64 failed");
}

TEST(Collection, PartnersAreKeptApartAndVolumesAreInTheirUnit) {
  const Of tenth{.object = "a", .partner = "tenth", .volume_unit = 1e-3}, self{.object = "a"};
  const auto cells = summary_of({labelled(test::row("respond", "exact", "t", "volume", 0.005, 1e3), tenth),
                                 labelled(test::row("respond", "exact", "s", "volume", 5.0, 3e3), self)})
                         .at("cells");
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(cells[0].at("partner"), "self");
  EXPECT_EQ(cells[1].at("partner"), "tenth");
  for (const auto& cell : cells) EXPECT_EQ(cell.at("bucket").dump(), R"({"kind":"volume","percent":5})");
}

TEST(Collection, KindsAreComparedAtEqualNumbersOfTriangles) {
  // Times are n^0.5, of thin objects four times as long: all factors but the geometric mean of both are removed.
  std::vector<Json> rows;
  for (const std::string kind : {"boxy", "thin"}) {
    for (const int n : {1000, 4000, 16000, 64000}) {
      const Of of{.object = kind + std::to_string(n), .kind = kind, .triangles = n};
      rows.push_back(row(of, "exact", (kind == "thin" ? 4.0 : 1.0) * std::sqrt(n)));
    }
  }
  const auto found = summary_of(rows).at("hardness");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].at("exponent"), 0.5, 1e-12);
  EXPECT_NEAR(found[0].at("kinds").at("thin").at("factor"), 2.0, 1e-12);
  EXPECT_NEAR(found[0].at("kinds").at("boxy").at("factor"), 0.5, 1e-12);
  EXPECT_EQ(found[0].at("kinds").at("boxy").at("objects"), 4);
  rows.pop_back();
  EXPECT_THAT(summary_of(rows).at("hardness"), IsEmpty());  // seven objects are too few
}

TEST(Collection, CastsOfDifferentMotionsAreKeptApart) {
  const auto cast = [](const char* algorithm, const char* motion, double us) {
    Json json = labelled(test::row("cast", algorithm, "a.self", "distance", 0.0, 1e3 * us), {"a"});
    json["name"] = std::string("cast/algorithm:") + algorithm + "/" + motion;
    json["sixdof"]["order"] = motion;
    return json;
  };
  const auto summary = summary_of({cast("exact", "translation/10", 2), cast("exact", "tumble/10", 5),
                                   cast("slow", "translation/10", 6), cast("slow", "tumble/10", 10)});
  ASSERT_EQ(summary.at("cells").size(), 4u);
  EXPECT_EQ(summary.at("cells")[0].at("query"), "cast translation/10");
  EXPECT_DOUBLE_EQ(summary.at("cells")[0].at("mean_us"), 2.0);
  EXPECT_EQ(summary.at("cells")[2].at("query"), "cast tumble/10");
  std::vector<double> ratios;
  for (const auto& each : summary.at("against_exact")) {
    if (each.at("algorithm") == "slow") ratios.push_back(each.at("ratio"));
  }
  EXPECT_THAT(ratios, ElementsAre(DoubleEq(3.0), DoubleEq(2.0)));
}

TEST(Collection, WhatDidNotEndIsListed) {
  const auto summary = summary_of({error_row({"a"}, "set", "sixdof generate", "no volumes: not made in time"),
                                   error_row({"a"}, "pair", "ist", "not done in 10 s")});
  EXPECT_EQ(summary.at("units"), 1);
  EXPECT_EQ(summary.at("objects").dump(), R"(["a"])");
  EXPECT_EQ(summary.at("sets_not_made").dump(), R"([{"unit":"a.self","why":"no volumes: not made in time"}])");
  EXPECT_EQ(summary.at("not_measured").dump(), R"([{"algorithm":"ist","unit":"a.self","why":"not done in 10 s"}])");
  EXPECT_THAT(summary.at("faults"), IsEmpty());
}

TEST(Collection, AReportReadsWhatWasWritten) {
  const auto summary = summary_of({row({"a"}, "exact", 1), row({"a"}, "slow", 3)});
  Collection read;
  take_collection({{"collection", summary}}, 7, read);
  ASSERT_EQ(read.cells.size(), 2u);
  EXPECT_EQ(read.cells[0].file, 7u);
  EXPECT_EQ(nlohmann::json(to_json_object(read)).at("cells"), summary.at("cells"));
  EXPECT_EQ(nlohmann::json(to_json_object(read)).at("against_exact"), summary.at("against_exact"));
}

}  // namespace
}  // namespace sixdof::results
