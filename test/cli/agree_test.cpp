// `sixdof agree`: `null`, which always says no and 0, differs from the truth in known places.

#include <algorithm>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/common/run_guarded.h"

#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

constexpr double k_printed_digits = 1e-8;  // of the printed distance
constexpr double k_bracket = 1e-7;         // the longest bracket of a motion of 0.01 % of the diagonal

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

class Agree : public test::ScratchFolder {
 protected:
  void SetUp() override {
    test::ScratchFolder::SetUp();
    const auto made = program("generate --a torus-300 --b cone-100 --grid 90 --distances 0,5 --volumes 5 -o " + set());
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  static test::ProgramResult program(const std::string& arguments) {
    return test::run_program(std::string(SIXDOF_PROGRAM) + " " + arguments);
  }
  std::string set() const { return path("set.h5"); }
  test::ProgramResult agree(const std::string& arguments) const {
    return program("agree --set " + set() + " " + arguments);
  }
};

TEST_F(Agree, FindsNoDifferenceBetweenExactAlgorithms) {
  const auto result = agree("--algorithms exact,brute-force --sample 20 --json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto pair = nlohmann::json::parse(result.out).at("pairs").at(0);
  EXPECT_TRUE(pair.at("differences").empty());
  ASSERT_EQ(pair.at("buckets").size(), 3u);
  for (const auto& bucket : pair.at("buckets")) {
    EXPECT_EQ(bucket.at("split"), 0);
    EXPECT_EQ(bucket.at("configurations"), 20);
    for (const auto& counts : bucket.at("algorithms")) {
      EXPECT_EQ(counts.at("yes"), bucket.at("bucket") == "volume/05" ? 20 : 0);
      EXPECT_EQ(counts.at("judged_collide"), bucket.at("bucket") == "distance/00" ? 0 : 20);
      EXPECT_EQ(counts.at("judged_distance"), 20);
      EXPECT_LT(counts.at("largest_distance_error"), 1e-9);
    }
  }
}

TEST_F(Agree, ListsEachDifferenceWithACommandThatAsksTheSame) {
  const auto result = agree("--algorithms exact,null --sample 7 --json");
  EXPECT_EQ(result.exit_code, k_exit_defects);
  EXPECT_THAT(result.err, EndsWith("sixdof: 14 answers differ from the sets' truth\n"));
  const auto pair = nlohmann::json::parse(result.out).at("pairs").at(0);
  // No instead of yes at the volume, where distance 0 is right; 0 instead of the distance at 5 %, where no is right.
  // At 0 % a distance of 0 is off by less than the tolerance.
  ASSERT_EQ(pair.at("differences").size(), 14u);
  for (const auto& difference : pair.at("differences")) {
    const bool overlap = difference.at("bucket") == "volume/05";
    EXPECT_EQ(difference.at("algorithm"), "null");
    EXPECT_EQ(difference.at("question"), overlap ? "collide" : "distance");
    EXPECT_EQ(difference.at("answer"), overlap ? "no" : "0");
  }
  for (const std::size_t i : {std::size_t{0}, std::size_t{13}}) {
    const auto& difference = pair.at("differences").at(i);
    std::string command = difference.at("command");
    ASSERT_EQ(command.find("sixdof query --a torus-300 --b cone-100 --algorithm null --pose '"), 0u) << command;
    command = command.substr(std::string("sixdof ").size());
    const auto at_null = nlohmann::json::parse(program(command + " --json").out);
    EXPECT_EQ(at_null.at("colliding"), false);
    EXPECT_EQ(at_null.at("distance"), 0.0);
    const std::size_t name = command.rfind("null");
    const auto truth = nlohmann::json::parse(program(command.replace(name, 4, "exact") + " --json").out);
    if (difference.at("question") == "collide") {
      EXPECT_EQ(truth.at("colliding"), true);
    } else {
      EXPECT_NEAR(truth.at("distance"), std::stod(difference.at("truth").get<std::string>()), k_printed_digits);
    }
  }
}

TEST_F(Agree, PrintsTotalsAndTheFirstDifferences) {
  const auto result = agree("--algorithms null,exact --sample 7 --show 2");
  EXPECT_EQ(result.exit_code, k_exit_defects);
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("21 configurations in 3 buckets"), HasSubstr("null volume/05 collide: 7 differ"),
                    HasSubstr("no instead of yes: sixdof query --a torus-300")));
  EXPECT_THAT(result.out, Not(HasSubstr("exact volume/05")));
  const std::string word = "instead of";
  std::size_t lines = 0;
  for (std::size_t at = 0; (at = result.out.find(word, at)) != std::string::npos; at += word.size()) ++lines;
  EXPECT_EQ(lines, 4u);
}

TEST_F(Agree, TellsHowMuchThereIsHowFarItIsAndWhatIsLeftOut) {
  const auto named = agree("--algorithms exact,brute-force --sample 5");
  EXPECT_EQ(named.exit_code, 0) << named.err;
  EXPECT_THAT(named.err, HasSubstr("sixdof agree: pairs: 1, buckets: 3, algorithms: 2; a step is one algorithm at 5 "
                                   "poses of a bucket: 6 steps\n"));
  EXPECT_THAT(named.err, ::testing::ContainsRegex("sixdof agree: about .* in all\n"));
  EXPECT_THAT(named.err, HasSubstr("sixdof agree: 6 of 6 steps: 100 % done, 0:00:00 left\n"));
  EXPECT_THAT(named.err, HasSubstr("sixdof agree: nothing was left out\n"));
  const auto all = agree("--sample 2");
  EXPECT_THAT(all.err, HasSubstr("sixdof agree: left out: null: answers with constants\n"));
  EXPECT_THAT(all.err, HasSubstr("sixdof agree: left out: brute-force: too slow for all; asked where it is named\n"));
}

