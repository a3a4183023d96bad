#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include "bench/common/run_guarded.h"

#include "run_program.h"

namespace sixdof {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

test::ProgramResult sixdof_program(const std::string& arguments) {
  return test::run_program(std::string(SIXDOF_PROGRAM) + " " + arguments);
}

TEST(Program, PrintsItsVersionAndHelp) {
  const auto version = sixdof_program("--version");
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, StartsWith("sixdof "));
  const auto help = sixdof_program("--help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("algorithms"));
}

TEST(Program, RefusesWhatItDoesNotUnderstand) {
  for (const char* bad : {"", "no-such-command", "algorithms --no-such-flag", "models", "query --a"}) {
    const auto result = sixdof_program(bad);
    EXPECT_EQ(result.exit_code, k_exit_usage) << bad;
    EXPECT_EQ(result.out, "") << bad;
    EXPECT_NE(result.err, "") << bad;
  }
}

TEST(Program, SaysWhatToDoFirst) {
  EXPECT_THAT(sixdof_program("").err, AllOf(HasSubstr("no command"), HasSubstr("sixdof models list"),
                                            HasSubstr("sixdof query --a cone-1k"), HasSubstr("sixdof --help")));
}

TEST(Program, NamesTheUnknownWordAndTheNearestKnownOne) {
  for (const auto& [arguments, message] :
       {std::pair("infoo x", "sixdof: infoo: no such command; did you mean info?\n"),
        std::pair("models lsit", "sixdof models: lsit: no such command; did you mean list?\n"),
        std::pair("generate --grd 45", "sixdof generate: --grd: no such option; did you mean --grid?\n"),
        std::pair("generate --grd=45", "sixdof generate: --grd: no such option; did you mean --grid?\n"),
        std::pair("query --jsn --a box-12", "sixdof query: --jsn: no such option; did you mean --json?\n"),
        std::pair("query --pse=1", "sixdof query: --pse: no such option; did you mean --pose?\n"),
        std::pair("frobnicate", "sixdof: frobnicate: no such command (sixdof --help lists them)\n"),
        std::pair("help", "sixdof: help: no such command; did you mean sixdof --help?\n"),
        std::pair("scene help", "sixdof scene: help: no such command; did you mean sixdof scene --help?\n"),
        std::pair("hull.stl",
                  "sixdof: hull.stl: no such command (sixdof --help lists them); sixdof info hull.stl says "
                  "what is in a file\n"),
        std::pair(
            "info cone-1k --grid 45",
            "sixdof info: --grid: sixdof info has no such option; it is one of sixdof generate, sixdof equivalent "
            "(sixdof info --help)\n"),
        std::pair("models --deadline=1ms",
                  "sixdof models: --deadline: sixdof models has no such option; it is one of sixdof recommend (sixdof "
                  "models --help)\n"),
        std::pair("info --frobnicate", "sixdof info: --frobnicate: no such option (sixdof info --help lists them)\n"),
        std::pair("info a b", "sixdof info: b: unexpected argument (sixdof info --help)\n"),
        std::pair("query --b box-12 --pose 0", "sixdof query: --a is required (sixdof query --help)\n")}) {
    const auto result = sixdof_program(arguments);
    EXPECT_EQ(result.exit_code, k_exit_usage) << arguments;
    EXPECT_EQ(result.err, message);
    EXPECT_EQ(result.out, "");
  }
}

TEST(Program, ReportsOutputThatCannotBeWritten) {
  const auto result = sixdof_program("algorithms --json > /dev/full");
  EXPECT_EQ(result.exit_code, k_exit_error);
  EXPECT_THAT(result.err, StartsWith("sixdof: standard output"));
}

TEST(Program, TurnsExceptionsIntoOneLineAndAnExitCode) {
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(run_guarded("sixdof", [] { throw BadFile("hull.off", "face 7", "vertex index 12 of 9"); }), k_exit_error);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "sixdof: hull.off: face 7: vertex index 12 of 9\n");
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(run_guarded("sixdof", [] { throw Interrupted("interrupted"); }), k_exit_interrupted);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "sixdof: interrupted\n");
}

TEST(Algorithms, ListsAnswersAndParameters) {
  const auto result = sixdof_program("algorithms --json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto list = nlohmann::json::parse(result.out);
  ASSERT_GE(list.size(), 1u);
  EXPECT_EQ(list[0].at("name"), "null");
  EXPECT_EQ(list[0].at("answers"), (std::vector<std::string>{"collide", "distance", "respond", "cast", "contacts"}));
  const auto timed = [&](const std::string& name) {
    for (const auto& algorithm : list) {
      if (algorithm.at("name") == name) return algorithm.at("timed").get<bool>();
    }
    ADD_FAILURE() << name << " is missing";
    return true;
  };
  EXPECT_TRUE(timed("exact"));
  EXPECT_FALSE(timed("brute-force"));
  const auto text = sixdof_program("algorithms");
  EXPECT_THAT(text.out, HasSubstr("(not timed)\n"));
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
