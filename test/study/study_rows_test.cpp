#include "bench/study/study_rows.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>

namespace sixdof::study {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

StudyRow row() {
  return {.name = "precision/respond/algorithm:vps",
          .fields = {.query = "precision", .algorithm = "vps", .settings = "voxel_size=0.01", .question = "respond"},
          .real_time_ns = 12.5,
          .cpu_time_ns = 12.0,
          .counters = {{"gamma_F_deg", 3.0}}};
}

TEST(StudyRows, AreRowsOfGoogleBenchmark) {
  const auto json = to_json_object(row());
  EXPECT_EQ(json.at("name"), json.at("run_name"));
  EXPECT_EQ(json.at("run_type"), "iteration");
  EXPECT_EQ(json.at("time_unit"), "ns");
  EXPECT_EQ(json.at("real_time"), 12.5);
  EXPECT_EQ(json.at("cpu_time"), 12.0);
  EXPECT_EQ(json.at("gamma_F_deg"), 3.0);
  EXPECT_EQ(row_fields_of(json.at("sixdof")).question, "respond");
  EXPECT_FALSE(json.contains("error_occurred"));
}

TEST(StudyRows, WithoutAResultSayWhy) {
  StudyRow failed = row();
  failed.error = "no memory";
  const auto json = to_json_object(failed);
  EXPECT_EQ(json.at("error_occurred"), true);
  EXPECT_EQ(json.at("error_message"), "no memory");
  EXPECT_FALSE(json.contains("real_time"));
}

TEST(StudyRows, RefuseCountersThatAreUnknownOrNotFinite) {
  StudyRow bad = row();
  bad.counters = {{"no_such_metric", 1.0}};
  EXPECT_THAT([&] { to_json_object(bad); }, ThrowsMessage<Error>(HasSubstr("no_such_metric is not in the table")));
  bad.counters = {{"gamma_F_deg", std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_THAT([&] { to_json_object(bad); }, ThrowsMessage<Error>(HasSubstr("gamma_F_deg is not finite")));
}

}  // namespace
}  // namespace sixdof::study
