#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sixdof {

/// Those of `names` that are similar to `word`, nearest first: within three edits (swapped neighbours are one) and
/// about a third of the word's length, or one contains the other.
std::vector<std::string> suggestions(std::string_view word, const std::vector<std::string>& names);

}  // namespace sixdof
