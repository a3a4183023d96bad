#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sixdof {

/// Number of letters to insert, delete or exchange that turn one word into the other (Levenshtein).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// Those of `names` that a mistyped `word` may have meant, nearest first: at most three edits and about a third of the
/// word away, or one containing the other.
std::vector<std::string> suggestions(std::string_view word, const std::vector<std::string>& names);

}  // namespace sixdof
