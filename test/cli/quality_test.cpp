#include <unistd.h>

#include <filesystem>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/report/series.h>
#include "bench/common/run_guarded.h"

#include "run_program.h"

namespace sixdof {
namespace {

using ::testing::HasSubstr;

test::ProgramResult quality(const std::string& arguments) {
  return test::run_program(std::string(SIXDOF_PROGRAM) + " quality " + arguments);
}

TEST(Quality, PrintsMeasuresAsJson) {
  const auto result = quality("--scenario II --algorithm null --law volume --steps 20 --shape facets=16 --json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("scenario"), "II");
  EXPECT_EQ(json.at("algorithm"), "null");
  EXPECT_EQ(json.at("law"), "volume");
  EXPECT_THAT(json.at("shape").get<std::string>(), HasSubstr("facets=16"));
  EXPECT_EQ(json.at("steps"), 20);
  EXPECT_EQ(json.at("measures").at("misses"), 20.0);  // the force of null is zero
  EXPECT_GT(json.at("measures").at("p50_ns"), 0.0);
  EXPECT_FALSE(json.at("measures").contains("p99_ns")) << "of 20 steps";
}

TEST(Quality, PrintsATableAndWritesTheSeries) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("sixdof_quality_test" + std::to_string(::getpid()) + ".h5");
  const auto result =
      quality("--scenario Ia --algorithm null --law depth --steps 70 --shape facets=8 -o " + path.string());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("misses"));
  EXPECT_THAT(result.out, HasSubstr("tunnelling"));
  EXPECT_TRUE(std::filesystem::remove(path));
}

/// Measures but those of times.
std::map<std::string, nlohmann::json> measures_of_answers(const std::string& out) {
  std::map<std::string, nlohmann::json> measures;
  const nlohmann::json json = nlohmann::json::parse(out);
  for (const auto& [name, value] : json.at("measures").items()) {
    if (!name.ends_with("_ns") && !name.starts_with("over_")) measures[name] = value;
  }
  return measures;
}

TEST(Quality, StoresTheCommandThatRecordsTheSeriesAgain) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("sixdof_quality_again" + std::to_string(::getpid()) + ".h5");
  const std::string arguments =
      "--scenario II --algorithm vps -p voxel_size=0.1 -p point_spacing=0.1 --shape facets=16 --steps 40 --law own";
  const auto recorded = quality(arguments + " --json -o " + path.string());
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  const std::string command = report::read_series(path).command;
  std::filesystem::remove(path);
  EXPECT_EQ(command, "sixdof quality " + arguments);
  const std::string programs = std::filesystem::path(SIXDOF_PROGRAM).parent_path().string();
  const auto again = test::run_program("export PATH=" + programs + ":$PATH; " + command + " --json");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_FALSE(measures_of_answers(recorded.out).empty());
  EXPECT_EQ(measures_of_answers(recorded.out), measures_of_answers(again.out));
}

/// Along a path `ist` has a resolution of its own, unless the user sets one.
TEST(Quality, TakesTheResolutionThatIsSet) {
  const auto result = quality("--scenario II --algorithm ist -p spheres=100 --steps 20 --json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto settings = nlohmann::json::parse(result.out).at("settings").get<std::string>();
  EXPECT_THAT(settings, HasSubstr("spheres=100,spheres_b=0,"));
}

TEST(Quality, RefusesBadArgumentsAndNamesThem) {
  EXPECT_EQ(quality("--algorithm null").exit_code, k_exit_usage);
  for (const auto& [arguments, words] :
       {std::pair("--scenario V --algorithm null", "no scenario"), std::pair("--scenario II", "--algorithm is needed"),
        std::pair("--scenario II --algorithm null --law own", "declares no law"),
        std::pair("--scenario II --algorithm null --law hooke", "hooke"),
        std::pair("--scenario II --algorithm null --law volume --steps 1", "too few"),
        std::pair("--scenario II --algorithm null --shape side=3", "side")}) {
    const auto result = quality(arguments);
    EXPECT_EQ(result.exit_code, k_exit_error) << arguments;
    EXPECT_THAT(result.err, HasSubstr(words)) << arguments;
  }
}

}  // namespace
}  // namespace sixdof
