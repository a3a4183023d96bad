// --json of the commands that print objects: the same figures as the text, and valid UTF-8 whatever files are called.

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/configuration/configuration_set.h>
#include "bench/common/run_guarded.h"

#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class JsonOutput : public test::ScratchFolder {
 protected:
  test::ProgramResult run(const std::string& arguments) const {
    return test::run_program("SIXDOF_CACHE=off " + std::string(SIXDOF_PROGRAM) + " " + arguments);
  }
  json object(const std::string& arguments, int exit_code = 0) const {
    const auto result = run(arguments + " --json");
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    return json::parse(result.out);
  }
  std::string make_set(const std::string& name) const {
    const auto made = run("generate --a cone-1k --grid 90 --distances 0,10 --volumes 5 -o " + path(name));
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return path(name);
  }
};

constexpr const char* k_visible = R"(h\xFFll)";

TEST_F(JsonOutput, ShowsBytesOfNamesThatAreNoUtf8) {
  const std::string mesh = path("h\xFFll.off");
  ASSERT_EQ(run("models make cone --triangles 100 -o " + mesh).exit_code, 0);
  EXPECT_EQ(object("info " + mesh).at("name"), k_visible);
  EXPECT_EQ(object("query --a " + mesh + " --b " + mesh + " --pose '0.5 0 0 1 0 0 0'").at("colliding"), true);
  const std::string set = make_set("h\xFFll.h5");
  EXPECT_EQ(object("info " + set).at("file"), path("h\xEF\xBF\xBDll.h5"));
  EXPECT_EQ(object("verify --sample 2 " + set).at("file"), path("h\xEF\xBF\xBDll.h5"));
}

TEST_F(JsonOutput, OfVerifyHasWhatTheTextHas) {
  const std::string set = make_set("set.h5");
  const json verdict = object("verify --sample 7 --seed 3 " + set);
  EXPECT_EQ(verdict.at("a"), "cone-1k");
  EXPECT_EQ(verdict.at("b"), "cone-1k");
  EXPECT_EQ(verdict.at("grid"), "90");
  EXPECT_EQ(verdict.at("oracle").at("name"), "fcl-obbrss");
  EXPECT_EQ(verdict.at("seed"), 3);
  EXPECT_EQ(verdict.at("ok"), true);
  EXPECT_EQ(verdict.at("problems"), json::array());
  ASSERT_EQ(verdict.at("buckets").size(), 3u);
  EXPECT_EQ(verdict.at("buckets")[2].at("bucket"), "volume/05");
  for (const json& bucket : verdict.at("buckets")) {
    EXPECT_EQ(bucket.at("sampled"), 7);
    EXPECT_LE(bucket.at("largest_residual"), bucket.at("tolerance"));
    for (const char* count : {"wrong_value", "earlier_hit", "false_nan"}) EXPECT_EQ(bucket.at(count), 0) << count;
  }
}

TEST_F(JsonOutput, OfVerifyIsWholeWhereTheSetIsWrong) {
  const ConfigurationSet right(make_set("set.h5"));
  ConfigurationSetWriter writer(path("wrong.h5"), right.description());
  const BucketKey wrong{BucketKind::distance, 10};
  for (const BucketSummary& bucket : right.buckets()) {
    std::vector<double> translations = right.read(bucket.key);
    for (double& s : translations) s *= bucket.key == wrong ? 1.01 : 1.0;
    writer.write(bucket, translations);
  }
  writer.commit();
  const json verdict = object("verify --sample 5 " + path("wrong.h5"), k_exit_error);
  EXPECT_EQ(verdict.at("ok"), false);
  EXPECT_THAT(verdict.at("problems").at(0).get<std::string>(), HasSubstr(wrong.name()));
  EXPECT_EQ(verdict.at("buckets").at(1).at("wrong_value"), 5);
  EXPECT_GT(verdict.at("buckets").at(1).at("largest_residual"), verdict.at("buckets").at(1).at("tolerance"));
}

TEST_F(JsonOutput, OfAPlanHasCountsAndEstimate) {
  const json counts = object("generate --plan --grid paper --distances 0:30 --volumes 0:10");
  ASSERT_EQ(counts.at("kinds").size(), 2u);
  const auto text = run("generate --plan --grid paper --distances 0:30 --volumes 0:10").out;
  EXPECT_THAT(text, HasSubstr(counts.at("configurations").dump() + ", of which " + counts.at("computed").dump()));
  EXPECT_THAT(text, HasSubstr(counts.at("bytes").dump() + " before compression"));
  for (const json& kind : counts.at("kinds")) {
    EXPECT_THAT(text, HasSubstr(kind.at("kind").get<std::string>() + "s\n"));
    EXPECT_THAT(text, HasSubstr(kind.at("rotations").dump() + ", of which " + kind.at("distinct_rotations").dump()));
    EXPECT_THAT(text, HasSubstr(kind.at("configurations_per_bucket").dump() + " in each of " +
                                kind.at("buckets").dump() + " buckets"));
  }
  EXPECT_FALSE(counts.contains("estimate"));

  const json plan = object("generate --plan --plan-seconds 0.1 --a cone-1k --grid 45 --distances 5 --shards 4");
  const json& estimate = plan.at("estimate");
  EXPECT_EQ(estimate.at("kinds")[0].at("kind"), "distance");
  EXPECT_GT(estimate.at("kinds")[0].at("cpu_us_per_configuration"), 0.0);
  EXPECT_GT(estimate.at("kinds")[0].at("sampled").at("rays"), 0);
  EXPECT_EQ(estimate.at("shards"), 4);
  EXPECT_GE(estimate.at("time_s"), estimate.at("shard_time_s"));
  EXPECT_GT(estimate.at("process_bytes"), estimate.at("value_bytes"));
  EXPECT_THAT(run("generate --json --a cone-1k --grid 90 -o " + path("x.h5")).err, HasSubstr("--json is for --plan"));
}

}  // namespace
}  // namespace sixdof
