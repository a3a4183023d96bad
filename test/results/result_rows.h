#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <sixdof/results/results.h>

/// Result files made here, as the programs write them.

namespace sixdof::results::test {

using Json = nlohmann::ordered_json;

/// A row of a query on a bucket, of 64 configurations with a right answer to each.
inline Json row(const std::string& query, const std::string& algorithm, const std::string& pair,
                const std::string& kind, double percent, double cpu_ns, const Json& values = Json::object()) {
  Json json = {
      {"name", query + "/algorithm:" + algorithm + "/pair:" + pair + "/" + kind + ":" + std::to_string(percent)},
      {"run_type", "iteration"},
      {"cpu_time", cpu_ns},
      {"real_time", 2.0 * cpu_ns},
      {"time_unit", "ns"},
      {"configurations", 64},
      {"judged", 64},
      {"failed", 0},
      {"mismatch", 0},
      {"p50_ns", 0.9 * cpu_ns},
      {"max_ns", 9.0 * cpu_ns}};
  json.update(values);
  json["sixdof"] = {
      {"query", query},    {"algorithm", algorithm}, {"settings", {{"size", 0.5}, {"culling", "on"}}},  {"pair", pair},
      {"order", "random"}, {"cache", "warm"},        {"bucket", {{"kind", kind}, {"percent", percent}}}};
  return json;
}

inline std::string file_of(const std::vector<Json>& rows, const Json& context = Json::object()) {
  return Json{{"context", context}, {"benchmarks", rows}}.dump();
}

inline Results results_of(const std::vector<Json>& rows, const Json& context = Json::object()) {
  Results results;
  parse_results(file_of(rows, context), "results/run.json", results);
  return results;
}

/// Outliers of a row on torus-1k, at x = 0.5 or as given.
inline Json outliers(const std::string& counter, const std::string& pose = "0.5 0 0 1 0 0 0") {
  return {{"a", "torus-1k"},
          {"b", "torus-1k"},
          {"command", "sixdof query --a torus-1k --b torus-1k --algorithm exact"},
          {"poses", {{counter, pose}}}};
}

}  // namespace sixdof::results::test
