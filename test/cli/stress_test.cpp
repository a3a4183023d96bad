// sixdof stress, as a user types it.

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/common/run_guarded.h"

#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

using nlohmann::json;
using ::testing::AnyOf;
using ::testing::HasSubstr;

class Stress : public test::ScratchFolder {
 protected:
  test::ProgramResult run(const std::string& arguments) const {
    return test::run_program("cd " + folder().string() + " && " + SIXDOF_PROGRAM + " " + arguments);
  }
  json cells(const std::string& arguments) const {
    const auto done = run("stress " + arguments + " -o " + path("cells.json"));
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return json::parse(std::ifstream(path("cells.json")));
  }
};

TEST_F(Stress, PrintsAMatrixAndWritesItsCells) {
  const json list = cells("--algorithms exact,brute-force --families kissing,scale,contained");
  ASSERT_EQ(list.size(), 6u);
  for (const json& cell : list) {
    for (const char* key : {"family", "algorithm", "verdict", "cases", "worst", "unit", "reproduction"}) {
      EXPECT_TRUE(cell.contains(key)) << key;
    }
    EXPECT_GE(cell.at("cases"), 5);
  }
  EXPECT_EQ(list[0].at("family"), "kissing");
  EXPECT_EQ(list[1].at("algorithm"), "brute-force");
  const auto done = run("stress --algorithms exact --families kissing,scale");
  EXPECT_THAT(done.out, HasSubstr("family"));
  EXPECT_THAT(done.out, HasSubstr(" 5 kissing"));
  EXPECT_THAT(done.out, HasSubstr(" 1 scale"));
}

TEST_F(Stress, EveryReproductionIsACommandThatAsksTheSameCase) {
  const json list = cells("--algorithms exact --families parallel,slivers,motion");
  for (const json& cell : list) {
    const std::string line = cell.at("reproduction");
    ASSERT_TRUE(line.starts_with("sixdof query ")) << line;
    const auto done = run(line.substr(std::string("sixdof ").size()) + " --json");
    ASSERT_EQ(done.exit_code, 0) << done.err << line;
    EXPECT_EQ(json::parse(done.out).at("status"), "ok");
  }
}

TEST_F(Stress, AsksForFirstContactsAndForContacts) {
  for (const json& cell : cells("--algorithms exact,exact-contacts --families moving,contacts")) {
    const bool is_of_casts = cell.at("algorithm") == "exact";
    if ((cell.at("family") == "moving") != is_of_casts) continue;
    EXPECT_THAT(cell.at("verdict").get<std::string>(), AnyOf("exact", "within declared resolution")) << cell;
  }
}

TEST_F(Stress, JudgesTheGeneratorsOfSets) {
  const json list = cells("--algorithms generate-distances,generate-volumes --families kissing,contained");
  ASSERT_EQ(list.size(), 4u);
  for (const json& cell : list) {
    EXPECT_THAT(cell.at("verdict"), ::testing::AnyOf("exact", "within declared resolution")) << cell;
    EXPECT_GE(cell.at("cases"), 5);
    const std::string line = cell.at("reproduction");
    ASSERT_TRUE(line.starts_with("sixdof generate ")) << line;
    const auto done = run(line.substr(std::string("sixdof ").size()));
    EXPECT_EQ(done.exit_code, 0) << done.err << line;
  }
}

TEST_F(Stress, IsDeterministicBySeedButForTimes) {
  const auto without_times = [&](const std::string& arguments) {
    json list = cells("--algorithms exact,brute-force --families motion,repeat,grazing " + arguments);
    for (json& cell : list) {
      cell.erase("slowest_s");
      cell.erase("slowest_reproduction");
    }
    return list;
  };
  const json one = without_times("--seed 3");
  EXPECT_EQ(one, without_times("--seed 3"));
  EXPECT_NE(one, without_times("--seed 4"));
}

/// An adapter that says that nothing touches, one line of Python a request.
constexpr const char* k_never = R"(import json, sys
for line in sys.stdin:
    do = json.loads(line)["do"]
    print(json.dumps({"protocol": 1, "name": "never", "version": "1", "answers": ["collide"]} if do == "hello" else
                     {"prepared": True} if do == "prepare" else {"collide": False, "ns": 1}), flush=True)
)";

TEST_F(Stress, AsksExternalProgramsAndFailsOnRequest) {
  std::ofstream(path("never.py")) << k_never;
  const std::string words = "stress --families contained --algorithms never --external 'never=python3 never.py'";
  const auto told = run(words);
  EXPECT_EQ(told.exit_code, 0) << told.err << "others' faults are told, not failed on";
  EXPECT_THAT(told.out, HasSubstr("never on contained: wrong"));
  EXPECT_THAT(told.out, HasSubstr(" --external 'never=python3 never.py'"));
  const auto gate = run(words + " --fail-on never");
  EXPECT_EQ(gate.exit_code, k_exit_defects);
  EXPECT_THAT(gate.err, ::testing::EndsWith("sixdof: these fail: never on contained\n"));
}

TEST_F(Stress, TellsHowManyCellsThereAreHowFarItIsAndWhatIsLeftOut) {
  const auto done = run("stress --algorithms exact,vps --families kissing,scale");
  EXPECT_THAT(done.err, HasSubstr("sixdof stress: families: 2, algorithms: 2, cells: 4, "));
  EXPECT_THAT(done.err, ::testing::ContainsRegex("\nsixdof stress: about .* in all\n"));
  EXPECT_THAT(done.err, HasSubstr("\nsixdof stress: 4 of 4 cells: 100 % done, 0:00:00 left\n"));
  EXPECT_THAT(done.err,
              HasSubstr("\nsixdof stress: left out: vps at defaults: takes hours; asked with --at-defaults\n"));
  EXPECT_THAT(run("stress --algorithms exact --families scale").err,
              HasSubstr("\nsixdof stress: nothing was left out\n"));
}

TEST_F(Stress, JudgesAlgorithmsAboutConvexHullsWhereBodiesAreConvex) {
  std::string about_hulls = k_never;
  const std::string answers = R"("answers": ["collide"])";
  about_hulls.insert(about_hulls.find(answers), R"("body": "convex_hull", )");
  std::ofstream(path("never.py")) << about_hulls;
  const json list =
      cells("--families thin-plate,holes --algorithms never --external 'never=python3 " + path("never.py") + "'");
  ASSERT_EQ(list.size(), 2u);
  for (const json& cell : list) {
    const bool is_convex = cell.at("family") == "thin-plate";
    EXPECT_EQ(cell.at("verdict"), is_convex ? "wrong" : "declared unsupported") << cell;
  }
}

TEST_F(Stress, RefusesWhatDoesNotExist) {
  const auto family = run("stress --families kissings");
  EXPECT_EQ(family.exit_code, k_exit_error);
  EXPECT_THAT(family.err, HasSubstr("kissings: no such family"));
  EXPECT_EQ(run("stress --algorithms exacts").exit_code, k_exit_error);
  const auto gate = run("stress --families kissing --algorithms exact --fail-on vps");
  EXPECT_EQ(gate.exit_code, k_exit_error) << "a gate that asks nothing would always be open";
  EXPECT_THAT(gate.err, HasSubstr("--fail-on vps: is not among the algorithms that are asked"));
  EXPECT_EQ(run("stress --effort great").exit_code, k_exit_usage);
}

}  // namespace
}  // namespace sixdof
