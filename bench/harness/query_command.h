#pragma once

#include <string>

#include <sixdof/query/algorithm.h>

namespace sixdof::bench {

/// `sixdof query --a A --b B --algorithm NAME` with the parameters that have not their default and process_option(),
/// with the name of this program's sibling (base/own_command.h).
std::string query_command(const std::string& a, const std::string& b, const Algorithm& algorithm,
                          const Settings& settings);

/// " --external NAME=COMMAND" for an algorithm of --external, " --isolate" for one of this program in processes of its
/// own, nothing for a rival, which every program finds; with those of its limits that are not usual; for a shell. Empty
/// for an algorithm in this process.
std::string process_option(const Algorithm& algorithm);

}  // namespace sixdof::bench
