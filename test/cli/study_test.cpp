// sixdof precision and recommend, as a user types them.

#include <filesystem>
#include <fstream>
#include <map>
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
using ::testing::EndsWith;
using ::testing::HasSubstr;

class Studies : public test::ScratchFolder {
 protected:
  test::ProgramResult run(const std::string& arguments) const {
    return test::run_program("SIXDOF_CACHE=" + path("cache") + " " + std::string(SIXDOF_PROGRAM) + " " + arguments);
  }
  const std::string quick = "precision --a cone-1k --b torus-1k --sample 16 --budget 60s ";
};

std::map<std::string, json> rows_of(const json& document) {
  std::map<std::string, json> rows;
  for (const json& row : document.at("benchmarks")) rows[row.at("name")] = row;
  return rows;
}

TEST_F(Studies, PrecisionMeasuresEveryPointAndWritesRows) {
  const auto done = run(quick + "--algorithms vps,exact --params vps:voxel_size=0.04,0.02 -o " + path("rows.json"));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("gamma_F_deg"));
  EXPECT_THAT(done.out, HasSubstr("voxel_size=0.02"));
  std::ifstream file(path("rows.json"));
  const json document = json::parse(file);
  EXPECT_FALSE(document.at("context").contains("interrupted"));
  EXPECT_TRUE(document.at("context").contains("mesh:cone-1k"));
  const auto rows = rows_of(document);
  ASSERT_EQ(rows.size(), 3u);
  const std::string pair = "/pair:cone-1k-torus-1k";
  const json& exact = rows.at("precision/respond/algorithm:exact" + pair);
  const json& coarse = rows.at("precision/respond/algorithm:vps" + pair + "/voxel_size:0.04");
  EXPECT_LT(exact.at("gamma_max_F_deg"), 1e-9);
  EXPECT_GT(coarse.at("gamma_F_deg"), 0.1);
  EXPECT_GT(coarse.at("cpu_time"), 0.0);
  EXPECT_EQ(exact.at("on_frontier"), 1.0);
  EXPECT_EQ(coarse.at("sixdof").at("settings").at("voxel_size"), 0.04);
  EXPECT_EQ(coarse.at("sixdof").at("question"), "respond");
  EXPECT_EQ(coarse.at("failed"), 0.0);
}

TEST_F(Studies, PrecisionTwiceHasTheSameErrors) {
  const std::string command =
      quick + "--algorithms vps,ist,exact --params vps:voxel_size=0.03 --params ist:spheres=200 --json";
  const auto first = run(command), second = run(command);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const auto before = rows_of(json::parse(first.out)), after = rows_of(json::parse(second.out));
  ASSERT_EQ(before.size(), 3u);
  for (const auto& [name, row] : before) {
    for (const char* const metric : {"gamma_F_deg", "gamma_F_p95_deg", "magnitude_error_F", "gain_F", "misses"}) {
      EXPECT_EQ(row.at(metric), after.at(name).at(metric)) << name << " " << metric;
    }
  }
}

TEST_F(Studies, PrecisionSaysWhatABudgetLeavesOut) {
  const auto done = run("precision --a cone-1k --b torus-1k --sample 16 --budget 1ms --algorithms vps --json");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const auto rows = rows_of(json::parse(done.out));
  ASSERT_EQ(rows.size(), 5u);
  for (const auto& [name, row] : rows) {
    const bool coarsest = name.find("voxel_size:0.032") != std::string::npos;
    if (coarsest) continue;
    EXPECT_THAT(row.at("error_message").get<std::string>(), HasSubstr("budget")) << name;
  }
}

TEST_F(Studies, PrecisionTellsHowMuchThereIsHowFarItIsAndWhatIsLeftOut) {
  const auto done = run(quick + "--algorithms vps,exact --params vps:voxel_size=0.04,0.02");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.err, HasSubstr("sixdof precision: pairs: 1, algorithms: 2, points of each pair: 3, poses: 16 at "
                                  "most\nsixdof precision: about "));
  EXPECT_THAT(done.err, HasSubstr(" in all, the budget is 1 min\n"));
  EXPECT_THAT(done.err,
              ::testing::ContainsRegex("precision: cone-1k-torus-1k: 3 of 3 points: [0-9]+ % done, [0-9:]+ left\n"));
  EXPECT_THAT(done.err, HasSubstr("precision: cone-1k-torus-1k: round 5 of timing: 100 % done, 0:00:00 left\n"));
  EXPECT_THAT(done.err, HasSubstr("sixdof precision: nothing was left out\n"));
  const auto cut = run("precision --a cone-1k --b torus-1k --sample 16 --budget 1ms --algorithms vps");
  EXPECT_THAT(cut.err, ::testing::ContainsRegex("sixdof precision: left out: cone-1k-torus-1k: vps voxel_size=[0-9.]+ "
                                                "point_spacing=[0-9.]+: [^\n]*budget"));
}

TEST_F(Studies, PrecisionOfDistancesAndCollisions) {
  const auto distance = run(quick + "--question distance --algorithms exact,ist --params ist:spheres=200 --json");
  ASSERT_EQ(distance.exit_code, 0) << distance.err;
  const auto rows = rows_of(json::parse(distance.out));
  const std::string pair = "/pair:cone-1k-torus-1k";
  EXPECT_EQ(rows.at("precision/distance/algorithm:exact" + pair).at("too_large"), 0.0);
  EXPECT_GT(rows.at("precision/distance/algorithm:ist" + pair + "/spheres:200").at("error_mean"), 1e-6)
      << "spheres inside are farther apart than the surfaces";
  const auto collide = run(quick + "--question collide --algorithms exact --json");
  ASSERT_EQ(collide.exit_code, 0) << collide.err;
  EXPECT_EQ(rows_of(json::parse(collide.out)).begin()->second.at("mismatch"), 0.0);
}

