// sixdof recommend for a plate with a hole and a bolt through it, of 1/20 of its volume (bolt_and_flange.h).

#include <fstream>
#include <map>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/geometry/load.h>
#include "bench/common/run_guarded.h"

#include "bolt_and_flange.h"
#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

using nlohmann::json;
using ::testing::AnyOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;

/// A deadline that nothing misses, and a budget that nothing uses up.
const std::string k_ample = " --deadline 10s --budget 3min";
/// exact, and methods whose few spheres and coarse voxels reach the surfaces nowhere.
const std::string k_with_coarse =
    k_ample +
    " --algorithms exact,ist,ist-descent,vps --params ist:spheres=200 --params ist-descent:spheres=200 --params "
    "vps:voxel_size=0.04";
const std::string k_with_spheres = k_ample + " --algorithms exact,ist --params ist:spheres=200";
constexpr const char* k_pushed_in = "overlapping (pushed in by 1 to 5 % of the smaller box's diagonal)";
constexpr double k_fewest = 100;          // poses of each kind, of 700
constexpr double k_set_tolerance = 1e-8;  // above that of distances in sets, 1e-9 of A's diagonal

class BoltAndFlange : public test::ScratchFolder {
 protected:
  BoltAndFlange() { test::save_bolt_and_flange(folder()); }

  test::ProgramResult run(const std::string& arguments) const {
    std::string line = "cd ";
    line += folder().string() + " && SIXDOF_CACHE=cache " + SIXDOF_PROGRAM + " " + arguments;
    return test::run_program(line);
  }

  void make_set(const std::string& arguments) const {
    const auto made = run("generate " + arguments);
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }

  /// What --json has of each question, by its name.
  std::map<std::string, json> verdicts(const std::string& arguments, int exit_code = 0) const {
    const auto done = run("recommend " + arguments + " --json");
    EXPECT_EQ(done.exit_code, exit_code) << done.err;
    const json document = json::parse(done.out);
    std::map<std::string, json> found;
    for (const json& each : document.at("questions")) found[each.at("question").get<std::string>()] = each;
    return found;
  }

  /// Of a result file, by the beginning of its name: question and algorithm.
  json row(const std::string& file, const std::string& begin) const {
    std::ifstream in(path(file));
    const json document = json::parse(in);
    for (const json& each : document.at("benchmarks")) {
      if (each.at("name").get<std::string>().starts_with("precision/" + begin + "/")) return each;
    }
    throw std::runtime_error(begin + " is missing in " + file);
  }
};

json candidate(const json& verdict, const std::string& algorithm) {
  for (const json& each : verdict.at("candidates")) {
    if (each.at("algorithm").get<std::string>() == algorithm) return each;
  }
  throw std::runtime_error(algorithm + " is no candidate");
}

/// That `exact` is taken, and how right its answers are.
void expect_exact(const json& verdict, const char* error) {
  EXPECT_TRUE(verdict.at("missing").is_null()) << verdict;
  const json& taken = verdict.at("candidates").at(0);
  EXPECT_EQ(taken.at("standing"), "taken") << taken;
  EXPECT_EQ(taken.at("algorithm"), "exact") << taken;
  EXPECT_EQ(taken.at("exact"), true) << taken;
  EXPECT_LT(taken.at(error).get<double>(), k_set_tolerance) << taken;
  EXPECT_EQ(taken.at("late"), 0) << taken;
  EXPECT_TRUE(verdict.contains("again")) << verdict;
}

void expect_cannot_say(const json& verdict) {
  EXPECT_FALSE(verdict.at("missing").is_null()) << verdict;
  EXPECT_FALSE(verdict.contains("again")) << verdict;
  for (const json& each : verdict.at("candidates")) EXPECT_NE(each.at("standing").get<std::string>(), "taken") << each;
}

/// Whatever gave a wrong yes/no is unsafe, or did not answer every query.
void expect_wrong_ones_are_unsafe(const json& yes_no) {
  for (const json& each : yes_no.at("candidates")) {
    if (each.at("standing") == "left out" || each.at("mismatch").get<double>() == 0.0) continue;
    EXPECT_THAT(each.at("standing").get<std::string>(), AnyOf("unsafe", "faulty")) << each;
  }
}

/// Spheres inside the bodies say no where the bodies barely touch.
void expect_unsafe_near_contact(const json& spheres) {
  EXPECT_EQ(spheres.at("standing"), "unsafe") << spheres;
  EXPECT_GT(spheres.at("mismatch").get<double>(), 0.0) << spheres;
  EXPECT_THAT(spheres.at("reason").get<std::string>(), HasSubstr("near contact ")) << spheres;
}

