// sixdof conform, as a user types it. test/conformance/ has an adapter with just one error for each check.

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/conformance/checks.h>
#include "bench/common/run_guarded.h"

#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// `exact` in a program of its own: it answers for bodies.
const std::string k_external = "--external 'mine=" SIXDOF_PROGRAM " --serve-algorithm exact' ";

class Conform : public test::ScratchFolder {
 protected:
  test::ProgramResult run(const std::string& arguments) const {
    return test::run_program("cd " + folder().string() + " && " + SIXDOF_PROGRAM + " conform " + arguments);
  }
  json findings(const std::string& arguments, int exit_code = 0) const {
    const auto done = run(arguments + " --json " + path("findings.json"));
    EXPECT_EQ(done.exit_code, exit_code) << done.out << done.err;
    return json::parse(std::ifstream(path("findings.json")));
  }
};

TEST_F(Conform, RunsEveryCheckOfTheKit) {
  const json list = findings("--algorithm exact");
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].at("algorithm"), "exact");
  const auto& checks = conformance::all_checks();
  ASSERT_EQ(list[0].at("checks").size(), checks.size());
  for (std::size_t i = 0; i < checks.size(); ++i) {
    const json& found = list[0].at("checks")[i];
    const std::string name = checks[i].name;
    EXPECT_EQ(found.at("check"), name);
    const bool is_of_contacts = name.find("Contact") != std::string::npos;  // which `exact` does not answer
    EXPECT_EQ(found.at("verdict"), name == "Unsupported" || is_of_contacts ? "not answered" : "passed") << found;
    EXPECT_TRUE(found.at("failures").empty());
  }
}

TEST_F(Conform, PrintsALineForEachCheck) {
  const auto done = run("--algorithm vps --checks Declaration,Distance,OrderOfRespond");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, AllOf(HasSubstr("\n  passed         Declaration\n"),
                              HasSubstr("\n  not answered   Distance: it does not answer distances\n"),
                              HasSubstr("\n  not claimed    OrderOfRespond: order_error is not claimed\n"),
                              HasSubstr("\nvps: 1 passed, 1 not answered, 1 not claimed\n")));
}

TEST_F(Conform, HoldsAnExternalProgramToItsClaims) {
  const std::string checks = "--checks CollideOfContained,Distance,PosesNotFinite,Threads,Unsupported ";
  const auto kept = run(k_external + checks + "--claim mine:collide=bodies");
  EXPECT_EQ(kept.exit_code, 0) << kept.out << kept.err;
  EXPECT_THAT(kept.out, HasSubstr("mine: 4 passed, 1 not answered\n"));
  const auto broken = run(k_external + checks);
  EXPECT_EQ(broken.exit_code, k_exit_defects);
  EXPECT_EQ(broken.err, "sixdof: these checks failed: CollideOfContained of mine\n");
  EXPECT_THAT(broken.out, HasSubstr("  failed         CollideOfContained: yes instead of no: one body is inside the "
                                    "other, and yes/no is claimed for surfaces (and "));
}

/// `exact` as a rival that is set up. @param hello more of its greeting, @param conformance of its recipe
std::string rival(const std::filesystem::path& folder, const std::string& hello, const std::string& conformance) {
  std::filesystem::create_directories(folder / "ready");
  std::ofstream(folder / "ready/mine.json")
      << R"({"name": "mine", "command": ")" SIXDOF_PROGRAM R"( --serve-algorithm exact", "runtime": "native",)"
      << R"( "licence": "none", "hello": {"protocol": 1, "name": "mine", "version": "1", "summary": "s",)"
      << R"( "answers": ["collide", "distance", "respond"], "law": "volume")" << hello << R"(}, "conformance": )"
      << conformance << "}";
  return "env SIXDOF_RIVALS=" + folder.string() + " " SIXDOF_PROGRAM " conform --algorithms rivals ";
}

TEST_F(Conform, TakesClaimsOfARivalFromItsRecipe) {
  const auto asked = [&](const std::string& conformance) {
    return test::run_program("cd " + folder().string() + " && " + rival(folder() / "rivals", "", conformance) +
                             "--checks CollideOfContained,Distance");
  };
  const auto kept = asked(R"({"claims": {"collide": "bodies"}})");
  EXPECT_EQ(kept.exit_code, 0) << kept.out << kept.err;
  const auto known = asked(R"({"known_failures": [{"check": "CollideOfContained", "reason": "it sees bodies"}]})");
  EXPECT_EQ(known.exit_code, 0) << known.err;
  EXPECT_THAT(known.out, HasSubstr("  known failure  CollideOfContained: it sees bodies\n"));
  EXPECT_EQ(asked("{}").exit_code, k_exit_defects);
  const auto other = asked(R"({"claims": {"colide": "bodies"}})");
  EXPECT_EQ(other.exit_code, k_exit_error);
  EXPECT_THAT(other.err, HasSubstr("ready/mine.json: claim colide: no such claim"));
}

