#include <sixdof/results/row.h>

#include <limits>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>

namespace sixdof::results {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Row row() {
  return {
      .name = "precision/respond/algorithm:vps",
      .fields = {.query = "precision", .algorithm = "vps", .settings = "voxel_size=0.01", .question = "respond"},
      .values = {{k_wall_mean, 12.5}, {k_processor_mean, 12.0}, {"processor_mean_ns_low", 11.0}, {"gamma_F_deg", 3.0}}};
}

TEST(Row, HaveAClassWhereTheyAreComparedWithFewOthers) {
  const auto bodies = [](const char* pair, const char* body, const char* runtime) {
    return bodies_of({.query = "collide", .algorithm = "x", .pair = pair, .body = body, .runtime = runtime});
  };
  EXPECT_EQ(bodies("p", "", ""), "p");
  EXPECT_EQ(bodies("p", "", "native"), "p");
  EXPECT_EQ(bodies("p", "convex_hull", "native"), "p (convex_hull)");
  EXPECT_EQ(bodies("p", "", "node"), "p (node)");
  EXPECT_EQ(bodies("p", "convex_hull", "wasm"), "p (convex_hull, wasm)");
  EXPECT_EQ(bodies("", "", "python"), "python");
}

TEST(Row, AreRowsOfGoogleBenchmark) {
  const auto json = to_json_object(row());
  EXPECT_EQ(json.at("name"), json.at("run_name"));
  EXPECT_EQ(json.at("run_type"), "iteration");
  EXPECT_EQ(json.at("time_unit"), "ns");
  EXPECT_EQ(json.at("real_time"), 12.5);
  EXPECT_EQ(json.at("cpu_time"), 12.0);
  EXPECT_EQ(json.at("gamma_F_deg"), 3.0);
  EXPECT_EQ(row_fields_of(json.at("sixdof")).question, "respond");
  EXPECT_FALSE(json.contains("error_occurred"));
  const Row read = parse_row(json);
  std::map<std::string, double> values = row().values;
  values["iterations"] = 1.0;
  EXPECT_EQ(read.values, values);
  EXPECT_EQ(read.estimate("cpu_time")->low, 11.0);
  EXPECT_EQ(read.estimate("gamma_F_deg")->high, 3.0);
}

TEST(Row, WithoutAResultSayWhy) {
  Row failed = row();
  failed.error = "no memory";
  const auto json = to_json_object(failed);
  EXPECT_EQ(json.at("error_occurred"), true);
  EXPECT_EQ(json.at("error_message"), "no memory");
  EXPECT_FALSE(json.contains("real_time"));
}

TEST(Row, RefuseCountersThatAreUnknownOrNotFinite) {
  Row bad = row();
  bad.values = {{"no_such_metric", 1.0}};
  EXPECT_THAT([&] { to_json_object(bad); }, ThrowsMessage<Error>(HasSubstr("no_such_metric is not in the table")));
  bad.values = {{"gamma_F_deg", std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_THAT([&] { to_json_object(bad); }, ThrowsMessage<Error>(HasSubstr("gamma_F_deg is not finite")));
}

}  // namespace
}  // namespace sixdof::results
