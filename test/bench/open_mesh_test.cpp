// Rows of a pair whose meshes are no solids.

#include <set>
#include <sstream>
#include <string>

#include <gmock/gmock.h>

#include "bench_program.h"

namespace sixdof {
namespace {

using test::BenchProgram;
using test::json;
using ::testing::HasSubstr;

struct OpenMesh : BenchProgram {
  void SetUp() override {
    // A box without its lid.
    std::ofstream(suite->directory() / "tray.off") << "OFF\n8 10 0\n"
                                                      "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
                                                      "3 0 2 1\n3 0 3 2\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n"
                                                      "3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n";
    const auto made = run("sixdof generate --a tray.off --grid 90 --distances 5 -o tray.h5", SIXDOF_PROGRAM);
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }

  /// In the folder of the mesh.
  test::ProgramResult run(std::string line, const char* program) const {
    line.replace(0, line.find(' '), program);
    return test::run_program("cd " + suite->directory().string() + " && " + line);
  }
  test::ProgramResult bench_tray(const std::string& filter) const {
    return run(
        "sixdof-bench --no-manifest --set tray.h5 --mesh tray.off --benchmark_min_time=0.000001 "
        "--benchmark_format=json "
        "'--benchmark_filter=" +
            filter + "'",
        SIXDOF_BENCH_PROGRAM);
  }
};

TEST_F(OpenMesh, AnswersYesNoAndDistance) {
  const auto run = bench_tray("^(prepare|collide|distance|respond)/.*pair:tray");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const json document = json::parse(run.out);
  std::set<std::string> answered;
  for (const json& entry : document.at("benchmarks")) {
    const std::string name = entry.at("name");
    EXPECT_FALSE(entry.contains("error_occurred")) << entry;
    EXPECT_THAT(name, ::testing::Not(HasSubstr("algorithm:vps")));
    EXPECT_THAT(name, ::testing::Not(HasSubstr("algorithm:ist")));
    answered.insert(name);
    if (name.starts_with("prepare/") || name.find("algorithm:null") != std::string::npos) continue;
    EXPECT_EQ(entry.at("mismatch"), 0) << name;
    EXPECT_EQ(entry.at("failed"), 0) << name;
  }
  for (const char* const name : {"prepare/algorithm:exact/pair:tray", "collide/algorithm:exact/pair:tray/distance:05",
                                 "distance/algorithm:exact/pair:tray/distance:05",
                                 "distance/algorithm:fcl-rss/pair:tray/distance:05/order:path"}) {
    EXPECT_TRUE(answered.contains(name)) << name;
  }
  std::istringstream lines(run.err);
  std::size_t about_left_out = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("left out") == std::string::npos) continue;
    ++about_left_out;
    EXPECT_THAT(line, HasSubstr("rows that need solids: tray (not closed: 4 border edges); `sixdof repair "));
  }
  EXPECT_EQ(about_left_out, 1u) << run.err;
}

TEST_F(OpenMesh, LeavesOutTheGenerationOfVolumes) {
  const auto run = bench_tray("^generate/volume/.*pair:tray");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("left out 1 rows that need solids: tray ("));
  EXPECT_EQ(json::parse(run.out).at("benchmarks").size(), 0u);
}

}  // namespace
}  // namespace sixdof
