#include <sixdof/report/outlier.h>

#include <array>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

#include "result_text.h"

namespace sixdof::report {
namespace {

using test::Json;
using ::testing::HasSubstr;

std::string refusal(const Json& object) {
  try {
    parse_outliers(object);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(Outliers, OfAMeanIsThatOfTheLargest) {
  const Outliers outliers = parse_outliers(test::outliers("gamma_max_F_deg"));
  EXPECT_EQ(outliers.command_of("gamma_F_deg"),
            "sixdof query --a torus-1k --b torus-1k --algorithm exact --pose \"0.5 0 0 1 0 0 0\"");
  EXPECT_EQ(outliers.command_of("gamma_max_F_deg"), outliers.command_of("gamma_F_deg"));
  EXPECT_EQ(outliers.command_of("max_ns"), "");
  EXPECT_EQ(outliers.of_value("max_ns"), nullptr);
}

TEST(Outliers, WithoutACommandAreAskedByNone) {
  Json object = test::outliers("max_ns");
  object.erase("command");
  EXPECT_EQ(parse_outliers(object).command_of("max_ns"), "");
}

TEST(Outliers, HaveResponses) {
  Json object = test::outliers("gamma_max_F_deg");
  object["responses"]["gamma_max_F_deg"] = {{"force", {1, 0, 0}},
                                            {"torque", {0, 0, 0}},
                                            {"exact_force", {0, 1, 0}},
                                            {"exact_torque", {0, 0, 2}},
                                            {"reference", {7, 8, 9}}};
  const Outliers outliers = parse_outliers(object);
  const auto& response = outliers.by_counter.at("gamma_max_F_deg").response;
  ASSERT_TRUE(response);
  EXPECT_EQ(response->exact_force, (std::array{0.0, 1.0, 0.0}));
  EXPECT_EQ(response->exact_torque, (std::array{0.0, 0.0, 2.0}));
  EXPECT_EQ(response->reference, (std::array{7.0, 8.0, 9.0}));
}

TEST(Outliers, ThatAreWrongAreRefused) {
  EXPECT_THAT(refusal(Json::array()), HasSubstr("no object"));
  for (const char* const pose : {"", "1 2 3", "0 0 0 1 0 0 nan", "0 0 0 1 0 0 0 5", "a b c d e f g"}) {
    EXPECT_THAT(refusal(test::outliers("max_ns", pose)), HasSubstr("outliers.poses.max_ns is no pose")) << pose;
  }
  Json object = test::outliers("max_ns");
  object["responses"]["max_ns"] = {{"force", {1, 2}}};
  EXPECT_THAT(refusal(object), HasSubstr("force is no vector"));
}

TEST(TypedPose, IsInTheOrderOfTheCommandLine) {
  EXPECT_EQ(typed_pose("1 2 3 0.5 0.6 0.7 0.8"), (std::array{0.5, 0.6, 0.7, 0.8, 1.0, 2.0, 3.0}));
}

}  // namespace
}  // namespace sixdof::report
