#include <sixdof/results/growth.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/results/measured_pairs.h>
#include <sixdof/results/row_group.h>

#include "result_rows.h"

namespace sixdof::results {
namespace {

using test::Json;
using ::testing::ElementsAre;

TEST(PowerLaw, FindsOneExponentOfShapesWithFactorsOfTheirOwn) {
  PointsOfShapes points;
  for (const auto& [shape, factor] : {std::pair{"a", 3.0}, {"b", 50.0}}) {
    for (const double n : {1e3, 1e4, 1e5}) points[shape].emplace_back(n, factor * std::pow(n, 0.7));
  }
  const auto law = power_law(points);
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->exponent, 0.7, 1e-12);
  EXPECT_NEAR(law->half_width, 0.0, 1e-12);
  EXPECT_EQ(law->fitted, 6u);
}

TEST(PowerLaw, AgreesWithALineWorkedOutByHand) {
  // Logarithms (0, 0), (1, 2), (2, 1), (3, 3): slope 0.8, residual squares 1.8, so that the slope's standard error is
  // sqrt(1.8 / 2 / 5), and t = 4.3027 with two degrees of freedom.
  PointsOfShapes points;
  for (const auto& [x, y] : {std::pair{0, 0}, {1, 2}, {2, 1}, {3, 3}})
    points["a"].emplace_back(std::exp(x), std::exp(y));
  const auto law = power_law(points);
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->exponent, 0.8, 1e-12);
  EXPECT_NEAR(law->half_width, 4.3027 * std::sqrt(1.8 / 2.0 / 5.0), 1e-4);
}

TEST(PowerLaw, ItsIntervalHoldsTheExponentIn95Of100Cases) {
  std::mt19937_64 generator(4);
  std::normal_distribution<double> noise(0.0, 0.3);
  constexpr int k_runs = 2000;
  int held = 0;
  for (int run = 0; run < k_runs; ++run) {
    PointsOfShapes points;
    for (const char* const shape : {"a", "b"}) {
      for (const double n : {1e3, 3e3, 1e4, 3e4}) {
        points[shape].emplace_back(n, std::pow(n, 0.4) * std::exp(noise(generator)));
      }
    }
    const auto law = power_law(points);
    ASSERT_TRUE(law);
    held += std::abs(law->exponent - 0.4) <= law->half_width;
  }
  EXPECT_NEAR(static_cast<double>(held) / k_runs, 0.95, 0.02);  // four standard deviations of the count
}

TEST(PowerLaw, NeedsTwoNumbersOfTrianglesAndADegreeOfFreedom) {
  EXPECT_FALSE(power_law({}));
  EXPECT_FALSE(power_law({{"a", {{1e3, 1.0}}}, {"b", {{1e3, 2.0}}}}));
  EXPECT_FALSE(power_law({{"a", {{1e3, 1.0}, {1e4, 2.0}}}}));
  EXPECT_FALSE(power_law({{"a", {{1e3, 1.0}, {1e4, 2.0}, {1e5, 0.0}}}}));  // a value of zero has no logarithm
}

Json labelled(Json json, int triangles) {
  json["sixdof"].update({{"shape", "knot"}, {"triangles", triangles}});
  return json;
}

/// A row without a bucket.
Json plain_row(const std::string& query, const std::string& algorithm, int triangles, double cpu_ns,
               const Json& values = Json::object()) {
  Json json = test::row(query, algorithm, fmt::format("knot-{}", triangles), "distance", 0, cpu_ns, values);
  json["sixdof"].erase("bucket");
  return labelled(json, triangles);
}

std::vector<GrowthSeries> growth(const std::vector<Json>& rows) {
  const Results results = test::results_of(rows);
  return growth_of(row_groups(results));
}

TEST(Growth, FindsPlantedLawsOfTimesAndMemory) {
  std::vector<Json> rows;
  for (const int n : {1000, 4000, 16000}) {
    const std::string pair = fmt::format("knot-{}", n);
    rows.push_back(labelled(test::row("distance", "vps", pair, "distance", 5, 1e3 * std::pow(n, 0.25)), n));
    rows.push_back(labelled(test::row("distance", "vps", pair, "distance", 7, 1.0), n));  // not compared
    // Both answers of each are wrong: no time.
    rows.push_back(labelled(test::row("respond", "vps", pair, "volume", 5, 1.0, {{"mismatch", 64}}), n));
    rows.push_back(plain_row("prepare", "vps", n, 1e6 * n, {{"bytes", 8 * n * n}}));
    rows.push_back(plain_row("set", k_set_maker, n, 1e9 * std::sqrt(n)));
  }
  const auto found = growth(rows);
  std::vector<std::string> names;
  for (const GrowthSeries& each : found) names.push_back(each.algorithm + " " + each.quantity);
  ASSERT_THAT(names, ElementsAre("sixdof generate set, s", "vps distance, us", "vps memory, bytes", "vps prepare, ms"));
  const double exponents[] = {0.5, 0.25, 2.0, 1.0};
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_TRUE(found[i].law) << names[i];
    EXPECT_NEAR(found[i].law->exponent, exponents[i], 1e-9) << names[i];
    EXPECT_EQ(found[i].law->fitted, 3u);
  }
  EXPECT_NEAR(*value_at(found[0].points.at("knot"), 4000), std::sqrt(4000), 1e-9);
  EXPECT_NEAR(*value_at(found[3].points.at("knot"), 4000), 4000, 1e-9);
  EXPECT_FALSE(value_at(found[3].points.at("knot"), 5000));
}

TEST(Growth, AReportReadsWhatWasWritten) {
  const std::vector<GrowthSeries> written{
      {.algorithm = "vps",
       .quantity = "distance, us",
       .points = {{"knot", {{1e3, 2.5}}}},
       .law = PowerLaw{0.5, 0.1, 9}},
      {.algorithm = "ist", .quantity = "distance, us", .points = {{"knot", {{1e3, 0.5}}}}, .law = {}}};
  std::vector<GrowthSeries> read;
  take_growth({{"growth", nlohmann::json(written)}}, 3, read);
  EXPECT_EQ(nlohmann::json(read), nlohmann::json(written));
  EXPECT_EQ(read.at(1).file, 3u);
  EXPECT_FALSE(read.at(1).law);
}

TEST(MeasuredPairs, AreTheSetsThatWereMadeOrNot) {
  Json failed = plain_row("set", k_set_maker, 2000, 1.0);
  failed.update({{"error_occurred", true}, {"error_message", "no mesh: too few"}});
  const Results results = test::results_of({plain_row("set", k_set_maker, 1000, 1.0), failed});
  const auto groups = row_groups(results);
  const MeasuredPairs pairs = measured_pairs(groups);
  EXPECT_EQ(pairs.pairs.size(), 2u);
  ASSERT_EQ(pairs.sets_not_made.size(), 1u);
  EXPECT_EQ(pairs.sets_not_made[0].pair + ": " + pairs.sets_not_made[0].why, "knot-2000: no mesh: too few");
}

}  // namespace
}  // namespace sixdof::results