TEST_F(Studies, RecommendAnswersEveryQuestion) {
  const auto done =
      run("recommend --a cone-1k --b torus-1k --deadline 1s --budget 90s --algorithms exact,vps --params "
          "vps:voxel_size=0.04 --json");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const json questions = json::parse(done.out).at("questions");
  ASSERT_EQ(questions.size(), 4u);
  std::map<std::string, std::size_t> candidates;
  for (const json& question : questions) candidates[question.at("question")] = question.at("candidates").size();
  EXPECT_EQ(candidates,
            (std::map<std::string, std::size_t>{{"yes-no", 2}, {"distance", 1}, {"respond", 2}, {"cast", 1}}))
      << "vps has no distances, and no casts";
}

TEST_F(Studies, RecommendNamesAnAlgorithmAndTheCommandThatMeasuresItAgain) {
  const auto done = run("recommend --a cone-1k --b torus-1k --deadline 1s --budget 90s --algorithms exact --json");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const json questions = json::parse(done.out).at("questions");
  ASSERT_EQ(questions.size(), 4u);
  for (const json& question : questions) {
    EXPECT_TRUE(question.at("missing").is_null()) << question;
    EXPECT_EQ(question.at("candidates").at(0).at("standing"), "taken");
    EXPECT_EQ(question.at("candidates").at(0).at("algorithm"), "exact");
    EXPECT_THAT(question.at("again").get<std::string>(), HasSubstr("sixdof-bench --a cone-1k --b torus-1k"));
  }
  const auto none = run("recommend --a cone-1k --b torus-1k --deadline 1ns --budget 90s --algorithms exact");
  EXPECT_EQ(none.exit_code, k_exit_defects) << none.err;
  EXPECT_THAT(none.out, HasSubstr("yes-no      none: no algorithm keeps the deadline with safe answers"));
}

TEST_F(Studies, RecommendTriesWarmStartsInMotion) {
  const std::string arguments =
      "recommend --a cone-1k --b torus-1k --question respond --order motion --deadline 1s --budget 60s --algorithms "
      "exact -o " +
      path("r.json");
  const auto done = run(arguments);
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, ::testing::ContainsRegex("respond     take exact warm_start=o[nf]+: the exact force"));
  EXPECT_THAT(done.out, ::testing::ContainsRegex("-p exact:warm_start=o[nf]+ .*/order:motion\\$'"));
  std::ifstream file(path("r.json"));
  const json rows = json::parse(file).at("benchmarks");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_THAT(rows[0].at("name").get<std::string>(), EndsWith("/warm_start:on/order:motion"));
  EXPECT_THAT(rows[1].at("name").get<std::string>(), EndsWith("/warm_start:off/order:motion"));
}

TEST_F(Studies, RecommendTriesAsManyThreadsAsAllowed) {
  const auto done =
      run("recommend --a cone-1k --b torus-1k --question respond --deadline 1s --budget 60s --algorithms exact "
          "--threads 2 -o " +
          path("r.json"));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, ::testing::ContainsRegex("respond     take exact threads=[12]: "));
  std::ifstream file(path("r.json"));
  const json rows = json::parse(file).at("benchmarks");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_THAT(rows[0].at("name").get<std::string>(), EndsWith("/threads:2"));
  EXPECT_THAT(rows[1].at("name").get<std::string>(), EndsWith("/threads:1"));
  EXPECT_EQ(rows[0].at("gamma_F_deg"), rows[1].at("gamma_F_deg"));
}

TEST_F(Studies, RefuseBadArguments) {
  const std::map<std::string, std::string> cases{
      {"precision", "--pair, --set or --a is needed"},
      {"precision --pair nothing", "pair nothing: no such pair; there are elephant"},
      {"precision --a cone-1k --algorithms nothing", "nothing"},
      {"precision --a cone-1k --algorithms fcl-rss", "fcl-rss does not answer respond"},
      {"precision --a cone-1k --question push", "--question push: must be collide, distance or respond"},
      {"precision --a cone-1k --metric beauty", "--metric beauty: must be one of gamma_F_deg, "},
      {"precision --a cone-1k --metric error_rms", "--metric error_rms: must be one of gamma_F_deg, "},
      {"precision --a cone-1k --cost beauty", "--cost beauty: must be one of cpu_time, "},
      {"recommend --a cone-1k --metric sigma_F", "--metric sigma_F: must be one of gamma_F_deg, "},
      {"precision --a cone-1k --budget 10", "--budget 10: must be a positive time with its unit"},
      {"precision --a cone-1k --params vps:voxel_size=7", "voxel_size=7: must be a number from"},
      {"precision --a cone-1k --algorithms exact --params vps:voxel_size=0.1", "vps is not among the algorithms"},
      {"recommend --a cone-1k --deadline 0ms", "--deadline 0ms"},
      {"recommend --pair elephant,bunny", "one pair at a time"},
      {"recommend --a cone-1k --threads 0", "--threads"},
      {"recommend --a cone-1k --threads 65", "--threads"},
      {"recommend --a cone-1k --order path", "--order: path not in {random,motion}"},
  };
  for (const auto& [arguments, words] : cases) {
    const auto done = run(arguments);
    EXPECT_NE(done.exit_code, 0) << arguments;
    EXPECT_THAT(done.err, HasSubstr(words)) << arguments;
    EXPECT_EQ(done.out, "") << arguments;
  }
}

}  // namespace
}  // namespace sixdof
