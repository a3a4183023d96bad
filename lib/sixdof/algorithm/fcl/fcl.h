#pragma once

#include <memory>

#include <sixdof/query/registry.h>

namespace sixdof {

/// `fcl-obbrss`: FCL's bounding-volume trees with an oriented box and a rectangle-swept sphere in every node. Answers
/// collide (FCL tests boxes and stops at the first pair of triangles that intersect) and distance (swept spheres).
///
/// Surfaces only: a body wholly inside the other does not collide, and its distance is that of the surfaces.
std::unique_ptr<Algorithm> make_fcl_obbrss_algorithm();

/// `fcl-rss`: rectangle-swept spheres only, the bounding volume of PQP. Answers distance. It does not answer collide:
/// FCL 0.7 copies and refits the whole model in every collide() on this volume, which would be all that is measured.
std::unique_ptr<Algorithm> make_fcl_rss_algorithm();

/// Adds both and `fcl-contacts` (contacts.h).
void register_fcl_algorithms(Registry& registry);

}  // namespace sixdof
