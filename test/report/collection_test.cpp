// What bench/scripts/collection and growth write, and how a report reads it.

#include <sixdof/results/collection.h>

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/report/tables.h>

#include "result_text.h"

namespace sixdof::report {
namespace {

using test::Json;
using test::lines_with;
using test::number_in;
using test::text_in;
using ::testing::HasSubstr;

Json document() {
  const Json cell = {{"partner", "self"},  {"query", "distance"}, {"bucket", {{"kind", "distance"}, {"percent", 5}}},
                     {"algorithm", "vps"}, {"objects", 30},       {"mean_us", 4.0},
                     {"median_us", 3.0},   {"least_us", 1.0},     {"p10_us", 2.0},
                     {"p90_us", 9.0},      {"greatest_us", 20.0}, {"greatest_object", "bed"}};
  const Json ratio = {
      {"partner", "self"},  {"query", "distance"},
      {"algorithm", "vps"}, {"objects", 30},
      {"ratio", 3.0},       {"p10", 1.5},
      {"p90", 8.0},         {"worst", {{{"object", "bed"}, {"ratio", 12.0}}, {{"object", "cup"}, {"ratio", 11.0}}}},
      {"faster", 1},        {"least", {{"object", "dot"}, {"ratio", 0.9}}}};
  const Json growth = {
      {"algorithm", "vps"}, {"quantity", "distance, us"}, {"points", {{"knot", {{1000, 2.0}, {4000, 4.0}}}}},
      {"exponent", 0.5},    {"half_width", 0.1},          {"fitted", 9}};
  return {{"benchmarks", Json::array()},
          {"collection", {{"cells", {cell}}, {"against_exact", {ratio}}}},
          {"growth", {growth}}};
}

Results results_of(const Json& json) {
  Results results;
  parse_results(json.dump(), "runs/results.json", results);
  return results;
}

std::string refusal(const Json& json) {
  try {
    results_of(json);
  } catch (const BadFile& e) {
    return e.what();
  }
  return "";
}

TEST(Collection, TablesHaveMeansQuantilesAndTheWorstObjects) {
  const Results results = results_of(document());
  const DataTable times = collection_table(results);
  ASSERT_EQ(times.rows.size(), 1u);
  EXPECT_EQ(number_in(times, times.rows[0], "mean_us"), 4.0);
  EXPECT_EQ(number_in(times, times.rows[0], "p90_us"), 9.0);
  EXPECT_EQ(text_in(times, times.rows[0], "slowest_object"), "bed");
  const DataTable ratios = collection_ratios_table(results);
  ASSERT_EQ(ratios.rows.size(), 3u);
  EXPECT_EQ(number_in(ratios, lines_with(ratios, {{"point", k_mean_of_objects}}).at(0), "ratio"), 3.0);
  EXPECT_EQ(number_in(ratios, lines_with(ratios, {{"point", "cup"}}).at(0), "ratio"), 11.0);
}

TEST(Collection, GrowthHasPointsAndExponents) {
  const Results results = results_of(document());
  const DataTable growth = growth_table(results);
  ASSERT_EQ(growth.rows.size(), 2u);
  EXPECT_EQ(number_in(growth, growth.rows[1], "triangles"), 4000.0);
  const DataTable exponents = growth_exponents_table(results);
  ASSERT_EQ(exponents.rows.size(), 1u);
  EXPECT_DOUBLE_EQ(number_in(exponents, exponents.rows[0], "low"), 0.4);
  EXPECT_DOUBLE_EQ(number_in(exponents, exponents.rows[0], "high"), 0.6);
}

TEST(Collection, MalformedMembersAreRefused) {
  Json json = document();
  json["collection"]["cells"][0].erase("mean_us");
  EXPECT_THAT(refusal(json), HasSubstr("runs/results.json: key 'mean_us' not found"));
  json = document();
  json["growth"][0]["points"]["knot"][0] = "x";
  EXPECT_THAT(refusal(json), HasSubstr("results.json: "));
  json = document();
  json["growth"] = 5;
  EXPECT_THAT(refusal(json), HasSubstr("\"growth\" is no array"));
}

}  // namespace
}  // namespace sixdof::report
