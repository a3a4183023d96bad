#pragma once

#include <string>
#include <variant>
#include <vector>

namespace sixdof::report {

/// A cell of a table: nothing, a text, or a number. A number that is not finite counts as nothing.
using Cell = std::variant<std::monostate, std::string, double>;

/// A table that figures of the report draw, and that is written as CSV or Markdown.
struct DataTable {
  std::string name;                  ///< In figures and as the stem of files: "times".
  std::string title;                 ///< One line.
  std::vector<std::string> columns;  ///< Names with their unit: "time_us".
  std::vector<std::vector<Cell>> rows;
};

/// RFC 4180: quotes where a text has a comma, a quote or a line break; numbers with six significant digits. A text that
/// a spreadsheet would take for a formula (=, +, -, @ first) gets a quote ' before it.
std::string as_csv(const DataTable& table);

/// A Markdown table under its title. Characters that mean something in Markdown or HTML are escaped.
std::string as_markdown(const DataTable& table);

/// Six significant digits.
std::string number_text(double value);

}  // namespace sixdof::report
