#pragma once

#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof::cli {

using Json = nlohmann::ordered_json;

/// A row of pair "p" as sixdof-bench writes it, of 64 configurations and with a right answer to each.
inline Json row(const std::string& query, const std::string& algorithm, const std::string& kind, double percent,
                double cpu_ns, const Json& values = Json::object()) {
  Json json = {{"name", fmt::format("{}/algorithm:{}/pair:p/{}:{}", query, algorithm, kind, percent)},
               {"run_type", "iteration"},
               {"cpu_time", cpu_ns},
               {"real_time", 2 * cpu_ns},
               {"time_unit", "ns"},
               {"configurations", 64},
               {"judged", 64},
               {"failed", 0},
               {"mismatch", 0},
               {"p50_ns", 1e4},
               {"p99_ns", 2e4},
               {"max_ns", 3e4},
               {"over_1ms", 0.0}};
  json.update(values);
  json["sixdof"] = {{"query", query},
                    {"algorithm", algorithm},
                    {"settings", {{"size", 0.5}}},
                    {"pair", "p"},
                    {"bucket", {{"kind", kind}, {"percent", percent}}},
                    {"order", "random"}};
  return json;
}

inline Json failed_row(const std::string& query, const std::string& algorithm, const std::string& kind,
                       double percent) {
  Json json = row(query, algorithm, kind, percent, 0.0);
  json.update({{"error_occurred", true}, {"error_message", "no such model"}});
  return json;
}

/// `sixdof table` on files that a test writes.
class TableCommand : public test::ScratchFolder {
 protected:
  std::string write_text(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }
  std::string write(const std::string& name, const std::vector<Json>& rows,
                    const Json& context = Json::object()) const {
    return write_text(name, Json({{"context", context}, {"benchmarks", rows}}).dump());
  }
  static test::ProgramResult table(const std::string& arguments) {
    return test::run_program(std::string(SIXDOF_PROGRAM) + " table " + arguments);
  }
  static std::string printed(const std::string& arguments) {
    const auto result = table(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  }
};

}  // namespace sixdof::cli
