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
