#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sixdof {

/// The command line by which this program serves one of its algorithms to another process of itself (process/serve.h).
std::vector<std::string> serving_command(const std::string& algorithm);

/// Serves if the command line is serving_command(). @returns the exit code; nothing for another command line
std::optional<int> serve_if_asked(int argc, const char* const* argv);

}  // namespace sixdof
