#pragma once

#include <memory>

#include <sixdof/generation/distance_generator.h>

namespace sixdof {

/// The sphere method by one ray cast per configuration instead of an iteration. A ray is cast against the Minkowski
/// difference of B and A, grown by the target distance. The largest translation s with dist(A, B + s u) = target is the
/// largest over all pairs of triangles, which one branch and bound over two trees finds. It is the first hit from
/// outside, however short the interval in which the distance is below the target. The search for each target of a ray
/// starts from the pairs that the search for the larger target before it did not cull.
///
/// A hit is not replaced by one that is farther out by less than 1e-14, in units of the sum of the meshes' radii and
/// the target (k_cast_tie).
///
/// Results have the same bits for every number of threads and on every instruction set.
std::unique_ptr<DistanceGenerator> make_ray_cast();

}  // namespace sixdof
