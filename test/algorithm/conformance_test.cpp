// The library's own algorithms, as the conformance kit holds every algorithm to its rules, with what
// lib/sixdof/conformance/declared.cpp says that they claim.

#include <sixdof/conformance/conformance.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/algorithm/ist/ist.h>
#include <sixdof/algorithm/vps/vps.h>

namespace sixdof {
namespace {

SIXDOF_CONFORMANCE(make_exact_algorithm);
SIXDOF_CONFORMANCE(make_exact_depth_algorithm);
SIXDOF_CONFORMANCE(make_exact_way_out_algorithm);
SIXDOF_CONFORMANCE(make_brute_force_algorithm);
SIXDOF_CONFORMANCE(make_sampled_algorithm);
SIXDOF_CONFORMANCE(make_exact_contacts_algorithm);
SIXDOF_CONFORMANCE(make_exact_penetration_algorithm);
SIXDOF_CONFORMANCE(make_ist_algorithm);
SIXDOF_CONFORMANCE(make_ist_descent_algorithm);
SIXDOF_CONFORMANCE(make_vps_algorithm);
SIXDOF_CONFORMANCE(make_vps_field_algorithm);

}  // namespace
}  // namespace sixdof
