#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Text that comes from outside of a program - names, words of failures, versions - is made visible where it enters:
/// then no message, table or result can hold a character that a terminal obeys, that turns the direction of the line
/// or that nobody sees.

namespace sixdof {

inline constexpr std::size_t k_any_length = std::string_view::npos;

/// Most bytes of words that another program or library says, by visible_words().
inline constexpr std::size_t k_longest_words = 500;

/// Every character that prints stays, in any language (UTF-8). Of all others each byte becomes \xHH: control characters
/// and line breaks (C0, DEL, C1, U+2028), marks of direction, spaces and joiners that do not show, what is no character
/// and bytes that are no UTF-8. Text of more than `longest` bytes is cut at its end, which becomes "...".
std::string visible_text(std::string_view text, std::size_t longest = 40);

/// Words of a failure or a description, visible, of k_longest_words bytes at most: the beginning of longer ones. What
/// comes out does not change by another call.
std::string visible_words(std::string_view text);

/// JSON as text whose strings and keys are visible as by visible_text(), whatever stood there: a control character, as
/// it is or as the escape \u001B, becomes the text \x1B, half of a surrogate pair \uD800, a byte that is no UTF-8 \xFF.
/// What is outside of strings stays.
std::string visible_json(std::string_view json);

}  // namespace sixdof
