#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "../cli/run_program.h"
#include "../configuration/small_suite.h"

namespace sixdof::test {

using nlohmann::json;

/// The shortest time that gives a row: one round over the bucket.
inline constexpr const char* k_quick = " --benchmark_min_time=0.000001";

struct BenchProgram : ::testing::Test {
  /// A copy, which a test may change.
  const std::unique_ptr<SuiteCopy> suite = std::make_unique<SuiteCopy>(SIXDOF_SMALL_SUITE);
  const std::filesystem::path out = suite->directory() / "out.json";

  std::string command(const std::string& arguments, const char* program = SIXDOF_BENCH_PROGRAM) const {
    return std::string(program) + " --manifest " + suite->manifest().string() + k_quick + " " + arguments;
  }
  ProgramResult bench(const std::string& arguments) const { return run_program(command(arguments)); }
  json result(const std::string& arguments, int exit_code = 0) const {
    const auto run = bench(arguments + " --benchmark_out=" + out.string());
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    std::ifstream file(out);
    return json::parse(file);
  }
  bool any_partial_file() const {
    for (const auto& entry : std::filesystem::directory_iterator(suite->directory())) {
      if (entry.path().extension() == ".partial") return true;
    }
    return false;
  }
};

inline json row(const json& document, const std::string& name) {
  for (const json& entry : document.at("benchmarks")) {
    if (entry.at("name") == name) return entry;
  }
  ADD_FAILURE() << name << " is missing";
  return {};
}

}  // namespace sixdof::test
