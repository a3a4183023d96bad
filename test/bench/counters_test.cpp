// Every counter of every family of rows is in the table of metrics.

#include <set>

#include <gmock/gmock.h>

#include <sixdof/measure/metrics.h>

#include "bench_program.h"

namespace sixdof {
namespace {

using test::BenchProgram;
using test::json;

/// Keys of a row in Google Benchmark's JSON that are no counters.
const std::set<std::string> k_no_counters{"name",        "family_index", "per_family_instance_index",
                                          "run_name",    "run_type",     "repetition_index",
                                          "repetitions", "threads",      "time_unit",
                                          "label"};

TEST_F(BenchProgram, EveryCounterIsInTheTableOfMetrics) {
  const json document = result(
      "--sample 32 -p ist:spheres=300 --benchmark_filter='"
      "^(prepare|collide|distance|respond)/.*/pair:torus-1k-cone-1k(/(distance:05|volume:03))?$|"
      "^scenario/(II|III)/algorithm:exact$|^kernel/(apart|map-in-cache)/algorithm:vps$|"
      "^generate/.*/pair:torus-1k-cone-1k$' --budget 10");
  std::set<std::string> families, counters;
  for (const json& entry : document.at("benchmarks")) {
    const std::string name = entry.at("name");
    EXPECT_FALSE(entry.contains("error_occurred")) << entry;
    families.insert(name.substr(0, name.find('/')));
    for (const auto& [key, value] : entry.items()) {
      if (k_no_counters.contains(key)) continue;
      counters.insert(key);
      EXPECT_NE(find_metric(key), nullptr) << key << " of " << name << " is not in lib/sixdof/measure/metrics.cpp";
    }
  }
  EXPECT_EQ(families,
            (std::set<std::string>{"prepare", "collide", "distance", "respond", "scenario", "kernel", "generate"}));
  for (const char* counter : {"p99_ns", "error_rms", "gamma_F_deg", "points_tested", "ns_per_points", "bytes",
                              "sigma_F_by_depth", "steps", "ns_per_configuration"}) {
    EXPECT_TRUE(counters.contains(counter)) << counter;
  }
}

}  // namespace
}  // namespace sixdof
