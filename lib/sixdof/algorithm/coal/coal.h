#pragma once

#include <memory>

#include <sixdof/query/registry.h>

namespace sixdof {

/// `coal-obbrss`: Coal (formerly hpp-fcl), trees of oriented boxes with rectangle-swept spheres. Answers collide and
/// distance. `coal-contacts`: its contacts as they are, and as a wrench (algorithm/contact_wrench.h). Answers respond
/// and contacts.
///
/// Coal is no Debian package: both are built where CMake finds it (find_package(coal)). This project's own tests
/// compile them against headers that forward Coal's names to FCL (test/algorithm/coal/stand_in), so they check this
/// adapter, not Coal.
///
/// **Prepare** builds a BVHModel<OBBRSS> of each mesh. **A query** calls coal::collide() or coal::distance() for the
/// pair, without a broad phase.
///
/// **Profiles** of `coal-obbrss`. `default`: the requests as their constructors leave them, one contact with its
/// points. `tuned` follows Coal's developers: `enable_contact` off, "Make sure to turn that off for maximum
/// performances" (https://github.com/coal-library/coal/issues/857), the functors ComputeCollision and ComputeDistance,
/// and the guess of the last query for GJK: "much more efficient by deploying caching mechanisms and functors"
/// (https://github.com/coal-library/coal/issues/376). The guess is a warm start: the order of poses may change the
/// rounding of distances.
///
/// **Contacts.** Coal's `penetration_depth` is a signed distance, negative inside; its negative is the depth here.
///
/// **Precision.** Coal's Scalar, double unless Coal was compiled otherwise; pairs of triangles are solved by GJK with
/// Coal's default tolerance of 1e-6. **Known failures.** Surfaces only: a body wholly inside the other does not
/// collide.
std::unique_ptr<Algorithm> make_coal_obbrss_algorithm();
/// `coal-contacts`: a response from Coal's contacts.
std::unique_ptr<Algorithm> make_coal_contacts_algorithm();

/// Adds both.
void register_coal_algorithms(Registry& registry);

}  // namespace sixdof
