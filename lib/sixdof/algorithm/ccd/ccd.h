#pragma once

#include <memory>

#include <sixdof/query/registry.h>

namespace sixdof {

/// `ccd-hull`: libccd on the convex hulls of both meshes. Answers collide and contacts.
///
/// **Another question.** The answers are about the hulls (Traits::body): yes where the hulls overlap, although the
/// meshes may be apart. Rows of it are judged by what `exact` says of the hulls (oracle/convex_hull.h), stand in tables
/// of their own, and are in no suite or study of all algorithms.
///
/// **Prepare** makes both hulls by convex_hull(). **A query** runs ccdGJKIntersect(), or ccdMPRIntersect() with
/// `method=mpr`, with a support function that goes through all vertices of a hull, as libccd leaves it to its user. It
/// stops after `max_iterations`, 100 as in libccd's first example, and then says no. Nothing is kept from query to
/// query. Hulls are solids: one inside the other is a contact.
///
/// **Contacts.** One, by ccdGJKPenetration() (EPA), or by ccdMPRPenetration() with `method=mpr`. Its depth is meant to
/// be the translational penetration depth of the hulls (ContactDepth::bodies); rows `depth/...` judge it. MPR finds the
/// depth along the way from centre to centre only. A touch without depth is no contact.
///
/// **Precision.** Double precision; the answer to hulls whose distance or depth is about 1e-6 of their size is by
/// chance.
///
/// **Profiles.** libccd's documentation gives no advice beyond its two methods.
std::unique_ptr<Algorithm> make_ccd_hull_algorithm();

/// Adds it.
void register_ccd_algorithms(Registry& registry);

}  // namespace sixdof