/// An adapter about convex hulls that says that nothing touches, one line of Python a request.
constexpr const char* k_never = R"(import json, sys
for line in sys.stdin:
    do = json.loads(line)["do"]
    print(json.dumps({"protocol": 1, "name": "never", "version": "1", "answers": ["collide"], "body": "convex_hull"}
                     if do == "hello" else {"prepared": True} if do == "prepare" else {"collide": False, "ns": 1}),
          flush=True)
)";

TEST_F(Agree, JudgesAnswersAboutConvexHulls) {
  std::ofstream(path("never.py")) << k_never;
  const std::string external = " --external 'never=python3 " + path("never.py") + "'";
  const auto wrong = agree("--algorithms never,exact --sample 20 --json" + external);
  EXPECT_EQ(wrong.exit_code, k_exit_defects) << wrong.err;
  const auto pair = nlohmann::json::parse(wrong.out).at("pairs").at(0);
  for (const auto& difference : pair.at("differences")) {
    EXPECT_EQ(difference.at("algorithm"), "never");
    EXPECT_EQ(difference.at("answer"), "no");
    EXPECT_EQ(difference.at("truth"), "yes");
  }
  for (const auto& bucket : pair.at("buckets")) {
    const auto& counts = bucket.at("algorithms").at(0);
    EXPECT_EQ(bucket.at("split"), 0) << "hulls are other bodies";
    if (bucket.at("bucket") == "volume/05") {
      EXPECT_EQ(counts.at("wrong_collide"), 20) << "hulls contain the meshes";
    }
  }
#ifdef SIXDOF_TEST_CCD
  const auto right = nlohmann::json::parse(agree("--algorithms ccd-hull --sample 20 --json").out).at("pairs").at(0);
  for (const auto& bucket : right.at("buckets")) {
    if (bucket.at("bucket") == "distance/00") continue;  // nearer to contact than libccd can tell
    EXPECT_EQ(bucket.at("algorithms").at(0).at("judged_collide"), 20);
    EXPECT_EQ(bucket.at("algorithms").at(0).at("wrong_collide"), 0);
  }
#endif
}

TEST_F(Agree, JudgesFirstContacts) {
  const auto result = agree("--question cast --algorithms exact,null --sample 8 --json");
  EXPECT_EQ(result.exit_code, k_exit_defects) << result.err;
  const auto pair = nlohmann::json::parse(result.out).at("pairs").at(0);
  std::map<std::string, double> hits, missed, wrong;
  for (const auto& row : pair.at("answers")) {
    const std::string name = row.at("algorithm");
    hits[name] += row.at("hits").get<double>();
    missed[name] += row.at("missed_hits").get<double>();
    wrong[name] += row.at("mismatch").get<double>();
    EXPECT_EQ(row.at("configurations"), 8);
    EXPECT_EQ(row.at("failed"), 0);
  }
  EXPECT_EQ(pair.at("answers").size(), 24u) << "three kinds, four steps";
  EXPECT_EQ(wrong["exact"], 0.0);
  EXPECT_GT(hits["null"], 8.0);
  EXPECT_EQ(missed["null"], hits["null"]) << "it says that nothing ever touches";
  ASSERT_EQ(static_cast<double>(pair.at("differences").size()), missed["null"]);
  EXPECT_THAT(result.err, HasSubstr(fmt::format("{:.0f} first contacts are wrong or missing", missed["null"])));
  for (const std::size_t i : {std::size_t{0}, pair.at("differences").size() - 1}) {
    const auto& difference = pair.at("differences").at(i);
    EXPECT_EQ(difference.at("verdict"), "missed");
    EXPECT_EQ(difference.at("answer"), "no contact");
    std::string command = difference.at("command");
    ASSERT_EQ(command.find("sixdof query --a torus-300 --b cone-100 --algorithm null --pose '"), 0u) << command;
    command = command.substr(std::string("sixdof ").size());
    EXPECT_EQ(nlohmann::json::parse(program(command + " --json").out).at("hit"), false);
    const std::size_t name = command.rfind("null");
    const auto truth = nlohmann::json::parse(program(command.replace(name, 4, "exact") + " --json").out);
    const double t = std::stod(difference.at("truth").get<std::string>().substr(2));
    EXPECT_NEAR(truth.at("t").get<double>(), t, k_bracket) << command;
  }
  const auto text = agree("--question cast --algorithms exact,sampled --sample 8");
  EXPECT_THAT(text.out, HasSubstr("96 motions of 12 kinds and steps"));
  EXPECT_THAT(text.out, Not(HasSubstr("  exact translation")));
}

TEST_F(Agree, RefusesWhatItCannotAsk) {
  const auto no_casts = agree("--question cast --algorithms brute-force");
  EXPECT_EQ(no_casts.exit_code, k_exit_error);
  EXPECT_THAT(no_casts.err, HasSubstr("brute-force answers no first contacts of meshes"));
  const auto none = agree("--algorithms no-such");
  EXPECT_EQ(none.exit_code, k_exit_error);
  EXPECT_THAT(none.err, HasSubstr("no-such: no such algorithm"));
  const auto pair = program("agree --pair no-such");
  EXPECT_EQ(pair.exit_code, k_exit_error);
  EXPECT_THAT(pair.err, HasSubstr("pair no-such: no such pair"));
}

}  // namespace
}  // namespace sixdof
