#include <sixdof/report/data_table.h>

#include <cmath>
#include <string_view>

#include <fmt/format.h>

namespace sixdof::report {
namespace {

std::string cell_text(const Cell& cell) {
  if (const auto* const number = std::get_if<double>(&cell)) {
    return std::isfinite(*number) ? number_text(*number) : std::string();
  }
  const auto* const text = std::get_if<std::string>(&cell);
  return text == nullptr ? std::string() : *text;
}

std::string csv_text(const Cell& cell) {
  std::string text = cell_text(cell);
  const bool is_text = std::holds_alternative<std::string>(cell);
  if (is_text && !text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos) {
    text.insert(text.begin(), '\'');
  }
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string markdown_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '<') {
      escaped += "&lt;";
    } else if (c == '&') {
      escaped += "&amp;";
    } else if (c == '\n' || c == '\r') {
      escaped += ' ';
    } else {
      if (std::string_view("|*\\_`[").find(c) != std::string_view::npos) escaped += '\\';
      escaped += c;
    }
  }
  return escaped;
}

}  // namespace

std::string number_text(double value) { return fmt::format("{:.6g}", value); }

std::string as_csv(const DataTable& table) {
  std::string text;
  for (const std::string& column : table.columns) text += (text.empty() ? "" : ",") + csv_text(column);
  text += "\r\n";
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i == 0 ? "" : ",") + csv_text(row[i]);
    text += "\r\n";
  }
  return text;
}

std::string as_markdown(const DataTable& table) {
  std::string text = "### " + markdown_text(table.title) + "\n\n|", rule = "|";
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const bool is_number = !table.rows.empty() && std::holds_alternative<double>(table.rows.front()[i]);
    text += " " + markdown_text(table.columns[i]) + " |";
    rule += is_number ? "---:|" : "---|";
  }
  text += "\n" + rule + "\n";
  for (const auto& row : table.rows) {
    text += "|";
    for (const Cell& cell : row) text += " " + markdown_text(cell_text(cell)) + " |";
    text += "\n";
  }
  return text;
}

}  // namespace sixdof::report