TEST_F(BoltAndFlange, AreSolidsOfVeryDifferentSizes) {
  const Mesh flange = load_mesh(path("flange.stl")), bolt = load_mesh(path("bolt.stl"));
  EXPECT_TRUE(flange.solid()) << flange.why_not_solid();
  EXPECT_TRUE(bolt.solid()) << bolt.why_not_solid();
  EXPECT_EQ(flange.topology().euler_characteristic, 0) << "one hole";
  EXPECT_NEAR(bolt.volume() / flange.volume(), 0.05, 0.002);
  EXPECT_GT(bolt.repairs().welded_vertices, bolt.vertices().size()) << "every triangle has corners of its own";
  EXPECT_EQ(load_mesh(path("open-bolt.stl")).why_not_solid(), "not closed: 24 border edges");
  const auto in_place = run("query --a flange.stl --b bolt.stl --pose '0 0 0 1 0 0 0' --algorithm exact --json");
  ASSERT_EQ(in_place.exit_code, 0) << in_place.err;
  const json answer = json::parse(in_place.out);
  EXPECT_EQ(answer.at("colliding"), false);
  constexpr double k_between_prisms = 0.4957;  // 0.5 mm cos(180 / 24 degrees)
  EXPECT_NEAR(answer.at("distance").get<double>(), k_between_prisms, 1e-4);
}

TEST_F(BoltAndFlange, HaveRightVerdictsInBothOrders) {
  const std::map<std::string, std::string> overlaps_of{{"--a flange.stl --b bolt.stl", "0.05 to 0.5"},
                                                       {"--a bolt.stl --b flange.stl", "1 to 10"}};
  for (const auto& [pair, overlaps] : overlaps_of) {
    SCOPED_TRACE(pair);
    auto found = verdicts(pair + k_with_coarse + " -o rows.json");
    ASSERT_EQ(found.size(), 4u);
    expect_exact(found["yes-no"], "mismatch");
    expect_exact(found["distance"], "error_max");
    expect_exact(found["respond"], "gamma_F_deg");
    expect_exact(found["cast"], "early_max");
    const json casts = row("rows.json", "cast/algorithm:exact");
    EXPECT_GT(casts.at("hits").get<double>(), k_fewest) << casts;
    EXPECT_EQ(casts.at("mismatch"), 0.0) << casts;
    expect_wrong_ones_are_unsafe(found["yes-no"]);
    for (const char* const spheres : {"ist", "ist-descent"}) {
      expect_unsafe_near_contact(candidate(found["yes-no"], spheres));
      EXPECT_EQ(candidate(found["distance"], spheres).at("standing"), "less right");
    }
    // A twentieth of the volume is enough to ask for forces, whichever body is A.
    const std::string depth = "overlapping (" + overlaps + " % of A's volume)";
    EXPECT_THAT(found["yes-no"].at("judged").get<std::string>(), HasSubstr(depth));
    EXPECT_THAT(found["respond"].at("judged").get<std::string>(), HasSubstr(depth));
    for (const char* const place : {"apart", "near", "overlapping"}) {
      const json exact = row("rows.json", "collide/algorithm:exact");
      EXPECT_GT(exact.at(std::string("judged_") + place).get<double>(), k_fewest) << exact;
      EXPECT_EQ(exact.at(std::string("wrong_") + place), 0.0) << exact;
    }
    EXPECT_GT(row("rows.json", "respond/algorithm:exact").at("judged_overlapping").get<double>(), k_fewest);
  }
}

TEST_F(BoltAndFlange, HaveAVerdictInPlainWords) {
  const auto done = run("recommend --a flange.stl --b bolt.stl" + k_with_coarse);
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, StartsWith("flange-bolt, a query within 10 s:\n"));
  for (const char* const line :
       {"\nyes-no      take exact: 0 of [0-9]+ answers wrong \\(at most [0-9.]+ %, with 95 % confidence\\); ",
        "\ndistance    take exact: 0 of [0-9]+ answers wrong \\(at most [0-9.]+ %, with 95 % confidence\\); ",
        "\nrespond     take exact: the exact force at all [0-9]+ poses; ",
        "\ncast        take exact: 0 of [0-9]+ contacts missed, late or wrong \\(at most [0-9.]+ %, with 95 % "
        "confidence\\); ",
        "\ncast, [0-9]+ judged motions: [0-9]+ with a first contact, [0-9]+ without; ",
        " on average, 0 of [0-9]+ queries late",
        "\nyes-no, [0-9]+ judged poses: [0-9]+ apart \\(1 to 20 % of the diagonal of A's box\\), [0-9]+ near contact "
        "\\(0\\.01 to 0\\.3 % of the smaller box's diagonal\\), [0-9]+ overlapping ",
        "\n  taken      exact: ", "\n  unsafe     ist spheres=200: [0-9]+ of [0-9]+ answers wrong \\(.*near contact ",
        "\n  less right ist spheres=200: approximate, distances off by at most [0-9.e+-]+ % of the diagonal of A's box",
        "\n  again      .*--a flange.stl --b bolt.stl "}) {
    EXPECT_THAT(done.out, ContainsRegex(line));
  }
  for (const char* const word : {"bucket", "mismatch", "gamma", "error_max", "error_rms", "configuration"}) {
    EXPECT_THAT(done.out, Not(HasSubstr(word)));
    EXPECT_THAT(done.err, Not(HasSubstr(word)));
  }
}

