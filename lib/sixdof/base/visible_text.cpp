#include <sixdof/base/visible_text.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace sixdof {
namespace {

/// Code points that do not show, or change how their neighbours do, in order.
constexpr std::pair<char32_t, char32_t> k_unseen[] = {
    {0x00, 0x1F},        // C0
    {0x7F, 0xA0},        // DEL, C1, no-break space
    {0xAD, 0xAD},        // soft hyphen
    {0x34F, 0x34F},      // grapheme joiner
    {0x61C, 0x61C},      // a mark of direction
    {0x115F, 0x1160},    // Hangul fillers
    {0x1680, 0x1680},    // a space
    {0x17B4, 0x17B5},    // vowels that do not show
    {0x180B, 0x180F},    // Mongolian selectors and separator
    {0x2000, 0x200F},    // spaces, joiners, marks of direction
    {0x2028, 0x202F},    // line and paragraph separators, embeddings and overrides of direction
    {0x205F, 0x206F},    // spaces, operators that do not show, isolates of direction
    {0x3164, 0x3164},    // Hangul filler
    {0xFDD0, 0xFDEF},    // no characters
    {0xFE00, 0xFE0F},    // variation selectors
    {0xFEFF, 0xFEFF},    // byte order mark
    {0xFFA0, 0xFFA0},    // Hangul filler
    {0xFFF0, 0xFFFB},    // annotations
    {0xFFFE, 0xFFFF},    // no characters
    {0x1BCA0, 0x1BCA3},  // shorthand controls
    {0x1D173, 0x1D17A},  // musical controls
    {0xE0000, 0x10FFFF}  // tags, selectors, private planes
};

bool shows(char32_t c) {
  const auto* const range = std::ranges::lower_bound(k_unseen, c, {}, &std::pair<char32_t, char32_t>::second);
  return range == std::end(k_unseen) || c < range->first;
}

bool continues(char byte) { return (static_cast<unsigned char>(byte) & 0xC0u) == 0x80u; }

struct Character {
  std::size_t bytes = 1;
  bool shows = false;  ///< Not so for a byte that begins no character of UTF-8.
};

/// The first one of a text that is not empty.
Character first_character(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  if (lead < 0x80) return {1, shows(lead)};
  const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < bytes) return {};
  char32_t code = lead & (0xFFu >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if (!continues(text[i])) return {};
    code = (code << 6) | (static_cast<unsigned char>(text[i]) & 0x3Fu);
  }
  constexpr std::array<char32_t, 5> k_least{0, 0, 0x80, 0x800, 0x10000};
  if (code < k_least[bytes] || (code >= 0xD800 && code <= 0xDFFF) || code > 0x10FFFF) return {};
  return {bytes, shows(code)};
}

/// Each byte as \xHH behind `escape`.
void append_hex(std::string& to, std::string_view escape, std::string_view bytes) {
  for (const char c : bytes) fmt::format_to(std::back_inserter(to), "{}x{:02X}", escape, static_cast<unsigned char>(c));
}

/// What `text` begins with becomes visible at the end of `to`. @returns the bytes that it had
std::size_t append_visible(std::string& to, std::string_view escape, std::string_view text) {
  const Character first = first_character(text);
  const std::string_view bytes = text.substr(0, first.bytes);
  first.shows ? static_cast<void>(to.append(bytes)) : append_hex(to, escape, bytes);
  return bytes.size();
}

/// The text up to `bytes`, or a little less where a character would be cut.
std::string_view begin_of(std::string_view text, std::size_t bytes) {
  constexpr std::size_t k_most_continuations = 3;
  if (bytes >= text.size()) return text;
  std::size_t end = bytes;
  while (end > 0 && bytes - end < k_most_continuations && continues(text[end])) --end;
  return text.substr(0, end);
}

