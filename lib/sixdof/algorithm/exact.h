#pragma once

#include <memory>

#include <sixdof/query/algorithm.h>

namespace sixdof {

/// `exact`: the answers that define truth in this suite, given as an algorithm like any other. Distances are those of
/// DistanceQuery; yes/no tells bodies, not only surfaces, apart where the meshes are solid.
///
/// The response follows the volume law with stiffness 1: penalty = volume of the intersection, force = -(gradient of
/// the volume with respect to translating B), torque = -(gradient with respect to rotating B about the centre of its
/// box), so it derives from a potential. It needs solids: for other meshes it fails and says why.
std::unique_ptr<Algorithm> make_exact_algorithm();

}  // namespace sixdof
