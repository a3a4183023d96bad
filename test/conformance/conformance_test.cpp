#include <sixdof/conformance/conformance.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/conformance/checks.h>

#include "../cli/run_program.h"

namespace sixdof {
namespace {

using ::testing::HasSubstr;

using Names = std::set<std::string>;

/// The program's cases: names of all, and messages of those that failed.
struct Report {
  Names cases;
  std::map<std::string, std::string> failed;  ///< First message by "adapter_Check".
  std::string out;                            ///< Standard output.

  explicit Report(const std::string& filter = "*") {
    const std::string file = ::testing::TempDir() + "wrong_adapters_" + std::to_string(::getpid()) + ".json";
    const test::ProgramResult run =
        test::run_program(std::string(WRONG_ADAPTERS) + " '--gtest_filter=" + filter + "' --gtest_output=json:" + file);
    out = run.out;
    const nlohmann::json json = nlohmann::json::parse(std::ifstream(file));
    std::filesystem::remove(file);
    for (const auto& suite : json.at("testsuites")) {
      for (const auto& each : suite.at("testsuite")) {
        const std::string name = each.at("name"), short_name = name.substr(name.find('/') + 1);
        cases.insert(short_name);
        if (each.contains("failures")) failed[short_name] = each.at("failures").at(0).at("failure");
      }
    }
  }
};

/// "wrong_collide_Collide" by adapter and check.
std::map<std::string, Names> failed_by_adapter(const Report& report) {
  std::map<std::string, Names> checks;
  for (const auto& [name, message] : report.failed) {
    const std::size_t at = name.rfind('_');
    checks[name.substr(0, at)].insert(name.substr(at + 1));
  }
  return checks;
}

/// What each adapter is wrong in, as its name says, and what that must change, too.
const std::map<std::string, Names> k_expected = {
    {"wrong_declaration", {"Declaration"}},
    {"wrong_collide", {"Collide"}},
    {"wrong_collide_of_contained", {"CollideOfContained"}},
    {"wrong_distance", {"Distance"}},
    {"wrong_witnesses", {"Witnesses"}},
    {"wrong_respond", {"Respond"}},
    {"wrong_volume", {"Volume"}},
    {"wrong_open_surfaces", {"OpenSurfaces"}},
    {"wrong_order_of_collide", {"OrderOfCollide"}},
    {"wrong_order_of_distance", {"OrderOfDistance"}},
    {"wrong_order_of_respond", {"OrderOfRespond"}},
    {"wrong_motion_of_collide", {"MotionOfCollide"}},
    {"wrong_motion_of_distance", {"MotionOfDistance"}},
    {"wrong_motion_of_respond", {"MotionOfRespond"}},
    {"wrong_scale_of_collide", {"ScaleOfCollide"}},
    {"wrong_scale_of_distance", {"ScaleOfDistance"}},
    {"wrong_scale_of_respond", {"ScaleOfRespond"}},
    {"wrong_cast", {"Cast"}},
    {"wrong_cast_at_start", {"CastAtStart"}},
    {"wrong_cast_without_motion", {"CastWithoutMotion"}},
    {"wrong_motions_not_finite", {"MotionsNotFinite"}},
    {"wrong_contacts", {"Contacts"}},
    {"wrong_contacts_at_most", {"ContactsAtMost"}},
    // At other points normals and thicknesses are others, too.
    {"wrong_contact_points", {"ContactPoints", "ContactNormals", "ContactDepths"}},
    {"wrong_contact_normals", {"ContactNormals"}},
    {"wrong_contact_depths", {"ContactDepths"}},
    {"wrong_order_of_contacts", {"OrderOfContacts"}},
    {"wrong_motion_of_contacts", {"MotionOfContacts"}},
    {"wrong_contacts_not_finite", {"ContactsNotFinite"}},
    {"wrong_poses_not_finite", {"PosesNotFinite"}},
    {"wrong_unsupported", {"Unsupported"}},
    // Each query of an object has another error,
    {"wrong_repeated_queries", {"RepeatedQueries", "FreshQueries", "Threads", "PosesNotFinite"}},
    // each object has one of its own.
    {"wrong_fresh_queries", {"FreshQueries", "Threads", "SameMesh", "MovedSettings"}},
    {"wrong_threads", {"Threads"}},
    {"wrong_same_mesh", {"SameMesh"}},
    {"wrong_moved_settings", {"MovedSettings"}},
    {"known_but_passes", {"Distance"}},
    {"known_of_no_check", {"Declaration"}},
};

TEST(Conformance, AWrongAdapterFailsItsChecksAndNoOthers) {
  // Adapters that do not exist have no check.
  const Report report("-*Unusable*");
  EXPECT_EQ(failed_by_adapter(report), k_expected);
  EXPECT_TRUE(report.cases.contains("right_Distance"));
}

TEST(Conformance, EveryCheckHasAWrongAdapter) {
  Names covered;
  for (const auto& [adapter, checks] : k_expected) {
    if (adapter.starts_with("wrong_")) covered.insert(checks.begin(), checks.end());
  }
  Names names;
  for (const conformance::Check& check : conformance::all_checks()) names.insert(check.name);
  EXPECT_EQ(covered, names);
}

TEST(Conformance, AKnownFailureRunsAndMustFail) {
  const Report report("*known_*:*Unusable*");
  EXPECT_TRUE(report.cases.contains("known_failure_MotionOfCollide"));
  EXPECT_FALSE(report.failed.contains("known_failure_MotionOfCollide"));
  EXPECT_THAT(report.out, HasSubstr("known failure: moved meshes (upstream#1)\n"));
  EXPECT_THAT(report.failed.at("known_but_passes_Distance"),
              HasSubstr("Distance is listed as known, but passes: long gone"));
  EXPECT_THAT(report.failed.at("known_of_no_check_Declaration"),
              HasSubstr("known failure \"Distanc\": no such check of this algorithm"));
}

TEST(Conformance, AnAlgorithmThatCannotBeHadIsAFailure) {
  const Report report("*Unusable*");
  ASSERT_EQ(report.failed.size(), 2u);
  EXPECT_THAT(report.failed.begin()->second,
              HasSubstr("no Registrar of this program makes an algorithm \"no-registrar\""));
  EXPECT_THAT(report.failed.rbegin()->second, HasSubstr("speed"));
}

TEST(Conformance, AMessageNamesMeshesAndPose) {
  const Report report("*wrong_collide_Collide:*wrong_motion_of_collide_*");
  const std::string& message = report.failed.at("wrong_collide_Collide");
  EXPECT_THAT(message,
              HasSubstr("at: torus-300 (A), cone-100 (B)\n  sixdof query --a torus-300 --b cone-100 --pose '"));
  EXPECT_THAT(message, HasSubstr("' --algorithm wrong-collide"));
  EXPECT_THAT(report.failed.at("wrong_motion_of_collide_MotionOfCollide"), HasSubstr("at: torus-300 (moved) (A), "));
}

#ifdef SIXDOF_PROGRAM
/// Of a model, and of a mesh that is written to a file.
TEST(Conformance, ACommandLineOfAMessageAsksTheSame) {
  const Report report("*wrong_collide_Collide:*wrong_motion_of_collide_*");
  for (const auto& [name, message] : report.failed) {
    const std::string word = "sixdof query ", end = " --algorithm ";
    // The last line of the message has the moved meshes, if there are some.
    const std::size_t begin = message.rfind(word), stop = message.find(end, begin);
    ASSERT_NE(stop, std::string::npos) << message;
    const std::string line = message.substr(begin + word.size(), stop - begin - word.size());
    const auto run = test::run_program(std::string(SIXDOF_PROGRAM).append(" query ").append(line).append(" --json"));
    ASSERT_EQ(run.exit_code, 0) << line << "\n" << run.err;
    // The adapters are wrong where the surfaces meet: the first such pose is named first.
    EXPECT_TRUE(nlohmann::json::parse(run.out).at("colliding").is_boolean());
    if (name == "wrong_collide_Collide") {
      EXPECT_EQ(nlohmann::json::parse(run.out).at("colliding"), true);
      EXPECT_EQ(nlohmann::json::parse(run.out).at("distance"), 0.0);
    }
  }
}
#endif

}  // namespace
}  // namespace sixdof
