#pragma once

#include <span>

#include "bounds.h"

namespace sixdof {

/// The part of the table for algorithms that are left out where their packages are missing.
std::span<const Bound> backend_bounds();

}  // namespace sixdof
