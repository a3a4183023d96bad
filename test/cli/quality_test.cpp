#include <unistd.h>

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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
