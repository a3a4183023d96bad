#pragma once

#include <memory>

#include <sixdof/generation/distance_generator.h>

namespace sixdof {

/// The sphere method without an outer iteration: B's path is a ray that is cast against all differences of a point of B
/// and a point of A, grown by the target. The largest translation s with dist(A, B + s u) = target is the largest over all pairs
/// of triangles, so one branch and bound over two trees finds it, whatever the surfaces do in between. It is the first
/// hit from outside: no resolution limits how narrow a hit may be. A ray's targets share that work: each goes on from what
/// the wider one before it could not cull.
///
/// A hit that lies outside another by less than k_ray_cast_tie, in units of the meshes' radii and the target, may give way
/// to it; of faces that touch along their whole extent only one is looked into.
///
/// Results depend on the rotation and the directions since set_rotation() alone: the same bits for every number of
/// threads and on every instruction set.
std::unique_ptr<DistanceGenerator> make_ray_cast();

constexpr double k_ray_cast_tie = 1e-14;

}  // namespace sixdof