TEST_F(BoltAndFlange, HaveYesNoAndDistanceWhereTheBoltIsOpen) {
  for (const char* const pair : {"--a flange.stl --b open-bolt.stl", "--a open-bolt.stl --b flange.stl"}) {
    SCOPED_TRACE(pair);
    auto found = verdicts(pair + k_with_spheres);
    ASSERT_EQ(found.size(), 4u);
    expect_exact(found["yes-no"], "mismatch");
    expect_exact(found["distance"], "error_max");
    expect_exact(found["cast"], "early_max");
    EXPECT_THAT(found["yes-no"].at("judged").get<std::string>(), HasSubstr(k_pushed_in));
    const json spheres = candidate(found["yes-no"], "ist");
    EXPECT_EQ(spheres.at("standing"), "left out");
    EXPECT_EQ(spheres.at("reason"), "needs solid bodies: open-bolt (not closed: 24 border edges)");
    expect_cannot_say(found["respond"]);
    EXPECT_THAT(found["respond"].at("missing").get<std::string>(),
                StartsWith("forces need solid bodies; open-bolt: not closed: 24 border edges; `sixdof repair "));
  }
}

TEST_F(BoltAndFlange, ArePushedTogetherWhereTheSetHasThemFarApart) {
  make_set("--a flange.stl --b bolt.stl --grid so3:16:8 --distances 20,40 -o far.h5");
  auto found = verdicts("--set far.h5 -o rows.json" + k_with_spheres);
  ASSERT_EQ(found.size(), 4u);
  expect_exact(found["yes-no"], "mismatch");
  expect_exact(found["distance"], "error_max");
  expect_unsafe_near_contact(candidate(found["yes-no"], "ist"));
  EXPECT_THAT(found["yes-no"].at("judged").get<std::string>(), HasSubstr(k_pushed_in));
  EXPECT_GT(row("rows.json", "collide/algorithm:exact").at("judged_overlapping").get<double>(), k_fewest);
  expect_cannot_say(found["respond"]);
  EXPECT_EQ(found["respond"].at("missing"),
            "there are no poses of known overlap volume, which forces need (sixdof generate --volumes makes some)");
  expect_cannot_say(found["cast"]);
  EXPECT_EQ(found["cast"].at("missing"),
            "flange-bolt: its set has no poses of contact (distance 0 %), where motions begin");
}

TEST_F(BoltAndFlange, ContactsThatAreMissedAreUnsafe) {
  const auto done = verdicts(
      "--a flange.stl --b bolt.stl --question cast --algorithms exact,sampled --params "
      "sampled:steps=2" +
      k_ample);
  const json& casts = done.at("cast");
  expect_exact(casts, "early_max");
  const json sampled = candidate(casts, "sampled");
  EXPECT_EQ(sampled.at("standing"), "unsafe") << sampled;
  EXPECT_THAT(sampled.at("reason").get<std::string>(), MatchesRegex("[0-9]+ of [0-9]+ contacts wrong \\(.*\\)"));
}

TEST_F(BoltAndFlange, HaveNoVerdictOnAFewPoses) {
  make_set("--a flange.stl --b bolt.stl --grid so3:2:2 --distances 20 -o few.h5");
  auto found = verdicts("--set few.h5" + k_with_spheres, k_exit_defects);
  ASSERT_EQ(found.size(), 4u);
  for (const auto& [question, verdict] : found) expect_cannot_say(verdict);
  EXPECT_THAT(found["yes-no"].at("missing").get<std::string>(),
              MatchesRegex("there are 4 of the 30 poses apart that it needs, and [0-9]+ of the 30 poses near contact "
                           "that it needs, and [0-9]+ of the 30 poses overlapping that it needs"));
  EXPECT_EQ(found["distance"].at("missing"), "there are 4 of the 30 poses apart that it needs");
  EXPECT_EQ(candidate(found["yes-no"], "exact").at("standing"), "not ranked");
}

TEST_F(BoltAndFlange, HaveNoVerdictOnYesNoWithoutPosesApart) {
  make_set("--a bolt.stl --b flange.stl --grid so3:16:8 --volumes 5 -o deep.h5");
  auto found = verdicts("--set deep.h5" + k_with_spheres);
  ASSERT_EQ(found.size(), 4u);
  expect_cannot_say(found["yes-no"]);
  EXPECT_EQ(found["yes-no"].at("missing"),
            "there are 0 of the 30 poses apart that it needs, and 0 of the 30 poses near contact that it needs");
  expect_cannot_say(found["distance"]);
  EXPECT_EQ(found["distance"].at("missing"), "bolt-flange: its set has no poses for this question");
  expect_exact(found["respond"], "gamma_F_deg");
}

TEST_F(BoltAndFlange, HaveNoVerdictWhereTheBudgetWasTooSmall) {
  const auto done = run("recommend --a flange.stl --b bolt.stl --deadline 10s --budget 1ms --algorithms exact");
  EXPECT_EQ(done.exit_code, k_exit_defects) << done.err;
  EXPECT_THAT(done.out, HasSubstr("\nyes-no      cannot say: nothing that was measured can be taken, and 1 of 1 "
                                  "settings did not fit into the budget\n"));
  EXPECT_THAT(done.out, HasSubstr("\n  left out   exact: the budget was spent\n"));
}

}  // namespace
}  // namespace sixdof