std::string utf8_of(char32_t code) {
  const auto byte = [](char32_t value) { return static_cast<char>(static_cast<unsigned char>(value)); };
  const auto rest = [&](unsigned shift, char32_t code_point) { return byte(0x80 | ((code_point >> shift) & 0x3F)); };
  if (code < 0x80) return {byte(code)};
  if (code < 0x800) return {byte(0xC0 | (code >> 6)), rest(0, code)};
  if (code < 0x10000) return {byte(0xE0 | (code >> 12)), rest(6, code), rest(0, code)};
  return {byte(0xF0 | (code >> 18)), rest(12, code), rest(6, code), rest(0, code)};
}

/// The number of \uHHHH at the beginning of a text.
std::optional<char32_t> unit_of(std::string_view text) {
  constexpr std::size_t k_length = 6;
  if (text.size() < k_length || !text.starts_with("\\u")) return std::nullopt;
  unsigned unit = 0;
  const char* const end = text.data() + k_length;
  const auto [stop, error] = std::from_chars(text.data() + 2, end, unit, 16);
  return error == std::errc() && stop == end ? std::optional<char32_t>(unit) : std::nullopt;
}

/// The same for an escape of JSON. @returns the bytes that it had
std::size_t append_visible_escape(std::string& to, std::string_view text) {
  constexpr std::string_view k_letters = "bfnrt", k_controls = "\b\f\n\r\t", k_escape = "\\\\";
  constexpr std::size_t k_unit = 6;
  const std::size_t letter = text.size() < 2 ? std::string_view::npos : k_letters.find(text[1]);
  if (letter != std::string_view::npos) {
    append_hex(to, k_escape, k_controls.substr(letter, 1));
    return 2;
  }
  const auto unit = unit_of(text);
  if (!unit) {
    to.append(text.substr(0, 2));
    return std::min<std::size_t>(2, text.size());
  }
  char32_t code = *unit;
  std::size_t length = k_unit;
  if (code >= 0xD800 && code <= 0xDBFF) {
    const auto low = unit_of(text.substr(k_unit));
    if (low && *low >= 0xDC00 && *low <= 0xDFFF) {
      code = 0x10000 + ((code - 0xD800) << 10) + (*low - 0xDC00);
      length = 2 * k_unit;
    }
  }
  if (code >= 0xD800 && code <= 0xDFFF) {
    fmt::format_to(std::back_inserter(to), "{}u{:04X}", k_escape, static_cast<unsigned>(code));
  } else if (shows(code)) {
    to.append(text.substr(0, length));
  } else {
    append_hex(to, k_escape, utf8_of(code));
  }
  return length;
}

}  // namespace

std::string visible_text(std::string_view text, std::size_t longest) {
  std::string result;
  for (std::string_view rest = begin_of(text, longest); !rest.empty();) {
    rest.remove_prefix(append_visible(result, "\\", rest));
  }
  if (text.size() > longest) result += "...";
  return result;
}

std::string visible_words(std::string_view text) {
  constexpr std::string_view k_cut = "...";
  std::string words = visible_text(begin_of(text, k_longest_words), k_any_length);
  if (text.size() <= k_longest_words && words.size() <= k_longest_words) return words;
  words.resize(begin_of(words, k_longest_words - k_cut.size()).size());
  return words.append(k_cut);
}

std::string visible_json(std::string_view json) {
  const auto is_plain = [](char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; };
  std::string result;
  result.reserve(json.size());
  for (bool in_string = false; !json.empty();) {
    std::size_t taken = 1;
    if (is_plain(json.front()) || (!in_string && json.front() != '"')) {
      taken = static_cast<std::size_t>(std::ranges::find_if_not(json.substr(1), is_plain) - json.begin());
      result.append(json.substr(0, taken));
    } else if (json.front() == '"') {
      in_string = !in_string;
      result += '"';
    } else if (json.front() == '\\') {
      taken = append_visible_escape(result, json);
    } else {
      taken = append_visible(result, "\\\\", json);
    }
    json.remove_prefix(taken);
  }
  return result;
}

}  // namespace sixdof
