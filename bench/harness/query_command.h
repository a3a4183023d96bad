#pragma once

#include <string>

#include <sixdof/query/algorithm.h>

namespace sixdof::bench {

/// `sixdof query --a A --b B --algorithm NAME` with the parameters that have not their default; empty for a program of
/// --external.
std::string query_command(const std::string& a, const std::string& b, const Algorithm& algorithm,
                          const Settings& settings);

}  // namespace sixdof::bench
