#include <sixdof/conformance/conformance.h>

#include <sixdof/algorithm/fcl/fcl.h>

namespace sixdof {
namespace {

const char* const k_tolerances = "flexible-collision-library/fcl#257";

/// Triangles with edges of some 1e-4 length units.
const conformance::KnownFailure k_small_triangles{
    "ScaleOfDistance",
    "takes a triangle for degenerate if its squared normal is below 1e-15, whatever the unit of length", k_tolerances};
const conformance::KnownFailure k_small_contacts{"ScaleOfRespond",
                                                 "clips triangles with a tolerance of 1e-5 length units", k_tolerances};

SIXDOF_CONFORMANCE(make_fcl_obbrss_algorithm, {.known_failures = {k_small_triangles}});
SIXDOF_CONFORMANCE(make_fcl_rss_algorithm, {.known_failures = {k_small_triangles}});
SIXDOF_CONFORMANCE(make_fcl_kios_algorithm, {.known_failures = {k_small_triangles}});
SIXDOF_CONFORMANCE(make_fcl_obb_algorithm);
SIXDOF_CONFORMANCE(make_fcl_aabb_algorithm);
// Contacts know two triangles, not which side of the body is nearer: 24.5 degrees are measured.
SIXDOF_CONFORMANCE(make_fcl_contacts_algorithm, {.force_degrees = 30.0, .known_failures = {k_small_contacts}});

}  // namespace
}  // namespace sixdof
