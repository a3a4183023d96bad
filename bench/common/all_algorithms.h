#pragma once

#include <string>
#include <vector>

#include <sixdof/query/registry.h>

namespace sixdof {

/// Adds every algorithm that this program has: the core's own, then those of each backend that was built, then those of
/// every Registrar.
/// @return the names of the last ones
/// @throws BadArgument if the name of one is taken or invalid
std::vector<std::string> register_all_algorithms(Registry& registry);

}  // namespace sixdof
