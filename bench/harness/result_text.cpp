#include "bench/harness/result_text.h"

#include <algorithm>
#include <map>
#include <vector>

#include "bench/common/json_text.h"
#include "bench/harness/result_checksums.h"

namespace sixdof::bench {
namespace {

using Json = nlohmann::ordered_json;

/// The values of one row by column. Appends columns that are new.
std::map<std::string, std::string> cells_of(const Json& row, const std::string& prefix,
                                            std::vector<std::string>& columns) {
  std::map<std::string, std::string> cells;
  for (const auto& [key, value] : row.items()) {
    const std::string column = prefix + key;
    if (value.is_object()) {
      cells.merge(cells_of(value, column + ".", columns));
      continue;
    }
    if (std::ranges::find(columns, column) == columns.end()) columns.push_back(column);
    cells[column] = value.is_null() ? "" : value.is_string() ? value.get<std::string>() : json_text(value, -1);
  }
  return cells;
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + "\"";
}

std::string csv(const Json& rows) {
  std::vector<std::string> columns;
  std::vector<std::map<std::string, std::string>> lines;
  for (const Json& row : rows) lines.push_back(cells_of(row, "", columns));
  std::string text;
  const auto add_line = [&](const auto& cell_of) {
    for (std::size_t i = 0; i < columns.size(); ++i) text += (i == 0 ? "" : ",") + quoted(cell_of(columns[i]));
    text += "\n";
  };
  add_line([](const std::string& column) { return column; });
  for (auto& line : lines) add_line([&](const std::string& column) { return line[column]; });
  return text;
}

}  // namespace

std::string result_text(Json document, ResultFormat format) {
  if (format == ResultFormat::csv) return csv(document.at("benchmarks"));
  add_checksums(document);
  return json_text(document) + "\n";
}

}  // namespace sixdof::bench
