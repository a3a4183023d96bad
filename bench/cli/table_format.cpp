#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "bench/cli/table.h"

namespace sixdof::cli {
namespace {

/// Columns in which no line has anything are left out.
Sheet without_empty_columns(const Sheet& sheet) {
  Sheet kept = sheet;
  kept.columns.clear();
  for (auto& line : kept.lines) line.clear();
  for (std::size_t i = 0; i < sheet.columns.size(); ++i) {
    const auto is_empty = [i](const auto& line) { return line[i].empty() || line[i] == "-"; };
    if (std::ranges::all_of(sheet.lines, is_empty)) continue;
    kept.columns.push_back(sheet.columns[i]);
    for (std::size_t k = 0; k < sheet.lines.size(); ++k) kept.lines[k].push_back(sheet.lines[k][i]);
  }
  return kept;
}

constexpr const char* k_gap = "  ";

std::string trimmed(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

/// What titles and cells of each column need.
std::vector<std::size_t> own_widths(const Sheet& sheet) {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < sheet.columns.size(); ++i) {
    widths.push_back(sheet.columns[i].title.size());
    for (const auto& line : sheet.lines) widths[i] = std::max(widths[i], line[i].size());
  }
  return widths;
}

/// The groups' names, each over its columns; the last column of a group is widened where its name is longer than they.
std::string group_line(const Sheet& sheet, std::vector<std::size_t>& widths) {
  std::string text;
  for (std::size_t i = 0; i < widths.size();) {
    const std::string& group = sheet.columns[i].group;
    std::size_t width = widths[i], next = i + 1;
    for (; !group.empty() && next < widths.size() && sheet.columns[next].group == group; ++next) {
      width += std::string_view(k_gap).size() + widths[next];
    }
    if (group.size() > width) {
      widths[next - 1] += group.size() - width;
      width = group.size();
    }
    text += fmt::format("{:>{}}{}", group, width, k_gap);
    i = next;
  }
  return trimmed(text);
}

std::string aligned(const std::vector<std::string>& cells, const Sheet& sheet, const std::vector<std::size_t>& widths) {
  std::string text;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    text += sheet.columns[i].left ? fmt::format("{:<{}}{}", cells[i], widths[i], k_gap)
                                  : fmt::format("{:>{}}{}", cells[i], widths[i], k_gap);
  }
  return trimmed(text);
}

/// As Markdown shows it: characters that begin something there, also HTML, are escaped.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::string_view("|*\\_`[<>&#~").find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
}

}  // namespace

std::string as_text(const Sheet& full) {
  const Sheet sheet = without_empty_columns(full);
  std::vector<std::size_t> widths = own_widths(sheet);
  const std::string groups = group_line(sheet, widths);  // before the others: it may widen columns
  std::vector<std::string> titles;
  for (const Sheet::Column& column : sheet.columns) titles.push_back(column.title);
  std::string text = sheet.title + "\n";
  if (!groups.empty()) text += groups + "\n";
  text += aligned(titles, sheet, widths) + "\n";
  for (const auto& line : sheet.lines) text += aligned(line, sheet, widths) + "\n";
  return text + lines_as_text(sheet.notes);
}

std::string as_markdown(const Sheet& full) {
  const Sheet sheet = without_empty_columns(full);
  std::string text = "### " + escaped(sheet.title) + "\n\n|", rule = "|";
  for (const auto& [group, title, left] : sheet.columns) {
    text += fmt::format(" {}{}{} |", escaped(group), group.empty() || title.empty() ? "" : ": ", escaped(title));
    rule += left ? "---|" : "---:|";
  }
  text += "\n" + rule + "\n";
  for (const auto& line : sheet.lines) {
    text += "|";
    for (const std::string& cell : line) text += fmt::format(" {} |", escaped(cell));
    text += "\n";
  }
  return sheet.notes.empty() ? text : text + "\n" + lines_as_markdown(sheet.notes);
}

std::string lines_as_text(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

std::string lines_as_markdown(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += fmt::format("- {}\n", escaped(line));
  return text;
}

}  // namespace sixdof::cli
