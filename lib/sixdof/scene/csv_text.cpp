#include <sixdof/scene/csv_text.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof::scene {
namespace {

constexpr std::string_view k_separators = ",;\t";

std::string_view name_of(char separator) {
  if (separator == ',') return "commas";
  return separator == ';' ? "semicolons" : "tabs";
}

/// A blank beside a cell. A tab may be a separator, which is looked for first.
bool is_blank(char c) { return c == ' ' || c == '\t'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace

CsvText::CsvText(std::filesystem::path file) : file_(std::move(file)) {
  std::ifstream in(file_, std::ios::binary);
  std::error_code ignored;
  if (!in || std::filesystem::is_directory(file_, ignored)) throw BadFile(file_.string(), "cannot be read");
  text_.assign(std::istreambuf_iterator<char>(in), {});
  if (in.bad()) throw BadFile(file_.string(), "cannot be read");
  rest_ = text_;
  for (const std::string_view mark : {std::string_view("\xFF\xFE"), std::string_view("\xFE\xFF")}) {
    if (rest_.starts_with(mark)) throw BadFile(file_.string(), "is text in UTF-16; save it as UTF-8");
  }
  if (constexpr std::string_view k_mark = "\xEF\xBB\xBF"; rest_.starts_with(k_mark)) rest_.remove_prefix(k_mark.size());
}

bool CsvText::next(Row& row) {
  while (!rest_.empty()) {
    const std::string_view line = next_line();
    const std::string_view text = trimmed(line);
    if (text.find_first_not_of(k_separators) == std::string_view::npos || text.front() == '#') continue;
    if (text.find('\0') != std::string_view::npos) refuse("has a byte 0, so it is no text");
    if (separator_ == '\0') {
      if (text.size() == 5 && text.starts_with("sep=") && k_separators.find(text.back()) != std::string_view::npos) {
        separator_ = text.back();
        continue;
      }
      find_separator(line);
    }
    row.line = line_;
    split(line, row.cells);
    return true;
  }
  return false;
}

void CsvText::refuse(const std::string& cause) const {
  throw BadFile(file_.string(), fmt::format("line {}", line_), cause);
}

std::string_view CsvText::next_line() {
  ++line_;
  const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
  const std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(end);
  if (rest_.starts_with("\r\n")) {
    rest_.remove_prefix(2);
  } else if (!rest_.empty()) {
    rest_.remove_prefix(1);
  }
  return line;
}

/// The names of columns have no separator in them, so that a separator in the first row is one.
void CsvText::find_separator(std::string_view line) {
  for (const char c : k_separators) {
    if (line.find(c) == std::string_view::npos) continue;
    if (separator_ != '\0') {
      refuse(fmt::format("columns are separated by {} and by {}; take one", name_of(separator_), name_of(c)));
    }
    separator_ = c;
  }
  if (separator_ == '\0') separator_ = ',';
}

void CsvText::split(std::string_view line, std::vector<std::string>& cells) const {
  cells.clear();
  for (bool has_more = true; has_more;) {
    while (!line.empty() && line.front() != separator_ && is_blank(line.front())) line.remove_prefix(1);
    std::string& cell = cells.emplace_back();
    const bool is_quoted = line.starts_with('"');
    if (is_quoted) {
      line.remove_prefix(1);
      for (;;) {
        const std::size_t quote = line.find('"');
        if (quote == std::string_view::npos) refuse("a quote does not end in its line");
        cell += line.substr(0, quote);
        line.remove_prefix(quote + 1);
        if (!line.starts_with('"')) break;
        line.remove_prefix(1);
        cell += '"';
      }
    }
    const std::size_t end = std::min(line.find(separator_), line.size());
    const std::string_view text = trimmed(line.substr(0, end));
    if (is_quoted && !text.empty()) refuse(fmt::format("text behind a quote: '{}'", text));
    if (!is_quoted) cell = text;
    has_more = end < line.size();
    line.remove_prefix(std::min(end + 1, line.size()));
  }
}

}  // namespace sixdof::scene
