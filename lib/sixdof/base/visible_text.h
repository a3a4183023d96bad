#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Text from outside of the program (names, messages, versions) is escaped where it enters: then no message, table or
/// result holds a control character, a character that changes the direction of the line, or an invisible one.

namespace sixdof {

inline constexpr std::size_t k_any_length = std::string_view::npos;

/// Most bytes of words that another program or library says, by visible_words().
inline constexpr std::size_t k_longest_words = 500;

/// Printable characters stay, in any language (UTF-8). Of all others each byte becomes \xHH: control characters and
/// line breaks (C0, DEL, C1, U+2028), direction marks, invisible spaces and joiners, unassigned code points and invalid
/// UTF-8. Text of more than `longest` bytes is cut, and "..." added.
std::string visible_text(std::string_view text, std::size_t longest = 40);

/// visible_text() of the words of a failure or a description, cut at k_longest_words bytes. Applying it twice gives the
/// same text.
std::string visible_words(std::string_view text);

/// JSON as text whose strings and keys are visible as by visible_text(), whatever stood there: a control character, as
/// it is or as the escape \u001B, becomes the text \x1B, half of a surrogate pair \uD800, a byte that is no UTF-8 \xFF.
/// What is outside of strings stays.
std::string visible_json(std::string_view json);

}  // namespace sixdof
