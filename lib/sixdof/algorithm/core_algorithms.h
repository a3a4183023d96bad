#pragma once

#include <sixdof/query/registry.h>

namespace sixdof {

/// Adds the algorithms that need no third-party collision library.
void register_core_algorithms(Registry& registry);

}  // namespace sixdof
