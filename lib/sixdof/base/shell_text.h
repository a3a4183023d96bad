#pragma once

#include <string>

namespace sixdof {

/// A word as a POSIX shell takes it: unchanged, or in single quotes.
std::string shell_quoted(const std::string& word);

}  // namespace sixdof
