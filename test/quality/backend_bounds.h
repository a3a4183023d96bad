#pragma once

#include <vector>

#include "bounds.h"

namespace sixdof {

/// The part of the table for algorithms that are left out where their packages are missing.
const std::vector<BoundLine>& backend_bounds();

}  // namespace sixdof
