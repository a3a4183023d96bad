#include "bench/cli/commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof::cli {
namespace {

TEST(ResultsTable, HasALinePerAlgorithmAndAColumnPerBucket) {
  const std::string text = R"({"context": {}, "benchmarks": [
    {"name": "prepare/algorithm:x/pair:p", "run_type": "iteration", "cpu_time": 7, "time_unit": "ms"},
    {"name": "collide/algorithm:x/pair:p/distance:05", "run_type": "iteration", "cpu_time": 2500, "time_unit": "ns", "p99_ns": 40000, "failed": 0, "mismatch": 0},
    {"name": "collide/algorithm:x/pair:p/distance:05", "run_type": "iteration", "cpu_time": 1500, "time_unit": "ns", "p99_ns": 30000, "failed": 0, "mismatch": 0},
    {"name": "collide/algorithm:x/pair:p/distance:00", "run_type": "iteration", "cpu_time": 123456, "time_unit": "ns", "p99_ns": 200000, "failed": 1, "mismatch": 2},
    {"name": "collide/algorithm:x/pair:p/distance:05_mean", "run_type": "aggregate", "cpu_time": 9, "time_unit": "ns"},
    {"name": "distance/algorithm:y/pair:p/distance:05/order:path", "run_type": "iteration", "error_occurred": true, "error_message": "no"}]})";
  EXPECT_EQ(results_table(text, "r.json"),
            "p: mean / p99 in us, at distances in percent of A's box diagonal\n"
            "                          00 %         05 %\n"
            "collide x          123 / 200!?  1.50 / 30.0\n"
            "distance y (path)            -        error\n"
            "\n"
            "! some answers were wrong   ? some queries gave no answer\n");
}

TEST(ResultsTable, ResponsesHaveTheirLargestTimeAndTheErrorOfTheirForce) {
  const std::string text = R"({"context": {}, "benchmarks": [
    {"name": "collide/algorithm:x/pair:p/volume:05", "run_type": "iteration", "cpu_time": 2500, "time_unit": "ns", "p99_ns": 40000},
    {"name": "respond/algorithm:x/pair:p/volume:05", "run_type": "iteration", "cpu_time": 2500, "time_unit": "ns", "p99_ns": 40000, "max_ns": 50000, "gamma_F_deg": 1.234, "gamma_max_F_deg": 20.25},
    {"name": "respond/algorithm:null/pair:p/volume:05", "run_type": "iteration", "cpu_time": 3, "time_unit": "ns", "p99_ns": 40, "max_ns": 40}]})";
  EXPECT_EQ(
      results_table(text, "r.json"),
      "p: mean / p99 in us, at overlaps in percent of A's volume\n"
      "                  05 %\n"
      "collide x  2.50 / 40.0\n"
      "\n"
      "p: mean / p99 / max in us, force's angle to the exact one mean / max in degrees, at overlaps in percent of "
      "A's volume\n"
      "                                         05 %\n"
      "respond x     2.50 / 40.0 / 50.0, 1.23 / 20.2\n"
      "respond null          0.0030 / 0.04 / 0.04, -\n"
      "\n"
      "! some answers were wrong   ? some queries gave no answer\n");
}

TEST(ResultsTable, RefusesOtherFiles) {
  for (const char* bad : {"", "[]", "{}", R"({"benchmarks": [{}]})"}) {
    EXPECT_THROW(results_table(bad, "r.json"), BadFile) << bad;
  }
}

}  // namespace
}  // namespace sixdof::cli
