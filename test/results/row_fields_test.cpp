#include <sixdof/results/row_fields.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>

namespace sixdof::results {
namespace {

using Json = nlohmann::ordered_json;
using ::testing::HasSubstr;

const RowFields k_query{.query = "respond",
                        .algorithm = "vps",
                        .settings = "voxel_size=0.002,culling=off",
                        .pair = "elephant",
                        .bucket = BucketKey{BucketKind::volume, 5},
                        .order = "path",
                        .cache = "cold",
                        .configurations = 640};

TEST(RowFields, AreAnObjectWithNumbersAsNumbers) {
  EXPECT_EQ(to_json_object(k_query), Json::parse(R"({"query": "respond", "algorithm": "vps",
    "settings": {"voxel_size": 0.002, "culling": "off"}, "pair": "elephant", "order": "path", "cache": "cold",
    "bucket": {"kind": "volume", "percent": 5}, "configurations": 640})"));
  EXPECT_EQ(to_json_object({.query = "scenario", .algorithm = "exact", .scenario = "II"}),
            Json::parse(R"({"query": "scenario", "algorithm": "exact", "settings": {}, "scenario": "II"})"));
}

TEST(RowFields, SayThatTheAlgorithmIsIsolated) {
  EXPECT_EQ(to_json_object({.query = "collide", .algorithm = "ode", .isolated = true}).at("isolated"), true);
  EXPECT_FALSE(to_json_object({.query = "collide", .algorithm = "ode"}).contains("isolated"));
  EXPECT_TRUE(row_fields_of(to_json_object({.query = "collide", .algorithm = "ode", .isolated = true})).isolated);
  EXPECT_EQ(row_fields_of(to_json_object({.query = "collide", .algorithm = "ode", .sample_limit = 32})).sample_limit,
            32u);
}

TEST(RowFields, SayWhatExecutesARival) {
  const Json object = to_json_object({.query = "collide", .algorithm = "jolt", .runtime = "wasm"});
  EXPECT_EQ(object.at("runtime"), "wasm");
  EXPECT_EQ(row_fields_of(object).runtime, "wasm");
  EXPECT_FALSE(to_json_object(k_query).contains("runtime"));
}

TEST(RowFields, HavePartsOfAPercent) {
  const Json half = to_json_object({.query = "collide", .bucket = BucketKey{BucketKind::distance, 0.5}});
  EXPECT_EQ(half.at("bucket").dump(), R"({"kind":"distance","percent":0.5})");
  EXPECT_EQ(row_fields_of(half).bucket, (BucketKey{BucketKind::distance, 0.5}));
  EXPECT_EQ(to_json_object(k_query).at("bucket").dump(), R"({"kind":"volume","percent":5})");
}

TEST(RowFields, AreReadBack) {
  for (const RowFields& fields : {k_query, RowFields{.query = "collide", .algorithm = "ode", .isolated = true},
                                  RowFields{.query = "generate", .algorithm = "raycast", .target = "distance"}}) {
    EXPECT_EQ(to_json_object(row_fields_of(to_json_object(fields))), to_json_object(fields));
  }
  const RowFields read = row_fields_of(to_json_object(k_query));
  EXPECT_EQ(read.settings, k_query.settings);
  EXPECT_EQ(read.bucket, k_query.bucket);
  EXPECT_EQ(read.configurations, k_query.configurations);
}

TEST(RowFields, SayWhichObjectOrShapeAPairStandsFor) {
  const Json object = Json::parse(R"({"query": "respond", "algorithm": "vps", "settings": {}, "object": "bed",
    "partner": "tenth", "kind": "boxy", "shape": "knot", "triangles": 4000, "volume_unit": 0.001})");
  EXPECT_EQ(to_json_object(row_fields_of(object)), object);
}

TEST(RowFields, ThatAreWrongAreNamed) {
  const auto message_of = [](const char* key, const Json& value) {
    Json object = to_json_object(k_query);
    object[key] = value;
    try {
      row_fields_of(object);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(message_of("query", 7), HasSubstr("sixdof.query: "));
  EXPECT_THAT(message_of("settings", nullptr), HasSubstr("sixdof.settings: not an object"));
  EXPECT_THAT(message_of("bucket", {{"kind", "depth"}, {"percent", 5}}), HasSubstr("sixdof.bucket: "));
  EXPECT_THAT(message_of("bucket", {{"kind", "volume"}, {"percent", 101}}), HasSubstr("sixdof.bucket: "));
  EXPECT_THAT(message_of("bucket", {{"kind", "volume"}, {"percent", 0.00001}}), HasSubstr("sixdof.bucket: "));
  EXPECT_THAT(message_of("configurations", "many"), HasSubstr("sixdof.configurations: "));
  EXPECT_THAT(message_of("configurations", -1), HasSubstr("sixdof.configurations: not a whole number"));
  EXPECT_THAT(message_of("sample_limit", 1.55e164), HasSubstr("sixdof.sample_limit: not a whole number"));
  EXPECT_THAT(message_of("triangles", -1), HasSubstr("sixdof.triangles: not a whole number"));
  EXPECT_THAT(message_of("volume_unit", 0), HasSubstr("sixdof.volume_unit: not above zero"));
  EXPECT_THROW(row_fields_of(Json::parse("[]")), Error);
}

}  // namespace
}  // namespace sixdof::results
