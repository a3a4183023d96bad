#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include "bench/cli/commands.h"

#include "run_program.h"

namespace sixdof {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

test::ProgramResult sixdof_program(const std::string& arguments) {
  return test::run_program(std::string(SIXDOF_PROGRAM) + " " + arguments);
}

TEST(Program, SaysItsVersionAndHelp) {
  const auto version = sixdof_program("--version");
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, StartsWith("sixdof "));
  const auto help = sixdof_program("--help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("algorithms"));
}

TEST(Program, RefusesWhatItDoesNotUnderstand) {
  for (const char* bad : {"", "no-such-command", "algorithms --no-such-flag"}) {
    const auto result = sixdof_program(bad);
    EXPECT_EQ(result.exit_code, cli::k_exit_usage) << bad;
    EXPECT_EQ(result.out, "") << bad;
    EXPECT_NE(result.err, "") << bad;
  }
}

TEST(Program, ReportsOutputThatCannotBeWritten) {
  const auto result = sixdof_program("algorithms --json > /dev/full");
  EXPECT_EQ(result.exit_code, cli::k_exit_error);
  EXPECT_THAT(result.err, StartsWith("sixdof: standard output"));
}

TEST(Program, TurnsExceptionsIntoOneLineAndAnExitCode) {
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(cli::run_guarded("sixdof", [] { throw BadFile("hull.off", "face 7", "vertex index 12 of 9"); }),
            cli::k_exit_error);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "sixdof: hull.off: face 7: vertex index 12 of 9\n");
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(cli::run_guarded("sixdof", [] { throw Interrupted("interrupted"); }), cli::k_exit_interrupted);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "sixdof: interrupted\n");
}

TEST(Algorithms, ListsAnswersAndParameters) {
  const auto result = sixdof_program("algorithms --json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto list = nlohmann::json::parse(result.out);
  ASSERT_GE(list.size(), 1u);
  EXPECT_EQ(list[0].at("name"), "null");
  EXPECT_EQ(list[0].at("answers"), (std::vector<std::string>{"collide", "distance", "respond"}));
  const auto text = sixdof_program("algorithms");
  for (const auto& algorithm : list) {
    EXPECT_FALSE(algorithm.at("version").get<std::string>().empty()) << algorithm;
    EXPECT_THAT(text.out, HasSubstr(algorithm.at("name").get<std::string>()));
    for (const auto& parameter : algorithm.at("parameters")) {
      EXPECT_TRUE(parameter.contains("default") && parameter.contains("unit") &&
                  (parameter.contains("low") || parameter.contains("choices")))
          << parameter;
    }
  }
}

}  // namespace
}  // namespace sixdof
