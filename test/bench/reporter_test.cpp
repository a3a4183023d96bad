#include "bench/harness/reporter.h"

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/harness/benchmark_versions.h"
#include "bench/harness/timing.h"

namespace sixdof::bench {
namespace {

using ResultRow = benchmark::BenchmarkReporter::Run;

ResultRow row(const std::string& name) {
  ResultRow run;
  run.run_name.function_name = name;
  run.family_index = 0;
  run.per_family_instance_index = 0;
  run.repetition_index = 0;
  run.repetitions = 1;
  run.statistics = nullptr;
  run.real_accumulated_time = 1e-6;
  run.cpu_accumulated_time = 1e-6;
  return run;
}

struct Collector : ::testing::Test {
  std::set<std::string> left_out;
  FieldsByName fields{{"a", {.query = "distance", .algorithm = "exact"}},
                      {"b", {.query = "prepare", .algorithm = "exact"}},
                      {"c", {.query = "scenario", .algorithm = "vps", .scenario = "II"}}};
  ResultStore store{{"a", "b", "c"}, {{"seed", "7"}}};
  static results::Outliers one_outlier() {
    results::Outliers found{.a = "left", .b = "right"};
    found.add("max_ns", Pose{.t = {0.1, 2.0, 3.0}});
    return found;
  }
  OutliersByName outliers{{"a", one_outlier}, {"c", one_outlier}};
  ResultCollector rows{store, fields, outliers};
  RowReporter collector{&rows, left_out};

