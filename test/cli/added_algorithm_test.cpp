// Every command knows an algorithm that a Registrar added (added_algorithm.cpp).

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/common/run_guarded.h"

#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

constexpr double k_tessellation = 0.05;  // of the boxes of tessellated spheres

using ::testing::AnyOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

constexpr const char* k_pair = " --a cone-1k --b torus-1k ";

class AddedAlgorithm : public test::ScratchFolder {
 protected:
  static test::ProgramResult run(const std::string& arguments) {
    return test::run_program(std::string(SIXDOF_ADDED_PROGRAM) + " " + arguments);
  }
  static Json answer(const std::string& arguments) {
    const auto result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << arguments << '\n' << result.err;
    return Json::parse(result.out);
  }
};

TEST_F(AddedAlgorithm, IsListedBehindTheOthers) {
  const Json list = answer("algorithms --json");
  EXPECT_EQ(list.at(0).at("name"), "null");
  EXPECT_EQ(list.back().at("name"), "balls");
  EXPECT_EQ(list.back().at("version"), "7.5 0123456789ab");
}

TEST_F(AddedAlgorithm, AnswersSingleQueries) {
  const Json json =
      answer("query --algorithm balls -p scale_b=0.5 --a sphere-500 --b sphere-500 --json --pose '3 0 0 1 0 0 0'");
  EXPECT_EQ(json.at("status"), "ok");
  EXPECT_NEAR(json.at("distance"), 3.0 - 1.5 * std::sqrt(3.0), k_tessellation);
}

TEST_F(AddedAlgorithm, IsInEveryStudy) {
  const Json precision = answer(std::string("precision") + k_pair +
                                "--question distance --algorithms exact,balls --sample 16 --budget 60s --json");
  EXPECT_EQ(precision.at("context").at("algorithm:balls"), "7.5 0123456789ab");
  int points = 0;
  for (const Json& row : precision.at("benchmarks")) points += row.at("sixdof").at("algorithm") == "balls" ? 1 : 0;
  EXPECT_EQ(points, 3);  // of its sweep
  // On a busy machine nothing may keep the deadline; the reason is said of each.
  const auto recommend = run(std::string("recommend") + k_pair +
                             "--metric error_rms --deadline 10ms --algorithms exact,balls --budget 20s");
  EXPECT_THAT(recommend.exit_code, AnyOf(0, k_exit_defects)) << recommend.err;
  EXPECT_THAT(recommend.out, HasSubstr("balls scale_a="));
  const auto equivalent = run("equivalent --scenario II --algorithm balls --tau 10us --steps 40");
  EXPECT_EQ(equivalent.exit_code, 0) << equivalent.err;
  EXPECT_THAT(equivalent.out, HasSubstr("balls"));
}

TEST_F(AddedAlgorithm, HasAQuality) {
  EXPECT_EQ(answer("quality --scenario II --algorithm balls --steps 40 --json").at("algorithm"), "balls");
}

TEST_F(AddedAlgorithm, HasNothingToShow) {
  const auto result = run("show --algorithm balls --model cone-1k -o " + path("x.ply"));
  EXPECT_EQ(result.exit_code, k_exit_error);
  EXPECT_EQ(result.err, "sixdof: --algorithm balls: has no structure to show\n");
}

}  // namespace
}  // namespace sixdof
