#include <sixdof/conformance/conformance.h>

#include <sixdof/algorithm/fcl/fcl.h>

namespace sixdof {
namespace {

SIXDOF_CONFORMANCE(make_fcl_obbrss_algorithm);
SIXDOF_CONFORMANCE(make_fcl_rss_algorithm);
SIXDOF_CONFORMANCE(make_fcl_kios_algorithm);
SIXDOF_CONFORMANCE(make_fcl_obb_algorithm);
SIXDOF_CONFORMANCE(make_fcl_aabb_algorithm);
SIXDOF_CONFORMANCE(make_fcl_contacts_algorithm);
SIXDOF_CONFORMANCE(make_fcl_cast_algorithm);

}  // namespace
}  // namespace sixdof
