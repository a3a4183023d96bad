#pragma once

#include <string>

#include <sixdof/query/algorithm.h>

namespace sixdof::bench {

/// `sixdof query --a A --b B --algorithm NAME` with the parameters that have not their default.
std::string query_command(const std::string& a, const std::string& b, const Algorithm& algorithm,
                          const Settings& settings);

/// " --external NAME=COMMAND" for an algorithm of --external, for a shell; empty for others, which every program finds.
std::string external_option(const Algorithm& algorithm);

}  // namespace sixdof::bench
