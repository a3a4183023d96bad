// The library's own algorithms, as the conformance kit holds every algorithm to its rules.

#include <sixdof/conformance/conformance.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/algorithm/ist/ist.h>
#include <sixdof/algorithm/vps/vps.h>

namespace sixdof {
namespace {

using conformance::k_no_claim;
using conformance::Meaning;

SIXDOF_CONFORMANCE(make_exact_algorithm, {.collide = Meaning::bodies});
SIXDOF_CONFORMANCE(make_brute_force_algorithm);

/// 300 spheres a body: what they do not fill is 0.6 in distance where a body of diagonal 0.7 is inside a ball. Another
/// packing fits a body that is turned or scaled, as its first bits differ.
conformance::Declaration of_spheres(double force_degrees, double volume_error) {
  return {.settings = {"spheres=300"},
          .collide = Meaning::bodies,
          .open_meshes = false,
          .distance_error = 0.9,
          .witness_error = 0.05,
          .volume_error = volume_error,
          .force_degrees = force_degrees,
          .motion_error = k_no_claim,
          .scale_error = k_no_claim};
}
SIXDOF_CONFORMANCE(make_ist_algorithm, of_spheres(30.0, 0.85));
SIXDOF_CONFORMANCE(make_ist_descent_algorithm, of_spheres(12.0, 0.3));

/// A is sampled at B's points, along the axes of A's voxels.
conformance::Declaration of_voxels(double force_degrees, double scale_error) {
  const char* const k_inside = "A is sampled at B's points only: none is in an A that lies inside B (vps.h)";
  return {.settings = {"voxel_size=0.01", "point_spacing=0.01"},
          .collide = Meaning::bodies,
          .open_meshes = false,
          .force_degrees = force_degrees,
          .order_error = k_no_claim,
          .motion_error = k_no_claim,
          .scale_error = scale_error,
          .known_failures = {{"CollideOfContained", k_inside, ""}, {"OrderOfCollide", k_inside, ""}}};
}
SIXDOF_CONFORMANCE(make_vps_algorithm, of_voxels(15.0, 0.01));
// Pushes sideways where B encloses a thin part of A.
SIXDOF_CONFORMANCE(make_vps_field_algorithm, of_voxels(80.0, 0.03));

}  // namespace
}  // namespace sixdof
