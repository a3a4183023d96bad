#pragma once

#include <vector>

#include "bounds.h"

namespace sixdof {

/// Bounds of penalties along the path and of the spectra of directions, of all algorithms.
const std::vector<BoundLine>& signal_bounds();

}  // namespace sixdof
