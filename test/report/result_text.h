#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <sixdof/report/data_table.h>
#include <sixdof/report/results.h>

/// Result files made here, as the programs write them.

namespace sixdof::report::test {

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

/// The cell of a line in the named column.
inline const Cell& cell(const DataTable& table, const std::vector<Cell>& line, const std::string& column) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), column);
  if (found == table.columns.end()) throw std::out_of_range(column);
  return line.at(static_cast<std::size_t>(found - table.columns.begin()));
}

inline std::string text_in(const DataTable& table, const std::vector<Cell>& line, const std::string& column) {
  return std::get<std::string>(cell(table, line, column));
}

inline double number_in(const DataTable& table, const std::vector<Cell>& line, const std::string& column) {
  return std::get<double>(cell(table, line, column));
}

/// Lines of a table in which the given columns have the given texts.
inline std::vector<std::vector<Cell>> lines_with(const DataTable& table,
                                                 const std::vector<std::pair<std::string, std::string>>& wanted) {
  std::vector<std::vector<Cell>> lines;
  for (const auto& line : table.rows) {
    const bool fits = std::all_of(wanted.begin(), wanted.end(), [&](const auto& want) {
      const auto* const text = std::get_if<std::string>(&cell(table, line, want.first));
      return text != nullptr && *text == want.second;
    });
    if (fits) lines.push_back(line);
  }
  return lines;
}

}  // namespace sixdof::report::test
