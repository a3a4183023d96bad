#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <sixdof/report/data_table.h>
#include "../results/result_rows.h"

/// What stands in tables of results.

namespace sixdof::report::test {

using namespace results::test;

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
