#pragma once

#include <memory>

#include <sixdof/query/algorithm.h>

namespace sixdof {

/// `fcl-contacts`: FCL's contacts turned into a wrench of the depth law. Answers respond only.
///
/// FCL reports for every pair of triangles that intersect a point, a unit normal from A to B and the depth of THAT
/// pair, which knows nothing of the bodies behind the triangles. The wrench is the mean of depth * normal over the
/// contacts, with torques about the centre of B's bounding box, and the penalty is the largest depth. A mean, because
/// the number of pairs follows the tessellation; the parameter `combine` offers the sum and the deepest contact alone.
///
/// What it cannot do: surfaces only, so a body wholly inside the other gives no contact; coplanar triangles give
/// contacts with normals of either sign or none; depths jump as pairs come and go.
std::unique_ptr<Algorithm> make_fcl_contacts_algorithm();

}  // namespace sixdof
