#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sixdof {

/// The message for a word of a command line that is not known: "--gird: no such option; did you mean --grid?".
/// @param word as typed; a word that begins with '-' is an option, and what follows '=' is left out
/// @param names of the options (without dashes) or commands that there are
/// @param help the command line that lists them, for a word that is like none of them
std::string explain_unknown_word(std::string_view word, const std::vector<std::string>& names, std::string_view help);

}  // namespace sixdof
