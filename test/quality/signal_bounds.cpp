#include "signal_bounds.h"

#include <limits>

namespace sixdof {
namespace {

constexpr double k_none = std::numeric_limits<double>::quiet_NaN();  // of a weakness
constexpr double k_rounding = 1e-9;  // of volumes of some thousand terms, and of spectra of two hundred steps

constexpr std::string_view k_scale =
    "penalty per unit of the ideal: one deepest point or contact, or the volume that spheres fill";
constexpr std::string_view k_flat = "flat contact, exact volume or depth: rounding only";
constexpr std::string_view k_steady = "a steady direction: rounding only";
constexpr std::string_view k_exact_volume = "96 facets; the error falls with their number";
constexpr std::string_view k_exact_direction = "96 facets: the direction turns by steps of a facet";
constexpr std::string_view k_voxel_depth =
    "the largest depth is read from one point in a voxel of 0.4 % of the diagonal";
constexpr std::string_view k_voxel_direction = "points enter voxels of other layers one after the other";
constexpr std::string_view k_field_depth =
    "the largest depth is that of one point; the distance is rounded along edges";
constexpr std::string_view k_field_direction = "points 0.4 % of the diagonal apart";
constexpr std::string_view k_packing = "unfilled volume does not count";
constexpr std::string_view k_cones = "the axes of the normal cones that take part change along the path";
constexpr std::string_view k_centers = "the lines of centres of the spheres that overlap change along the path";
constexpr std::string_view k_steepest = "the steepest descent follows the gaps between the spheres";
constexpr std::string_view k_deepest = "the deepest contact of two triangles, not the depth of the bodies";
constexpr std::string_view k_set = "the set of contacts changes from step to step";

using enum IdealLaw;
using enum Kind;

}  // namespace

// clang-format off
const std::vector<BoundLine>& signal_bounds() {
  static const std::vector<BoundLine> lines{
    // scenario, algorithm, law, reason, kind, measures
    {"Ia", "exact", gradient, k_flat, required, {{"sigma_q", k_rounding}}},
    {"Ia", "exact", gradient, k_flat, required, {{"gain_q", k_rounding}}},
    {"Ia", "exact", gradient, k_steady, required, {{"nu_direction_F", k_rounding}}},
    {"Ia", "vps", depth, k_voxel_depth, characterised, {{"sigma_q", 0.026}}},
    {"Ia", "vps", depth, k_scale, scale, {{"gain_q", 0.915}}},
    {"Ia", "vps", depth, k_voxel_direction, characterised, {{"nu_direction_F", 7e-05}}},
    {"Ia", "vps-field", depth, k_field_depth, characterised, {{"sigma_q", 0.00021}}},
    {"Ia", "vps-field", depth, k_scale, scale, {{"gain_q", 0.63}}},
    {"Ia", "vps-field", depth, k_field_direction, characterised, {{"nu_direction_F", 7.8e-10}}},
    {"Ia", "ist", volume, k_packing, characterised, {{"sigma_q", 0.099}}},
    {"Ia", "ist", volume, k_scale, scale, {{"gain_q", 0.704}}},
    {"Ia", "ist", volume, k_cones, characterised, {{"nu_direction_F", 0.0002}}},
    {"Ia", "ist-10000", volume, k_packing, characterised, {{"sigma_q", 0.21}}},
    {"Ia", "ist-10000", volume, k_scale, scale, {{"gain_q", 0.578}}},
    {"Ia", "ist-10000", volume, k_cones, characterised, {{"nu_direction_F", 0.0017}}},
    {"Ia", "ist-volume", volume, k_packing, characterised, {{"sigma_q", 0.21}}},
    {"Ia", "ist-volume", volume, k_scale, scale, {{"gain_q", 0.578}}},
    {"Ia", "ist-volume", volume, k_centers, characterised, {{"nu_direction_F", 0.27}}},
    {"Ia", "ist-descent", volume, k_packing, characterised, {{"sigma_q", 0.12}}},
    {"Ia", "ist-descent", volume, k_scale, scale, {{"gain_q", 0.929}}},
    {"Ia", "ist-descent", volume, k_steepest, characterised, {{"nu_direction_F", 0.018}}},
    {"Ia", "fcl-contacts", depth, k_flat, required, {{"sigma_q", k_rounding}}},
    {"Ia", "fcl-contacts", depth, k_flat, required, {{"gain_q", k_rounding}}},
    {"Ia", "fcl-contacts", depth, k_set, characterised, {{"nu_direction_F", 3.4e-06}}},
    {"Ia", "bullet-gimpact", depth, k_flat, required, {{"sigma_q", k_rounding}}},
    {"Ia", "bullet-gimpact", depth, k_flat, required, {{"gain_q", k_rounding}}},
    {"Ia", "bullet-gimpact", depth, k_set, characterised, {{"nu_direction_F", 0.0006}}},
    {"Ia", "ode", depth, k_flat, required, {{"sigma_q", k_rounding}}},
    {"Ia", "ode", depth, k_flat, required, {{"gain_q", k_rounding}}},
    {"Ia", "ode", depth, k_set, characterised, {{"nu_direction_F", 0.067}}},
    {"Ib", "exact", gradient, k_flat, required, {{"sigma_q", k_rounding}}},
    {"Ib", "exact", gradient, k_flat, required, {{"gain_q", k_rounding}}},
    {"Ib", "exact", gradient, k_steady, required, {{"nu_direction_F", k_rounding}}},
    {"Ib", "vps", depth, k_voxel_depth, characterised, {{"sigma_q", 0.18}}},
    {"Ib", "vps", depth, k_scale, scale, {{"gain_q", 0.138}}},
    {"Ib", "vps", depth, k_voxel_direction, characterised, {{"nu_direction_F", 0.0088}}},
    {"Ib", "ist", volume, k_packing, characterised, {{"sigma_q", 0.53}}},
    {"Ib", "ist", volume, k_scale, scale, {{"gain_q", 0.000537}}},
    {"Ib", "ist", volume, k_cones, characterised, {{"nu_direction_F", 0.091}}},
    {"Ib", "ist-volume", volume, k_packing, characterised, {{"sigma_q", 0.53}}},
    {"Ib", "ist-volume", volume, k_scale, scale, {{"gain_q", 0.000537}}},
    {"Ib", "ist-volume", volume, k_centers, weakness, {{"nu_direction_F", k_none}}},
    {"Ib", "ist-descent", volume, k_packing, characterised, {{"sigma_q", 0.51}}},
    {"Ib", "ist-descent", volume, k_scale, scale, {{"gain_q", 0.99}}},
    {"Ib", "ist-descent", volume, k_steepest, weakness, {{"nu_direction_F", k_none}}},
    {"Ib", "fcl-contacts", depth, k_flat, required, {{"sigma_q", k_rounding}}},
    {"Ib", "fcl-contacts", depth, k_scale, scale, {{"gain_q", 2.01}}},
    {"Ib", "fcl-contacts", depth, k_set, characterised, {{"nu_direction_F", 1.1e-05}}},
    {"Ib", "bullet-gimpact", depth, k_flat, required, {{"sigma_q", k_rounding}}},
    {"Ib", "bullet-gimpact", depth, k_scale, scale, {{"gain_q", 2.01}}},
    {"Ib", "bullet-gimpact", depth, k_set, characterised, {{"nu_direction_F", 0.094}}},
    {"Ib", "ode", depth, k_flat, required, {{"sigma_q", k_rounding}}},
    {"Ib", "ode", depth, k_scale, scale, {{"gain_q", 2.01}}},
    {"Ib", "ode", depth, k_set, characterised, {{"nu_direction_F", 0.14}}},
    {"II", "exact", gradient, k_exact_volume, characterised, {{"sigma_q", 1.3e-05}}},
    {"II", "exact", gradient, k_scale, scale, {{"gain_q", 1}}},
    {"II", "exact", gradient, k_exact_direction, characterised, {{"nu_direction_F", 6.1e-09}}},
    {"II", "vps", depth, k_voxel_depth, characterised, {{"sigma_q", 0.016}}},
    {"II", "vps", depth, k_scale, scale, {{"gain_q", 0.99}}},
    {"II", "vps", depth, k_voxel_direction, characterised, {{"nu_direction_F", 2.4e-07}}},
    {"II", "vps-field", depth, k_field_depth, characterised, {{"sigma_q", 0.0012}}},
    {"II", "vps-field", depth, k_scale, scale, {{"gain_q", 1}}},
    {"II", "vps-field", depth, k_field_direction, characterised, {{"nu_direction_F", 1.9e-09}}},
    {"II", "ist", volume, k_packing, characterised, {{"sigma_q", 0.001}}},
    {"II", "ist", volume, k_scale, scale, {{"gain_q", 0.936}}},
    {"II", "ist", volume, k_cones, characterised, {{"nu_direction_F", 2.4e-08}}},
    {"II", "ist-10000", volume, k_packing, characterised, {{"sigma_q", 0.0056}}},
    {"II", "ist-10000", volume, k_scale, scale, {{"gain_q", 0.828}}},
    {"II", "ist-10000", volume, k_cones, characterised, {{"nu_direction_F", 2.4e-06}}},
    {"II", "ist-volume", volume, k_packing, characterised, {{"sigma_q", 0.0056}}},
    {"II", "ist-volume", volume, k_scale, scale, {{"gain_q", 0.828}}},
    {"II", "ist-volume", volume, k_centers, characterised, {{"nu_direction_F", 6.5e-07}}},
    {"II", "ist-descent", volume, k_packing, characterised, {{"sigma_q", 0.0042}}},
    {"II", "ist-descent", volume, k_scale, scale, {{"gain_q", 0.98}}},
    {"II", "ist-descent", volume, k_steepest, characterised, {{"nu_direction_F", 1.1e-05}}},
    {"II", "fcl-contacts", depth, k_deepest, characterised, {{"sigma_q", 0.053}}},
    {"II", "fcl-contacts", depth, k_scale, scale, {{"gain_q", 0.185}}},
    {"II", "fcl-contacts", depth, k_set, characterised, {{"nu_direction_F", 0.00014}}},
    {"II", "bullet-gimpact", depth, k_deepest, characterised, {{"sigma_q", 0.24}}},
    {"II", "bullet-gimpact", depth, k_scale, scale, {{"gain_q", 0.233}}},
    {"II", "bullet-gimpact", depth, k_set, characterised, {{"nu_direction_F", 0.00079}}},
    {"II", "ode", depth, k_deepest, characterised, {{"sigma_q", 0.087}}},
    {"II", "ode", depth, k_scale, scale, {{"gain_q", 0.176}}},
    {"II", "ode", depth, k_set, characterised, {{"nu_direction_F", 0.00043}}},
    {"III", "exact", gradient, k_flat, required, {{"sigma_q", k_rounding}}},
    {"III", "exact", gradient, k_flat, required, {{"gain_q", k_rounding}}},
    {"III", "exact", gradient, k_steady, required, {{"nu_direction_T", k_rounding}}},
    {"III", "vps", traction, k_voxel_depth, characterised, {{"sigma_q", 0.032}}},
    {"III", "vps", traction, k_scale, scale, {{"gain_q", 1.06}}},
    {"III", "vps", traction, k_voxel_direction, characterised, {{"nu_direction_T", 1.6e-07}}},
    {"III", "vps-field", wall_traction, k_field_depth, characterised, {{"sigma_q", 0.0044}}},
    {"III", "vps-field", wall_traction, k_scale, scale, {{"gain_q", 0.984}}},
    {"III", "vps-field", wall_traction, k_field_direction, characterised, {{"nu_direction_T", 7.8e-11}}},
    {"III", "ist", normals, k_packing, characterised, {{"sigma_q", 0.084}}},
    {"III", "ist", normals, k_scale, scale, {{"gain_q", 0.566}}},
    {"III", "ist", normals, k_cones, characterised, {{"nu_direction_T", 7e-08}}},
    {"III", "ist-10000", volume, k_packing, characterised, {{"sigma_q", 0.13}}},
    {"III", "ist-10000", volume, k_scale, scale, {{"gain_q", 0.434}}},
    {"III", "ist-10000", volume, k_cones, characterised, {{"nu_direction_T", 1.3e-07}}},
    {"III", "ist-volume", volume, k_packing, characterised, {{"sigma_q", 0.13}}},
    {"III", "ist-volume", volume, k_scale, scale, {{"gain_q", 0.434}}},
    {"III", "ist-volume", volume, k_centers, characterised, {{"nu_direction_T", 5.6e-06}}},
    {"III", "ist-descent", volume, k_packing, characterised, {{"sigma_q", 0.081}}},
    {"III", "ist-descent", volume, k_scale, scale, {{"gain_q", 0.867}}},
    {"III", "ist-descent", volume, k_steepest, characterised, {{"nu_direction_T", 4.1e-05}}},
    {"III", "fcl-contacts", depth, k_deepest, weakness, {{"sigma_q", k_none}}},
    {"III", "fcl-contacts", depth, k_scale, scale, {{"gain_q", 12.1}}},
    {"III", "fcl-contacts", depth, k_set, characterised, {{"nu_direction_T", 0.0054}}},
    {"III", "bullet-gimpact", depth, k_deepest, weakness, {{"sigma_q", k_none}}},
    {"III", "bullet-gimpact", depth, k_scale, scale, {{"gain_q", 6.24}}},
    {"III", "bullet-gimpact", depth, k_set, characterised, {{"nu_direction_T", 1.9}}},
    {"III", "ode", depth, k_deepest, weakness, {{"sigma_q", k_none}}},
    {"III", "ode", depth, k_scale, scale, {{"gain_q", 6.24}}},
    {"III", "ode", depth, k_set, characterised, {{"nu_direction_T", 0.35}}},
    {"IV", "exact", gradient, k_exact_volume, characterised, {{"sigma_q", 1.4e-06}}},
    {"IV", "exact", gradient, k_scale, scale, {{"gain_q", 1}}},
    {"IV", "exact", gradient, k_exact_direction, characterised, {{"nu_direction_F", 5.1e-07}}},
    {"IV", "vps", traction, k_voxel_depth, characterised, {{"sigma_q", 0.15}}},
    {"IV", "vps", traction, k_scale, scale, {{"gain_q", 1.04}}},
    {"IV", "vps", traction, k_voxel_direction, characterised, {{"nu_direction_F", 4.4e-05}}},
    {"IV", "vps-field", wall_traction, k_field_depth, characterised, {{"sigma_q", 0.0061}}},
    {"IV", "vps-field", wall_traction, k_scale, scale, {{"gain_q", 1}}},
    {"IV", "vps-field", wall_traction, k_field_direction, characterised, {{"nu_direction_F", 7.4e-08}}},
    {"IV", "ist", volume, k_packing, characterised, {{"sigma_q", 0.023}}},
    {"IV", "ist", volume, k_scale, scale, {{"gain_q", 0.437}}},
    {"IV", "ist", volume, k_cones, characterised, {{"nu_direction_F", 6.3e-07}}},
    {"IV", "ist-volume", volume, k_packing, characterised, {{"sigma_q", 0.023}}},
    {"IV", "ist-volume", volume, k_scale, scale, {{"gain_q", 0.437}}},
    {"IV", "ist-volume", volume, k_centers, characterised, {{"nu_direction_F", 1e-05}}},
    {"IV", "ist-descent", volume, k_packing, characterised, {{"sigma_q", 0.032}}},
    {"IV", "ist-descent", volume, k_scale, scale, {{"gain_q", 0.86}}},
    {"IV", "ist-descent", volume, k_steepest, characterised, {{"nu_direction_F", 0.00057}}},
    {"IV", "fcl-contacts", depth, k_deepest, characterised, {{"sigma_q", 0.01}}},
    {"IV", "fcl-contacts", depth, k_scale, scale, {{"gain_q", 19.1}}},
    {"IV", "fcl-contacts", depth, k_set, characterised, {{"nu_direction_F", 0.0072}}},
    {"IV", "bullet-gimpact", depth, k_deepest, characterised, {{"sigma_q", 0.01}}},
    {"IV", "bullet-gimpact", depth, k_scale, scale, {{"gain_q", 19.1}}},
    {"IV", "bullet-gimpact", depth, k_set, characterised, {{"nu_direction_F", 0.11}}},
    {"IV", "ode", depth, k_deepest, characterised, {{"sigma_q", 0.01}}},
    {"IV", "ode", depth, k_scale, scale, {{"gain_q", 19.1}}},
    {"IV", "ode", depth, k_set, characterised, {{"nu_direction_F", 0.012}}},
  };
  return lines;
}
// clang-format on

}  // namespace sixdof
