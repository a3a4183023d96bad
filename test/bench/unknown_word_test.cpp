#include "bench/common/unknown_word.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/common/run_guarded.h"

#include "bench_program.h"

namespace sixdof {
namespace {

using test::BenchProgram;
using ::testing::HasSubstr;

TEST(UnknownWord, NamesTheNearestKnownOne) {
  const std::vector<std::string> names{"grid", "budget", "benchmark_filter"};
  EXPECT_EQ(explain_unknown_word("--gird=45", names, "p --help"), "--gird: no such option; did you mean --grid?");
  EXPECT_EQ(explain_unknown_word("gird", names, "p --help"), "gird: no such command; did you mean grid?");
  EXPECT_EQ(explain_unknown_word("--frobnicate", names, "p --help"),
            "--frobnicate: no such option (p --help lists them)");
  EXPECT_EQ(explain_unknown_word("--", names, "p --help"), "--: no such option (p --help lists them)");
}

TEST_F(BenchProgram, NamesTheUnknownOptionAndTheNearestKnownOne) {
  for (const auto& [typed, meant] : {std::pair("--bduget=3", "--bduget: no such option; did you mean --budget?"),
                                     std::pair("--benchmark_fitler=x", "did you mean --benchmark_filter?"),
                                     std::pair("--frobnicate", "(sixdof-bench --help lists them)"),
                                     std::pair("table", "table: unexpected argument (sixdof-bench --help)")}) {
    const auto result = bench(typed);
    EXPECT_EQ(result.exit_code, k_exit_usage) << typed;
    EXPECT_THAT(result.err, HasSubstr(meant));
  }
}

}  // namespace
}  // namespace sixdof
