#pragma once

#include <memory>

#include <sixdof/query/algorithm.h>

namespace sixdof {

/// `brute-force`: the smallest distance over all pairs of triangles; collide where it is 0. It has no tree and shares
/// no code with the other algorithms, so it checks them where meshes are small. Surfaces only; without rows in
/// benchmarks.
std::unique_ptr<Algorithm> make_brute_force_algorithm();

}  // namespace sixdof
