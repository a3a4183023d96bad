#pragma once

#include <memory>

#include <sixdof/query/algorithm.h>

namespace sixdof {

/// `brute-force`: the least distance over all pairs of triangles, about 0.1 us each; collide where it is 0. It has no
/// tree whose culling could be wrong and shares no code with the backends, so it checks them where meshes are small.
/// Surfaces only.
std::unique_ptr<Algorithm> make_brute_force_algorithm();

}  // namespace sixdof