  /// Each call of ReportRuns() is a row of its own.
  void report(const std::vector<ResultRow>& runs) {
    collector.ReportRuns(runs);
    store.commit({});
  }
  nlohmann::json document() { return store.document(false); }
};

TEST_F(Collector, MakesARowWithANonFiniteCounterAnError) {
  for (const auto& [name, bad] : {std::pair("a", std::nan("")), {"b", std::numeric_limits<double>::infinity()}}) {
    ResultRow run = row(name);
    run.counters["good"] = 2.5;
    run.counters["misses"] = bad;
    report({run});
  }
  EXPECT_EQ(collector.failed(), 2);
  const auto json = document();
  EXPECT_EQ(json.at("context").at("seed"), "7");
  ASSERT_EQ(json.at("benchmarks").size(), 2u);
  EXPECT_EQ(json.at("benchmarks")[0].at("error_occurred"), true);
  EXPECT_EQ(json.at("benchmarks")[0].at("error_message"), "counter misses is not finite (nan)");
  EXPECT_EQ(json.at("benchmarks")[1].at("error_message"), "counter misses is not finite (inf)");
  EXPECT_FALSE(json.at("benchmarks")[0].contains("good"));
}

TEST_F(Collector, OutliersStandBesideTheFieldsOfRowsThatRan) {
  ResultRow failed = row("c");
  set_error(failed, "it failed");
  report({row("a")});
  report({row("b")});
  report({failed});
  const auto written = document().at("benchmarks");
  ASSERT_EQ(written.size(), 3u);
  EXPECT_EQ(written[0].at("outliers").at("poses").at("max_ns"), "0.1 2 3 1 0 0 0");
  EXPECT_EQ(written[0].at("outliers").at("b"), "right");
  EXPECT_FALSE(written[0].at("outliers").contains("command"));
  EXPECT_FALSE(written[1].contains("outliers"));
  EXPECT_FALSE(written[2].contains("outliers"));
}

TEST_F(Collector, RowsOfOneRoundHaveTheirOwnNameAndTime) {
  ResultRow run = row("a");
  run.run_name.iterations = "iterations:1";
  run.run_name.time_type = "process_time/manual_time";
  run.cpu_accumulated_time = 7.0;
  report({run});
  const auto written = document().at("benchmarks")[0];
  EXPECT_EQ(written.at("name"), "a");
  EXPECT_EQ(written.at("run_name"), "a");
  EXPECT_EQ(written.at("cpu_time"), written.at("real_time"));
}

TEST_F(Collector, OtherRowsHaveTheProcessorTimeOfAllThreads) {
  ResultRow run = row("a");
  run.run_name.time_type = "process_time";
  run.iterations = 1;
  run.real_accumulated_time = 4e-6;
  run.cpu_accumulated_time = 7e-6;
  report({run});
  const auto written = document().at("benchmarks")[0];
  EXPECT_EQ(written.at("name"), "a");
  EXPECT_DOUBLE_EQ(written.at("cpu_time"), 7000.0);
  EXPECT_DOUBLE_EQ(written.at("real_time"), 4000.0);
}

TEST_F(Collector, IsolatedRowsHaveTheProcessorTimeOfTheirProcess) {
  ResultRow run = row("a");
  run.run_name.time_type = "manual_time";
  run.iterations = 4;
  run.real_accumulated_time = 4e-6;
  run.counters[k_processor_inside] = 750.0;
  ResultRow variation = run;
  variation.run_type = ResultRow::RT_Aggregate;
  variation.aggregate_name = "cv";
  variation.aggregate_unit = benchmark::kPercentage;
  variation.counters[k_processor_inside] = 0.25;
  report({run, variation});
  const auto rows_written = document().at("benchmarks");
  EXPECT_EQ(rows_written[0].at("name"), "a");
  EXPECT_DOUBLE_EQ(rows_written[0].at("cpu_time"), 750.0);
  EXPECT_DOUBLE_EQ(rows_written[0].at("real_time"), 1000.0);
  EXPECT_DOUBLE_EQ(rows_written[1].at("cpu_time"), 0.25);
  for (const auto& written : rows_written) EXPECT_FALSE(written.contains(k_processor_inside));
}

TEST_F(Collector, LeavesOutTheCoefficientOfVariationOfZeros) {
  ResultRow variation = row("a");
  variation.run_type = ResultRow::RT_Aggregate;
  variation.aggregate_name = "cv";
  variation.counters["failed"] = std::nan("");
  variation.counters["p50_ns"] = 0.1;
  ResultRow without_time = variation;
  without_time.cpu_accumulated_time = std::nan("");
  report({variation, without_time});
  EXPECT_EQ(collector.failed(), 0);
  const auto json = document();
  ASSERT_EQ(json.at("benchmarks").size(), 1u);
  EXPECT_EQ(json.at("benchmarks")[0].at("p50_ns"), 0.1);
  EXPECT_FALSE(json.at("benchmarks")[0].contains("failed"));
}

TEST_F(Collector, KeepsAndCountsFailures) {
  ResultRow failure = row("a");
  set_error(failure, "no such model");
  report({failure});
  report({row("c")});
  EXPECT_EQ(collector.failed(), 1);
  const auto json = document();
  ASSERT_EQ(json.at("benchmarks").size(), 2u);
  EXPECT_EQ(json.at("benchmarks")[0].at("error_message"), "no such model");
  EXPECT_EQ(json.at("benchmarks")[1].at("name"), "c");
}

TEST_F(Collector, LeavesOutRowsByName) {
  left_out.insert("needs-a-solid");
  ResultRow skipped = row("needs-a-solid");
  set_error(skipped, "not closed");
  report({skipped});
  report({row("b")});
  EXPECT_EQ(collector.failed(), 0);
  const auto json = document();
  ASSERT_EQ(json.at("benchmarks").size(), 1u);
  EXPECT_EQ(json.at("benchmarks")[0].at("name"), "b");
}

TEST_F(Collector, AddsTheFieldsOfARow) {
  ResultRow measured = row("a");
  measured.counters["configurations"] = 64;
  measured.report_label = "stack \xff is full";
  ResultRow mean = measured;
  mean.run_type = ResultRow::RT_Aggregate;
  mean.aggregate_name = "stddev";
  mean.counters["configurations"] = 0;
  report({measured, mean});
  const auto json = document();
  ASSERT_EQ(json.at("benchmarks").size(), 2u);
  const auto& first = json.at("benchmarks")[0];
  EXPECT_EQ(first.at("sixdof").at("query"), "distance");
  EXPECT_EQ(first.at("sixdof").at("configurations"), 64);
  EXPECT_EQ(first.at("configurations"), 64);
  EXPECT_EQ(first.at("label"), R"(stack \xFF is full)") << "bytes that are not UTF-8 are visible";
  EXPECT_FALSE(json.at("benchmarks")[1].at("sixdof").contains("configurations")) << "a deviation is no number of them";
}

TEST(ConsoleText, DoesNotCallTheLibraryADebugBuild) {
  ::testing::internal::CaptureStderr();
  Console().ReportContext(benchmark::BenchmarkReporter::Context());
  const std::string text = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(text.find("Load Average"), std::string::npos) << text;
  EXPECT_EQ(text.find("DEBUG"), std::string::npos) << text;
}

TEST_F(Collector, IsValidWithoutAnyRow) { EXPECT_EQ(document().at("benchmarks").size(), 0u); }

}  // namespace
}  // namespace sixdof::bench
