// `sixdof compare`: its summary, and when it ends with defects.

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/common/run_guarded.h"

#include "../results/result_rows.h"
#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

using results::test::Json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr int k_algorithms = 15;

class Compare : public test::ScratchFolder {
 protected:
  /// Two rows of each algorithm. The error of algorithm k grows by k times `change`.
  std::string write(const std::string& name, double change) const {
    std::vector<Json> rows;
    for (int k = 0; k < k_algorithms; ++k) {
      for (const double percent : {5.0, 9.0}) {
        rows.push_back(results::test::row("distance", fmt::format("a{}", k), "p|q", "distance", percent, 100.0,
                                          {{"error_max", 1e-3 * (1.0 + change * k)}}));
      }
    }
    std::ofstream(path(name)) << results::test::file_of(rows);
    return path(name);
  }
  static test::ProgramResult compare(const std::string& arguments) {
    return test::run_program(std::string(SIXDOF_PROGRAM) + " compare " + arguments);
  }
};

TEST_F(Compare, MarkdownIsASummaryOfTwentyLines) {
  const std::string files = write("before.json", 0.0) + " " + write("after.json", 0.5);
  const auto done = compare(files + " --markdown");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_LE(std::ranges::count(done.out, '\n'), 20) << done.out;
  EXPECT_THAT(done.out, StartsWith("### 28 answers changed in 30 common rows; 0 rows only before, 0 only after; 0 "
                                   "versions differ\n\n| rows | counter | how many | largest change | in |\n"));
  EXPECT_THAT(done.out, HasSubstr("|---|---|---|---|---|\n| distance/algorithm:a1 |"));
  EXPECT_THAT(done.out, HasSubstr("| distance/algorithm:a14 | error\\_max | 2 | 0.001 -\\> 0.008 | "
                                  "distance/algorithm:a14/pair:p\\|q/distance:5.000000 |\n"));
  EXPECT_THAT(done.out, HasSubstr("\n- and 2 more kinds of changes\n"));
  const auto list = compare(files);
  EXPECT_EQ(std::ranges::count(list.out, '\n'), 29) << "all of them without it";
}

TEST_F(Compare, FailsOnAnswersOnRequest) {
  const std::string before = write("before.json", 0.0), after = write("after.json", 0.5);
  for (const std::string form : {"", " --markdown", " --json"}) {
    EXPECT_EQ(compare(before + " " + after + form).exit_code, 0) << form;
    EXPECT_EQ(compare(before + " " + after + " --fail-on-answers" + form).exit_code, k_exit_defects) << form;
    EXPECT_EQ(compare(before + " " + before + " --fail-on-answers" + form).exit_code, 0) << form;
  }
  EXPECT_EQ(compare(before + " " + before + " --markdown").out,
            "### 0 answers changed in 30 common rows; 0 rows only before, 0 only after; 0 versions differ\n");
}

TEST_F(Compare, TakesATolerance) {
  const std::string before = write("before.json", 0.0), after = write("after.json", 0.5);
  // The largest error grows by 7 times itself, by 0.875 of the larger.
  EXPECT_EQ(compare(before + " " + after + " --fail-on-answers --tolerance 0.9").exit_code, 0);
  EXPECT_EQ(compare(before + " " + after + " --fail-on-answers --tolerance 0.8").exit_code, k_exit_defects);
  const Json found = Json::parse(compare(before + " " + after + " --json").out);
  for (const Json& each : found.at("answers")) EXPECT_EQ(each.at("worse"), true) << each;
}

}  // namespace
}  // namespace sixdof
