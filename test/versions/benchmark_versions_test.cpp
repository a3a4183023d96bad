#include "bench/harness/benchmark_versions.h"

#include <string>

#include <benchmark/benchmark.h>
#include <gtest/gtest.h>

namespace sixdof::bench {
namespace {

/// Google Benchmark 1.7.
struct OldRow {
  bool error_occurred = false;
  std::string error_message;
};

/// From 1.8 on.
enum Skipped {
  NotSkipped = 0,
  SkippedWithMessage,
  SkippedWithError
};
struct NewRow {
  Skipped skipped = NotSkipped;
  std::string skip_message;
};

/// The library at hand.
using Row = benchmark::BenchmarkReporter::Run;

template <class Run>
void expect_error_as_set() {
  Run run;
  EXPECT_FALSE(has_error(run));
  set_error(run, "no such model");
  EXPECT_TRUE(has_error(run));
}

TEST(BenchmarkVersions, ARowHasTheErrorThatWasSet) {
  expect_error_as_set<OldRow>();
  expect_error_as_set<NewRow>();
  expect_error_as_set<Row>();
}

TEST(BenchmarkVersions, TheErrorStandsWhereTheVersionHasIt) {
  OldRow old_row;
  set_error(old_row, "a");
  EXPECT_TRUE(old_row.error_occurred);
  EXPECT_EQ(old_row.error_message, "a");
  NewRow new_row;
  set_error(new_row, "b");
  EXPECT_EQ(new_row.skipped, SkippedWithError);
  EXPECT_EQ(new_row.skip_message, "b");
}

/// A row that was skipped for a reason that is no error has no error.
TEST(BenchmarkVersions, AMessageIsNoError) {
  NewRow row;
  row.skipped = SkippedWithMessage;
  EXPECT_FALSE(has_error(row));
}

TEST(BenchmarkVersions, SecondsAreSpelledAsTheVersionTakesThem) {
  for (const char* const flag : {"--benchmark_min_time=0.25", "--benchmark_min_time=0.25s"}) {
    EXPECT_EQ(flag_of_version<OldRow>(flag), "--benchmark_min_time=0.25");
    EXPECT_EQ(flag_of_version<NewRow>(flag), "--benchmark_min_time=0.25s");
  }
  EXPECT_EQ(flag_of_version<NewRow>("--benchmark_min_time=100x"), "--benchmark_min_time=100x");
  for (const char* const flag : {"--benchmark_filter=distance/s", "--benchmark_repetitions=3"}) {
    EXPECT_EQ(flag_of_version<OldRow>(flag), flag);
    EXPECT_EQ(flag_of_version<NewRow>(flag), flag);
  }
}

}  // namespace
}  // namespace sixdof::bench
