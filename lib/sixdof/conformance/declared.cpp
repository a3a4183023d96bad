#include <sixdof/conformance/declared.h>

#include <algorithm>
#include <vector>

namespace sixdof::conformance {
namespace {

struct Declared {
  const char* name;
  Declaration declaration;
};

/// 300 spheres a body: what they do not fill is 0.6 in distance where a body of diagonal 0.7 is inside a ball. Another
/// packing fits a body that is turned or scaled, as its first bits differ.
Declaration of_spheres(double force_degrees, double volume_error) {
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

/// A is sampled at B's points, along the axes of A's voxels.
Declaration of_voxels(double force_degrees, double scale_error) {
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

/// Refinement differs where roundings do, so answers agree within their tolerance only.
Declaration of_depth(double force_degrees) {
  return {.settings = {"tolerance=0.03"},
          .open_meshes = false,
          .force_degrees = force_degrees,
          .order_error = k_no_claim,
          .motion_error = 0.06,
          .scale_error = 0.06};
}

/// Roundings only.
Declaration of_exact_contacts() {
  return {.collide = Meaning::bodies,
          .open_meshes = false,
          .contact_error = 1e-9,
          .contact_degrees = 0.01,
          .depth_error = 1e-6,
          .contact_change_degrees = 0.01};
}

/// FCL's traversals of distances.
Declaration of_fcl_distance() {
  // Triangles with edges of some 1e-4 length units.
  return {.known_failures = {
              {"ScaleOfDistance",
               "takes a triangle for degenerate if its squared normal is below 1e-15, whatever the unit of length",
               "flexible-collision-library/fcl#257"}}};
}

/// Contacts know two triangles, not which side of the body is nearer: 24.5 degrees are measured.
Declaration of_fcl_contacts() {
  return {.force_degrees = 30.0,
          .known_failures = {{"ScaleOfRespond", "clips triangles with a tolerance of 1e-5 length units",
                              "flexible-collision-library/fcl#257"}}};
}

Declaration of_fcl_cast() {
  return {
      .known_failures = {{"Cast", "yes/no at ten times of a motion: hits between two of them are late or missed", ""}}};
}

Declaration of_bullet() {
  const char* const k_behind =
      "takes what is behind a triangle, in its box, for a contact: the plate of large triangles";
  const char* const k_issue = "bulletphysics/bullet3#4318";
  return {.known_failures = {
              {"Collide", k_behind, k_issue},
              {"Respond", k_behind, k_issue},
              {"Contacts", k_behind, k_issue},
              {"MotionOfCollide", k_behind, k_issue},
              {"MotionOfRespond", k_behind, k_issue},
              {"ScaleOfRespond", "CONTACT_DIFF_EPSILON and others are lengths of 1e-5, whatever the unit", ""}}};
}

/// Measured: 20.1 degrees, and 7 % between the two orders and after a motion, where the contacts of some pair of
/// triangles are others.
Declaration of_ode() {
  return {.force_degrees = 25.0,
          .order_error = 0.1,
          .motion_error = 0.1,
          .known_failures = {{"ScaleOfRespond", "contacts depend on the unit of length", ""}}};
}

/// GTS's hash tables are in the order of addresses, and so are its sums: they repeat to some roundings.
Declaration of_gts() { return {.collide = Meaning::bodies, .open_meshes = false, .repeat_error = 1e-9}; }

/// Measured: 55 degrees. A spring pushes towards the nearest point of the other surface, through a thin body, too.
Declaration of_simbody() {
  return {.open_meshes = false,
          .force_degrees = 65.0,
          .known_failures = {
              {"ScaleOfRespond", "forces differ by up to 0.3 % on meshes 1000 times larger; cause not traced", ""}}};
}

/// Called before main(), too.
const std::vector<Declared>& table() {
  static const std::vector<Declared> list{
      {"exact", {.collide = Meaning::bodies}},
      {"fcl-cast", of_fcl_cast()},
      // Contacts on these motions last longer than a step.
      {"sampled", {.settings = {"steps=1024"}, .collide = Meaning::bodies}},
      {"exact-contacts", of_exact_contacts()},
      {"exact-depth", of_depth(15.0)},
      {"exact-way-out", of_depth(80.0)},
      // One contact where the bodies touch after the translation, which need not be in both.
      {"exact-penetration", {.collide = Meaning::bodies, .open_meshes = false}},
      {"ist", of_spheres(30.0, 0.85)},
      {"ist-descent", of_spheres(12.0, 0.3)},
      {"vps", of_voxels(15.0, 0.01)},
      // Pushes sideways where B encloses a thin part of A.
      {"vps-field", of_voxels(80.0, 0.03)},
      {"fcl-obbrss", of_fcl_distance()},
      {"fcl-rss", of_fcl_distance()},
      {"fcl-kios", of_fcl_distance()},
      {"fcl-contacts", of_fcl_contacts()},
      {"bullet-gimpact", of_bullet()},
      {"ode", of_ode()},
      // Both profiles have the same traversal and test of triangles; this one keeps a tree from query to query.
      {"embree", {.settings = {"profile=tuned"}}},
      {"gts", of_gts()},
      {"simbody", of_simbody()}};
  return list;
}

}  // namespace

Declaration declaration_of(std::string_view algorithm) {
  const auto found = std::ranges::find_if(table(), [&](const Declared& each) { return algorithm == each.name; });
  return found == table().end() ? Declaration{} : found->declaration;
}

}  // namespace sixdof::conformance
