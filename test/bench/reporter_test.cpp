#include "bench/harness/reporter.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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
  ResultCollector collector;
  void SetUp() override { collector.ReportContext(benchmark::BenchmarkReporter::Context()); }
  nlohmann::json document() {
    collector.Finalize();
    return nlohmann::json::parse(collector.document({{"seed", "7"}}));
  }
};

TEST_F(Collector, LeavesOutWhatJsonCannotSay) {
  ResultRow run = row("a");
  run.counters["good"] = 2.5;
  run.counters["nan"] = std::nan("");
  run.counters["infinite"] = std::numeric_limits<double>::infinity();
  ResultRow coefficient_of_variation = row("b");
  coefficient_of_variation.cpu_accumulated_time = std::nan("");
  collector.ReportRuns({run, coefficient_of_variation});
  const auto json = document();
  EXPECT_EQ(json.at("context").at("seed"), "7");
  ASSERT_EQ(json.at("benchmarks").size(), 1u);
  EXPECT_EQ(json.at("benchmarks")[0].at("good"), 2.5);
  EXPECT_FALSE(json.at("benchmarks")[0].contains("nan"));
  EXPECT_FALSE(json.at("benchmarks")[0].contains("infinite"));
}

TEST_F(Collector, KeepsAndCountsFailures) {
  ResultRow failure = row("a");
  failure.error_occurred = true;
  failure.error_message = "no such model";
  collector.ReportRuns({failure});
  collector.ReportRuns({row("c")});
  EXPECT_EQ(collector.failed(), 1);
  EXPECT_EQ(collector.rows(), 1);
  const auto json = document();
  ASSERT_EQ(json.at("benchmarks").size(), 2u);
  EXPECT_EQ(json.at("benchmarks")[0].at("error_message"), "no such model");
  EXPECT_EQ(json.at("benchmarks")[1].at("name"), "c");
}

TEST_F(Collector, IsValidWithoutAnyRow) { EXPECT_EQ(document().at("benchmarks").size(), 0u); }

}  // namespace
}  // namespace sixdof::bench
