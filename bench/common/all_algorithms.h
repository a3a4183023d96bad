#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <sixdof/query/registry.h>
#include "bench/common/process_options.h"

namespace sixdof {

/// Adds every algorithm that this program has: the core's own, then those of each backend that was built, then those of
/// every Registrar, then the rivals that are set up (rivals.h), then those of --external, which come instead of rivals
/// of the same names. Each is isolated as the options say (process/remote_algorithm.h); those of backends and
/// Registrars are third-party. A rival that cannot be used costs a warning on stderr.
/// @param program named in warnings
/// @return the names of those of Registrars and of --external
/// @throws BadArgument if the name of one is taken or invalid, or an external one does not answer
std::vector<std::string> register_all_algorithms(Registry& registry, const ProcessOptions& options = {},
                                                 std::string_view program = "sixdof");

}  // namespace sixdof