TEST_F(Conform, AsksAlgorithmsAboutHullsAboutHulls) {
  const std::string command =
      "cd " + folder().string() + " && " +
      rival(folder() / "rivals", R"(, "body": "convex_hull")", R"({"claims": {"collide": "bodies"}})");
  const auto right = test::run_program(command + "--checks Collide,CollideOfContained,Distance,Volume,OpenSurfaces");
  EXPECT_EQ(right.exit_code, 0) << right.out << right.err;
  EXPECT_THAT(right.out, HasSubstr("  not answered   OpenSurfaces: a hull is closed, whatever its mesh\n"));
  std::ofstream(path("never.py")) << R"(import json, sys
for line in sys.stdin:
    do = json.loads(line)["do"]
    print(json.dumps({"protocol": 1, "name": "never", "version": "1", "answers": ["collide"], "body": "convex_hull"}
                     if do == "hello" else {"prepared": True} if do == "prepare" else {"collide": False, "ns": 1}),
          flush=True)
)";
  const auto wrong = run("--external 'never=python3 never.py' --checks Collide");
  EXPECT_EQ(wrong.exit_code, k_exit_defects);
  EXPECT_THAT(wrong.out, HasSubstr("  failed         Collide: no instead of yes: "));
}

TEST_F(Conform, AKnownFailureMustFail) {
  const std::string checks = "--checks CollideOfContained,Distance ";
  const auto known = run(k_external + checks + "--known-failure 'mine:CollideOfContained=it sees bodies'");
  EXPECT_EQ(known.exit_code, 0) << known.err;
  EXPECT_THAT(known.out, HasSubstr("  known failure  CollideOfContained: it sees bodies\n"));
  const json gone =
      findings(k_external + "--checks Distance --known-failure 'mine:Distance=long gone'", k_exit_defects);
  EXPECT_EQ(gone[0].at("checks")[0].at("why"), "Distance is listed as known, but passes: long gone");
}

TEST_F(Conform, AProgramThatDiesFailsItsChecks) {
  std::ofstream(path("dies.py")) << R"(import json, sys
for line in sys.stdin:
    do = json.loads(line)["do"]
    if do == "ask":
        sys.exit(7)
    print(json.dumps({"protocol": 1, "name": "dies", "version": "1", "answers": ["collide"]} if do == "hello" else
                     {"prepared": True}), flush=True)
)";
  const auto done = run("--external 'dies=python3 dies.py' --checks Collide,Distance,OpenSurfaces");
  EXPECT_EQ(done.exit_code, k_exit_defects);
  EXPECT_THAT(done.out, AllOf(HasSubstr("  failed         Collide: no answer to collide, status crashed: ended with "
                                        "exit code 7"),
                              HasSubstr("  not answered   Distance: "), HasSubstr("  failed         OpenSurfaces: ")));
  EXPECT_EQ(done.err, "sixdof: these checks failed: Collide of dies, OpenSurfaces of dies\n");
}

TEST_F(Conform, RefusesWhatItCannotCheck) {
  const auto refuses = [&](const std::string& arguments, const std::string& words) {
    const auto done = run(arguments);
    EXPECT_EQ(done.exit_code, k_exit_error) << arguments;
    EXPECT_THAT(done.err, HasSubstr(words)) << arguments;
    EXPECT_THAT(done.out, Not(HasSubstr("passed"))) << arguments;
  };
  refuses("--algorithm exactly", "exactly: no such algorithm");
  refuses("--algorithm exact --checks Colide", "Colide: no such check; there are Declaration, Collide, ");
  refuses("--algorithm exact --claim collide=bodies", "--claim collide=bodies: must read ALGORITHM:NAME=VALUE");
  refuses("--algorithm exact --claim vps:collide=bodies",
          "--claim vps:collide=bodies: vps is not among the algorithms");
  refuses("--algorithm exact --claim exact:speed=1", "claim speed: no such claim");
  refuses("--algorithm exact -p exact:speed=1", "speed: no such parameter");
  EXPECT_EQ(run("--algorithm exact --json").exit_code, k_exit_usage);
}

}  // namespace
}  // namespace sixdof
