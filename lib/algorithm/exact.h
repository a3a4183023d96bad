#pragma once

#include <memory>

#include <sixdof/algorithm/algorithm.h>

namespace sixdof {

/// `exact`: the answers that define truth in this suite, given as an algorithm like any other. Distances are those of
/// DistanceQuery; yes/no tells bodies, not only surfaces, apart where the meshes are solid.
std::unique_ptr<Algorithm> make_exact_algorithm();

}  // namespace sixdof
