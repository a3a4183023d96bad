#pragma once

#include <sixdof/query/registry.h>

namespace sixdof {

/// Adds every algorithm that this build has: the core's own, then those of each backend that was built.
void register_all_algorithms(Registry& registry);

}  // namespace sixdof
