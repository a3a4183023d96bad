// `sixdof new-algorithm`. test/downstream/ builds what it writes.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/common/run_guarded.h"

#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class NewAlgorithm : public test::ScratchFolder {
 protected:
  static test::ProgramResult run(const std::string& arguments) {
    return test::run_program(std::string(SIXDOF_PROGRAM) + " new-algorithm " + arguments);
  }
  static std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::recursive_directory_iterator(folder()),
                                                  std::filesystem::recursive_directory_iterator()));
  }
};

TEST_F(NewAlgorithm, WritesAProjectUnderItsName) {
  const auto result = run("fast-boxes-2 -o " + path("mine"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("cmake -S . -B build"), HasSubstr("build/fast-boxes-2-bench --a"),
                                HasSubstr("It uses the source of sixdof, ")));
  EXPECT_EQ(files(), 5u);  // the folder and four in it
  const std::string build = text_of(path("mine/CMakeLists.txt")), source = text_of(path("mine/fast_boxes_2.cpp")),
                    readme = text_of(path("mine/README.md")),
                    conformance = text_of(path("mine/fast_boxes_2_conformance.cpp"));
  EXPECT_THAT(conformance, HasSubstr("SIXDOF_CONFORMANCE(\"fast-boxes-2\", "));
  EXPECT_THAT(build, AllOf(HasSubstr("project(fast-boxes-2 "), HasSubstr("sixdof::bench_main"),
                           HasSubstr(" fast_boxes_2.cpp")));
  EXPECT_THAT(source, AllOf(HasSubstr("class FastBoxes2Query final"), HasSubstr(".name = \"fast-boxes-2\"")));
  // The program is in a folder of builds, so the project uses the source.
  const std::string place = "set(SIXDOF \"";
  const std::size_t begin = build.find(place) + place.size();
  EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(build.substr(begin, build.find('"', begin) - begin)) /
                                      "lib" / "CMakeLists.txt"));
  for (const std::string& text : {build, source, readme, conformance}) EXPECT_THAT(text, Not(HasSubstr("@")));
}

TEST_F(NewAlgorithm, WritesTheJobOfAService) {
  for (const auto& [ci, job] :
       {std::pair("github", ".github/workflows/sixdof-gate.yml"), {"gitlab", ".gitlab-ci.yml"}}) {
    const std::string project = path(ci);
    ASSERT_EQ(run("fast-boxes --ci " + std::string(ci) + " -o " + project).exit_code, 0);
    const std::string script = text_of(std::filesystem::path(project) / "ci/gate"),
                      text = text_of(std::filesystem::path(project) / job);
    EXPECT_THAT(script,
                AllOf(HasSubstr("fast-boxes-sixdof\" gate "), Not(HasSubstr("@NAME@")), Not(HasSubstr("@REVISION@"))));
    EXPECT_THAT(text, AllOf(HasSubstr("ci/gate --base"), HasSubstr("@sha256:"), Not(HasSubstr("@REVISION@"))));
    EXPECT_EQ(std::filesystem::status(project + "/ci/gate").permissions() & std::filesystem::perms::owner_exec,
              std::filesystem::perms::owner_exec);
    EXPECT_TRUE(std::filesystem::exists(project + "/fast_boxes.cpp"));
  }
  EXPECT_EQ(run("fast-boxes --ci travis -o " + path("other")).exit_code, k_exit_usage);
}

TEST_F(NewAlgorithm, AddsAJobToAProjectThatIsThere) {
  std::filesystem::create_directory(path("there"));
  std::ofstream(path("there/CMakeLists.txt")) << "mine";
  ASSERT_EQ(run("exact --ci gitlab -o " + path("there")).exit_code, 0) << "its algorithm may have any name";
  EXPECT_EQ(text_of(path("there/CMakeLists.txt")), "mine");
  EXPECT_THAT(text_of(path("there/ci/gate")), HasSubstr("exact-bench"));
  const auto again = run("exact --ci github -o " + path("there"));
  EXPECT_EQ(again.exit_code, k_exit_error);
  EXPECT_THAT(again.err, HasSubstr("ci/gate: exists already, and is not overwritten"));
  EXPECT_FALSE(std::filesystem::exists(path("there/.github")));
}

TEST_F(NewAlgorithm, OverwritesNothing) {
  std::filesystem::create_directory(path("there"));
  std::ofstream(path("file")) << "mine";
  for (const char* const name : {"there", "there/", "file"}) {
    const auto result = run("boxes -o " + path(name));
    EXPECT_EQ(result.exit_code, k_exit_error);
    EXPECT_THAT(result.err, HasSubstr("exists already, and is not overwritten\n")) << name;
  }
  EXPECT_EQ(text_of(path("file")), "mine");
  EXPECT_EQ(files(), 2u);
}

TEST_F(NewAlgorithm, RefusesNamesThatCannotBeUsed) {
  for (const char* const name : {"''", "Boxes", "2boxes", "boxes-", "my_boxes", "a/b", "-- -boxes"}) {
    const auto result = run(std::string(name) + " -o " + path("mine"));
    EXPECT_NE(result.exit_code, 0) << name;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  }
  EXPECT_THAT(run("exact -o " + path("mine")).err, HasSubstr("exact: there is an algorithm of this name"));
  EXPECT_EQ(files(), 0u);
}

TEST_F(NewAlgorithm, LeavesNothingWhereTheFolderCannotBeMade) {
  const auto result = run("boxes -o " + path("no/such/folder"));
  EXPECT_EQ(result.exit_code, k_exit_error);
  EXPECT_THAT(result.err, AllOf(HasSubstr("no/such/folder: cannot be made"), HasSubstr("No such file")));
  EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace sixdof
