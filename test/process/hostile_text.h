#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>

#include <fmt/format.h>

/// Texts that a careless or hostile algorithm says. The same seed gives the same text.

namespace sixdof::test {

inline std::string hostile_text(std::uint64_t seed) {
  static constexpr std::array<std::string_view, 22> k_pieces{"no convergence",
                                                             "\x1B[31m",
                                                             "\x1B]0;title\x07",
                                                             "\n",
                                                             "\r",
                                                             "\t",
                                                             "\x7F",
                                                             "\xC2\x9B"
                                                             "2J",
                                                             "\xE2\x80\xAE",
                                                             "\xE2\x80\xA8",
                                                             "\xED\xA0\x80",
                                                             "\xC3",
                                                             "<script>",
                                                             "| a | b |",
                                                             "`",
                                                             "\"",
                                                             "\\",
                                                             "\\u001b",
                                                             "\\x1B[0m",
                                                             "T\xC3\xBCr",
                                                             "\xEF\xBB\xBF",
                                                             "%s%n"};
  std::mt19937_64 random(seed);
  std::string text;
  const std::uint64_t pieces = random() % 12;
  for (std::uint64_t i = 0; i < pieces; ++i) {
    const std::uint64_t pick = random();
    if (pick % 3 == 0) {
      text += static_cast<char>(static_cast<unsigned char>(pick >> 8));
    } else {
      text += k_pieces[(pick >> 8) % k_pieces.size()];
    }
  }
  if (seed % 50 == 0) text += std::string(static_cast<std::size_t>(random() % 100'000), 'w');
  return text;
}

/// The text as a string of JSON, as it is or with escapes, sometimes one that is half of a pair.
inline std::string as_json_string(std::string_view text, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::string json = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const std::uint64_t pick = random();
    if (pick % 40 == 0) json += fmt::format("\\u{:04x}", 0xD800 + (pick >> 8) % 0x800);
    if (pick % 40 == 1) json += fmt::format("\\u{:04x}", (pick >> 8) % 0x10000);
    if (c == '"' || c == '\\') {
      json += std::string("\\") + c;
    } else if (c == '\n' || (byte < 0x80 && pick % 3 == 0)) {
      json += fmt::format("\\u{:04x}", byte);
    } else {
      json += c;
    }
  }
  return json + "\"";
}

}  // namespace sixdof::test
