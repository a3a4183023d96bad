// The line about meshes whose volumes count parts several times.

#include <sstream>
#include <string>

#include <gmock/gmock.h>

#include "../cli/mesh_files.h"
#include "bench_program.h"

namespace sixdof {
namespace {

using test::BenchProgram;
using ::testing::HasSubstr;

struct MeshWarning : BenchProgram {
  void SetUp() override { test::save_crossing_boxes(suite->directory() / "crossing.ply"); }

  test::ProgramResult run(const std::string& program, const std::string& arguments) const {
    return test::run_program("cd " + suite->directory().string() + " && SIXDOF_CACHE=cache " + program + arguments);
  }
};

TEST_F(MeshWarning, StandsOnceAtTheEndOfARun) {
  ASSERT_EQ(run(SIXDOF_PROGRAM, " generate --a crossing.ply --grid 90 --distances 5,6 -o crossing.h5").exit_code, 0);
  const auto result = run(SIXDOF_BENCH_PROGRAM,
                          " --no-manifest --set crossing.h5 --mesh crossing.ply --benchmark_min_time=0.000001 "
                          "'--benchmark_filter=^(prepare|distance)/algorithm:exact/'");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::istringstream lines(result.err);
  std::size_t warnings = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("warning: ") == std::string::npos) continue;
    ++warnings;
    EXPECT_THAT(line, HasSubstr("sixdof-bench: warning: crossing: "));
    EXPECT_THAT(line, HasSubstr("(sixdof info --check crossing.ply)"));
  }
  EXPECT_EQ(warnings, 1u) << result.err;
}

TEST_F(MeshWarning, IsNotThereForSoundMeshes) {
  const auto result = bench("'--benchmark_filter=^prepare/algorithm:exact/'");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, ::testing::Not(HasSubstr("warning: ")));
}

}  // namespace
}  // namespace sixdof
