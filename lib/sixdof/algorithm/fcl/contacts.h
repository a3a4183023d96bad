#pragma once

#include <memory>

#include <sixdof/query/algorithm.h>

namespace sixdof {

/// `fcl-contacts`: FCL's contacts turned into a wrench of the depth law. Answers respond only.
///
/// For every pair of intersecting triangles FCL reports a point, a unit normal from A to B and the penetration depth of
/// these two triangles, not of the bodies. The wrench is the mean of depth * normal over the contacts, with torques
/// about the centre of B's bounding box, and the penalty is the largest depth. The mean, because the number of pairs
/// depends on the tessellation; parameter `combine` selects the sum or the deepest contact instead.
///
/// Limits: surfaces only, so a body wholly inside the other has no contact; coplanar triangles give contacts with
/// normals of either sign, or none; depths are not continuous, as pairs appear and disappear.
std::unique_ptr<Algorithm> make_fcl_contacts_algorithm();

}  // namespace sixdof
