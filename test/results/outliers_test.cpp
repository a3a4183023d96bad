#include <sixdof/results/outliers.h>

#include <array>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

#include "result_rows.h"

namespace sixdof::results {
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
  EXPECT_EQ(outliers.counter_of("max_ns"), "");
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
  const ComparedResponse& response = outliers.responses.at("gamma_max_F_deg");
  EXPECT_EQ(response.exact_force, (std::array{0.0, 1.0, 0.0}));
  EXPECT_EQ(response.exact_torque, (std::array{0.0, 0.0, 2.0}));
  EXPECT_EQ(response.reference, (std::array{7.0, 8.0, 9.0}));
  EXPECT_EQ(to_json_object(outliers), to_json_object(parse_outliers(to_json_object(outliers))));
}

TEST(Outliers, HaveContacts) {
  Json object = test::outliers("contact_normal_max_deg");
  object["contacts"]["contact_normal_max_deg"] = {{"contacts", {{1, 2, 3, 0, 0, 1}}},
                                                  {"curve", {{0, 0, 0, 1, 0, 0}, {1, 0, 0, 1, 1, 0}}}};
  const Outliers outliers = parse_outliers(object);
  const ContactPicture& picture = outliers.contacts.at("contact_normal_max_deg");
  EXPECT_EQ(picture.contacts.at(0), (std::array{1.0, 2.0, 3.0, 0.0, 0.0, 1.0}));
  EXPECT_EQ(picture.curve.size(), 2u);
  EXPECT_EQ(to_json_object(outliers), to_json_object(parse_outliers(to_json_object(outliers))));
  EXPECT_FALSE(to_json_object(parse_outliers(test::outliers("max_ns"))).contains("contacts"));
}

TEST(Outliers, ThatAreWrongAreRefused) {
  EXPECT_THAT(refusal(Json::array()), HasSubstr("outliers: "));
  for (const char* const pose : {"", "1 2 3", "0 0 0 1 0 0 nan", "0 0 0 1 0 0 0 5", "a b c d e f g"}) {
    EXPECT_THAT(refusal(test::outliers("max_ns", pose)), HasSubstr("outliers.poses.max_ns is no pose")) << pose;
  }
  Json object = test::outliers("max_ns");
  object["responses"]["max_ns"] = {{"force", {1, 2}}};
  EXPECT_THAT(refusal(object), HasSubstr("outliers: "));
}

TEST(Outliers, WithoutContentAreLeftOut) {
  Outliers outliers{.a = "left", .b = "right"};
  outliers.add("mismatch", std::nullopt);
  EXPECT_EQ(to_json_object(outliers), Json::parse(R"({"a": "left", "b": "right"})"));
  outliers.add("max_ns", Pose{.t = {0.1, 2.0, 3.0}});
  EXPECT_EQ(to_json_object(outliers).at("poses").at("max_ns"), "0.1 2 3 1 0 0 0");
}

TEST(TypedPose, IsInTheOrderOfTheCommandLine) {
  EXPECT_EQ(typed_pose("1 2 3 0.5 0.6 0.7 0.8"), (std::array{0.5, 0.6, 0.7, 0.8, 1.0, 2.0, 3.0}));
}

}  // namespace
}  // namespace sixdof::results
