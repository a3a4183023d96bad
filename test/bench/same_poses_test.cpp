// Rows that differ in the algorithm alone ask the same poses, however slow it is and however many it fails at.

#include <map>
#include <set>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "bench_program.h"

namespace sixdof {
namespace {

using test::json;

/// Poses by what rows have in common, and algorithm.
using Asked = std::map<std::string, std::map<std::string, std::set<std::string>>>;

struct SamePoses : test::BenchProgram {
  const std::string asked_file = (suite->directory() / "asked").string();

  json run(const std::string& arguments, const std::string& rows) const {
    std::filesystem::remove(asked_file);
    const auto done = test::run_program(
        fmt::format("SIXDOF_ASKED={} {}", asked_file,
                    command(fmt::format("{} '--benchmark_filter={}'", arguments, rows), RECORDING_PROGRAM)));
    EXPECT_EQ(done.exit_code, 0) << done.err;
    std::ifstream file(out);
    return json::parse(file);
  }

  Asked asked() const {
    Asked poses;
    std::ifstream file(asked_file);
    std::string algorithm, question, a, b, pose;
    while (file >> algorithm >> question >> a >> b >> pose) poses[question + " " + a + " " + b][algorithm].insert(pose);
    return poses;
  }

  /// Rows of one order of the poses: every algorithm was asked the same. @returns how many poses of each
  static void expect_equal_poses(const Asked& asked, std::size_t groups) {
    EXPECT_EQ(asked.size(), groups);
    for (const auto& [group, by_algorithm] : asked) {
      EXPECT_EQ(by_algorithm.size(), 3u) << group;
      for (const auto& [algorithm, poses] : by_algorithm) {
        EXPECT_EQ(poses, by_algorithm.at("records")) << group << ": " << algorithm;
      }
    }
  }

  /// Configurations of each row's group; expects them to be equal within one.
  static std::map<std::string, std::size_t> configurations(const json& document) {
    std::map<std::string, std::size_t> of_group;
    for (const json& entry : document.at("benchmarks")) {
      json group = entry.at("sixdof");
      for (const char* const key : {"algorithm", "settings", "configurations"}) group.erase(key);
      const std::size_t asked = entry.at("configurations");
      const auto [there, first] = of_group.emplace(group.dump(), asked);
      EXPECT_EQ(asked, there->second) << entry.at("name");
    }
    return of_group;
  }
};

constexpr const char* k_random = "^[a-z]+/algorithm:records.*/(distance|volume):[0-9]+$";
constexpr const char* k_path = "^[a-z]+/algorithm:records.*/order:path$";
constexpr const char* k_motion = "^[a-z]+/algorithm:records.*/order:motion$";
/// Two pairs with 3 buckets to collide and to respond, and 2 with distances.
constexpr std::size_t k_groups = 2 * (3 + 3 + 2);
/// As the poses tell them apart: two pairs, three questions.
constexpr std::size_t k_query_kinds = 2 * 3;

TEST_F(SamePoses, WithoutABudget) {
  for (const char* const rows : {k_random, k_path, k_motion}) {
    const json document = run("--sample 50 --benchmark_out=" + out.string(), rows);
    expect_equal_poses(asked(), k_query_kinds);
    const auto counts = configurations(document);
    EXPECT_EQ(counts.size(), k_groups);
    for (const auto& [group, count] : counts) EXPECT_EQ(count, 50u) << group;
  }
}

TEST_F(SamePoses, WithinABudgetThatTheSlowOneWouldExceed) {
  for (const char* const rows : {k_random, k_path, k_motion}) {
    const json document = run("--sample 0 --budget 1 --benchmark_out=" + out.string(), rows);
    expect_equal_poses(asked(), k_query_kinds);
    const auto counts = configurations(document);
    EXPECT_EQ(counts.size(), k_groups);
    for (const auto& [group, count] : counts) {
      EXPECT_GE(count, 32u) << group;
      EXPECT_LT(count, test::SmallSuite::k_configurations / 2) << group;
    }
  }
}

TEST_F(SamePoses, OnColdCaches) {
  const json document = run("--sample 4 --benchmark_out=" + out.string(),
                            "^collide/algorithm:records.*/pair:torus-1k/distance:05/cache:cold$");
  expect_equal_poses(asked(), 1);
  EXPECT_EQ(configurations(document).size(), 1u);
}

TEST_F(SamePoses, WhenARunIsContinuedWithoutItsBudget) {
  run("--budget 0.000001 --benchmark_out=" + out.string(), "^distance/algorithm:records/.*/distance:05$");
  const json document = run("--resume " + out.string(), "^distance/algorithm:records.*/distance:0[05]$");
  ASSERT_EQ(document.at("benchmarks").size(), 12u);
  for (const json& entry : document.at("benchmarks")) {
    const bool begun = entry.at("sixdof").at("bucket").at("percent") == 5;
    EXPECT_EQ(entry.at("configurations"), begun ? json(32) : entry.at("reachable")) << entry.at("name");
  }
}

}  // namespace
}  // namespace sixdof
