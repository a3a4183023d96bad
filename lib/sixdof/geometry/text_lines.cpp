#include <sixdof/geometry/text_lines.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace sixdof::loading {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

/// A word for a message: printable and short.
std::string shown(std::string_view word) {
  constexpr std::size_t k_longest = 40;
  std::string result;
  for (const char c : word.substr(0, k_longest)) result += c >= ' ' && c <= '~' ? c : '?';
  if (word.size() > k_longest) result += "...";
  return result;
}

/// Text files may write a leading plus sign, which from_chars does not read.
std::string_view without_plus(std::string_view word) {
  return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

}  // namespace

std::size_t text_begin(std::string_view bytes) {
  constexpr std::string_view k_byte_order_mark = "\xEF\xBB\xBF";
  return bytes.starts_with(k_byte_order_mark) ? k_byte_order_mark.size() : 0;
}

TextLines::TextLines(const Source& source, Syntax syntax, std::size_t begin, std::size_t line)
    : source_(source),
      text_(source.bytes),
      syntax_(syntax),
      next_(std::max(begin, text_begin(source.bytes))),
      line_(line),
      next_line_(line) {}

bool TextLines::next() {
  words_.clear();
  while (next_ < text_.size()) {
    line_ = next_line_;
    while (read_line()) {
    }
    if (!words_.empty()) return true;
  }
  line_ = next_line_;
  return false;
}

/// Adds one line's words; true if the next line continues it.
bool TextLines::read_line() {
  const std::size_t newline = text_.find('\n', next_);
  const bool ended = newline != std::string_view::npos;
  std::string_view line = text_.substr(next_, (ended ? newline : text_.size()) - next_);
  next_ = ended ? newline + 1 : text_.size();
  ++next_line_;
  if (syntax_.comment != '\0') line = line.substr(0, line.find(syntax_.comment));
  while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
  const bool continues = syntax_.continuation && ended && !line.empty() && line.back() == '\\';
  if (continues) line.remove_suffix(1);
  for (std::size_t i = 0; i < line.size();) {
    if (is_blank(line[i])) {
      ++i;
      continue;
    }
    const std::size_t begin = i;
    while (i < line.size() && !is_blank(line[i])) ++i;
    words_.push_back(line.substr(begin, i - begin));
  }
  if (!ended && !words_.empty() && syntax_.newline_at_end) {
    fail("the last line is not ended by a line break; the file may be cut off");
  }
  return continues;
}

double TextLines::number(std::size_t i) const {
  if (i >= words_.size()) fail(fmt::format("{} values where at least {} are needed", words_.size(), i + 1));
  const std::string_view word = without_plus(words_[i]);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc::result_out_of_range) {
    fail(fmt::format("'{}' is outside the range of double precision", shown(word)));
  }
  if (error != std::errc() || end != word.data() + word.size()) {
    fail(fmt::format("'{}' is not a number", shown(word)));
  }
  if (!std::isfinite(value)) fail(fmt::format("'{}' is not finite", shown(word)));
  return value;
}

std::int64_t TextLines::integer(std::string_view original) const {
  const std::string_view word = without_plus(original);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc::result_out_of_range) fail(fmt::format("'{}' is out of range", shown(word)));
  if (error != std::errc() || end != word.data() + word.size()) {
    fail(fmt::format("'{}' is not an integer", shown(word)));
  }
  return value;
}

std::uint32_t TextLines::index(std::size_t i, std::size_t count) const {
  if (i >= words_.size()) fail(fmt::format("{} values where at least {} are needed", words_.size(), i + 1));
  const std::int64_t value = integer(i);
  if (value < 0 || static_cast<std::uint64_t>(value) >= count) {
    fail(fmt::format("vertex index {} of {}", value, count));
  }
  return static_cast<std::uint32_t>(value);
}

std::string TextLines::place() const { return fmt::format("line {}", line_); }

void TextLines::fail(const std::string& cause) const { source_.fail(place(), cause); }

void TextLines::expect_end() {
  if (next()) fail(fmt::format("'{}' behind the last element", shown(words_[0])));
}

}  // namespace sixdof::loading
