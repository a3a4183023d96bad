// Every counter of every family of rows is in the table of metrics.

#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <sixdof/measure/metrics.h>

#include "bench_program.h"

namespace sixdof {
namespace {

using test::BenchProgram;
using test::json;
using ::testing::HasSubstr;

/// Keys of a row in Google Benchmark's JSON that are no counters.
const std::set<std::string> k_no_counters{"outliers",
                                          "name",
                                          "family_index",
                                          "per_family_instance_index",
                                          "run_name",
                                          "run_type",
                                          "repetition_index",
                                          "repetitions",
                                          "threads",
                                          "time_unit",
                                          "label",
                                          "sixdof"};

/// The fields of a row say what its name says.
void expect_fields_of_the_name(const json& entry) {
  const std::string name = entry.at("name");
  const json& fields = entry.at("sixdof");
  EXPECT_EQ(fields.at("query"), name.substr(0, name.find('/')));
  EXPECT_TRUE(fields.at("settings").is_object()) << name;
  const std::string algorithm = fields.at("algorithm");
  EXPECT_THAT(name, HasSubstr("/algorithm:" + algorithm));
  if (algorithm == "ist") {
    EXPECT_EQ(fields.at("settings").at("spheres"), 300) << name;
  }
  for (const char* key : {"pair", "scenario", "target"}) {
    EXPECT_THAT(name, HasSubstr(fields.value(key, std::string())));
  }
  const std::string query = fields.at("query");
  EXPECT_EQ(fields.contains("scenario"), query == "scenario" || query == "scene" || query == "deform") << name;
  EXPECT_EQ(fields.contains("target"), query == "generate") << name;
  EXPECT_EQ(fields.contains("pair"), name.find("/pair:") != std::string::npos) << name;
  const bool has_bucket = name.find("/distance:") != std::string::npos || name.find("/volume:") != std::string::npos;
  ASSERT_EQ(fields.contains("bucket"), has_bucket) << name;
  if (has_bucket) {
    const json& bucket = fields.at("bucket");
    EXPECT_THAT(name, HasSubstr(fmt::format("/{}:{:02}", bucket.at("kind").get<std::string>(),
                                            bucket.at("percent").get<int>())));
    EXPECT_EQ(fields.at("configurations"), entry.at("configurations")) << name;
    EXPECT_EQ(fields.at("order"), "random") << name;
    EXPECT_EQ(fields.at("cache"), name.ends_with("/cache:cold") ? "cold" : "warm") << name;
  }
}

TEST_F(BenchProgram, EveryCounterIsInTheTableOfMetrics) {
  const json document = result(
      "--sample 32 -p ist:spheres=300 -p ist-descent:spheres=300 "
      "-p exact-depth:tolerance=0.02 --benchmark_filter='"
      "^(prepare|collide|distance|respond)/.*/pair:torus-1k-cone-1k(/(distance:05|volume:03))?$|"
      "^collide/algorithm:exact/pair:torus-1k-cone-1k/distance:05/cache:cold$|"
      "^scenario/(II|III)/algorithm:exact$|^scene/cube/n:100/question:near/algorithm:exact$|"
      "^deform/bump/amplitude:1/question:touching/algorithm:exact$|"
      "^generate/.*/pair:torus-1k-cone-1k$' --budget 10");
  std::set<std::string> families, counters;
  for (const json& entry : document.at("benchmarks")) {
    const std::string name = entry.at("name");
    EXPECT_FALSE(entry.contains("error_occurred")) << entry;
    families.insert(name.substr(0, name.find('/')));
    expect_fields_of_the_name(entry);
    for (const auto& [key, value] : entry.items()) {
      if (k_no_counters.contains(key) || key == "checksum") continue;
      counters.insert(key);
      EXPECT_NE(find_metric(key), nullptr) << key << " of " << name << " is not in lib/sixdof/measure/metrics.cpp";
    }
  }
  EXPECT_EQ(families, (std::set<std::string>{"prepare", "collide", "distance", "respond", "scenario", "scene", "deform",
                                             "generate"}));
  for (const char* counter : {"max_least_ns", "error_rms", "gamma_F_deg", "magnitude_error_F", "gain_T",
                              "points_tested", "ns_per_points", "bytes", "sigma_F_by_depth", "steps",
                              "ns_per_configuration", "missed_pairs", "pairs_put_off", "update_ns", "amplitude"}) {
    EXPECT_TRUE(counters.contains(counter)) << counter;
  }
}

TEST_F(BenchProgram, TimesAsManyQueriesAsAskedInWholeSamples) {
  const char* const filter = "--sample 32 '--benchmark_filter=^collide/algorithm:exact/pair:torus-1k/volume:03$' ";
  for (const auto& [asked, timed] : {std::pair(1, 32), {32, 32}, {33, 64}, {512, 512}}) {
    const json document = result(filter + fmt::format("--iterations {}", asked));
    ASSERT_EQ(document.at("benchmarks").size(), 1u);
    EXPECT_EQ(document.at("benchmarks").at(0).at("iterations"), timed) << asked;
    EXPECT_THAT(document.at("context").at("benchmark_flags").get<std::string>(),
                HasSubstr(fmt::format("--iterations={}", asked)));
  }
  for (const char* const bad : {"-1", "1e30", "some"}) {
    const auto run = bench(filter + fmt::format("--iterations {}", bad));
    EXPECT_NE(run.exit_code, 0) << bad;
    EXPECT_THAT(run.err, HasSubstr("--iterations"));
  }
}

}  // namespace
}  // namespace sixdof
