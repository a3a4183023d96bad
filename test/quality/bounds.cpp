#include "bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "backend_bounds.h"
#include "bench/common/all_algorithms.h"
#include "signal_bounds.h"

namespace sixdof {
namespace {

constexpr double k_none = std::numeric_limits<double>::quiet_NaN();  // of a weakness
// Sums over some thousand contributions of 1e-16, whose directions are angles in degrees.
constexpr double k_rounding = 1e-9;

// For all.
constexpr std::string_view k_paper = "the value that the paper prints for this method";
constexpr std::string_view k_no_memory = "answers each pose independently: no lag";
constexpr std::string_view k_scale = "force per unit of the ideal: the method's own stiffness";
constexpr std::string_view k_energy = "energy of the normalised signal: ripple and shape, as sigma";
constexpr std::string_view k_slope = "continuous: a slope after ten halvings";
// exact
constexpr std::string_view k_flat = "flat contact: rounding only";
constexpr std::string_view k_regular = "regular polygon, sideways components cancel: rounding only";
constexpr std::string_view k_facets = "96 facets; the error falls with their number";
constexpr std::string_view k_conservative = "gradient of a volume: rounding only";
constexpr std::string_view k_kink = "V has a kink where contact with a wall begins or ends: the law itself jumps";
// vps
constexpr std::string_view k_voxels = "depth is read from layers and the position in a voxel of 0.4 % of the diagonal";
constexpr std::string_view k_enters = "one point enters a voxel of another layer";
constexpr std::string_view k_thin = "the plate is thinner than a voxel: detected, but its depth is that of the voxel";
constexpr std::string_view k_plate = "the plate's points lie in the block's surface voxels and push: that contact acts";
constexpr std::string_view k_snug = "half a voxel is a fifth of the displacement";
// vps-field
constexpr std::string_view k_points = "points 0.4 % of the diagonal apart";
constexpr std::string_view k_edges = "the interpolated distance is rounded along edges";
constexpr std::string_view k_medial =
    "near the ends and in the middle of the block two walls are equally near: rounded";
constexpr std::string_view k_thin_field =
    "the plate is thinner than a voxel: the interpolated distance is inside nowhere";
// ist
constexpr std::string_view k_packing = "unfilled volume does not count";
constexpr std::string_view k_cones =
    "V along axes of normal cones, of spheres inside only; the largest spheres have no axis";
constexpr std::string_view k_edge_cones = "a sphere near an edge leads out between its faces, to the side as well";
// ist-volume
constexpr std::string_view k_centers =
    "V along lines of centres of spheres of all sizes: follows the walls approximately";
constexpr std::string_view k_inside =
    "a small sphere inside a large one is pushed from its centre, not to the nearest face";
constexpr std::string_view k_gaps = "10,000 spheres with corrected fill; the error falls with their number";
constexpr std::string_view k_steepest = "pushes along -grad V, up to 13 degrees from the law's radial direction";
constexpr std::string_view k_swallowed =
    "tiny spheres of the plate inside those of the cone: a volume without a gradient";
constexpr std::string_view k_thin_spheres = "a layer of tiny spheres: pushes along the plate as much as out of it";
// fcl-contacts
constexpr std::string_view k_pairs = "FCL's depth of a pair of triangles, mean over pairs";
constexpr std::string_view k_set = "the set of pairs in contact changes from step to step";
constexpr std::string_view k_blind = "FCL's normal is that of the nearer side: through the plate, downwards";
constexpr std::string_view k_sign = "FCL's normals ignore which side is inside: the torque has the wrong sign";

using enum IdealLaw;
using enum Kind;

// clang-format off
const std::vector<BoundLine>& own_lines() {
  static const std::vector<BoundLine> lines{
    // scenario, algorithm, law, reason, kind, measures; every subject has zero misses and failures besides
    {"Ia", "vps", depth, k_paper, required, {{"sigma_F", 0.043}}},
    {"Ia", "vps", traction, k_paper, required, {{"sigma_F_all", 0.043}}},
    {"Ia", "ist", volume, k_paper, required, {{"sigma_F", 0.176}, {"sigma_F_all", 0.176}}},
    {"Ia", "ist-descent", volume, k_paper, required, {{"sigma_F", 0.176}}},
    {"II", "vps", depth, k_paper, required, {{"gamma_F_deg", 2.40}}},
    {"II", "ist", volume, k_paper, required, {{"gamma_F_deg", 7.64}}},
    {"II", "ist-descent", volume, k_paper, required, {{"gamma_F_deg", 7.64}}},
    {"III", "vps", traction, k_paper, required, {{"sigma_T", 0.169}, {"sigma_T_all", 0.169}, {"nu_T", 0.61}}},
    {"III", "ist", normals, k_paper, required, {{"sigma_T", 0.112}, {"sigma_T_all", 0.112}, {"nu_T", 0.12}}},
    {"III", "ist-descent", volume, k_paper, required, {{"sigma_T", 0.112}}},
    {"Ia", "exact", gradient, k_flat, required, {{"sigma_F", k_rounding}, {"noise_F", k_rounding}}},
    {"Ia", "exact", gradient, k_flat, required, {{"gain_F", k_rounding}, {"nu_F", k_rounding}}},
    {"Ia", "exact", gradient, k_regular, required, {{"gamma_F_deg", k_rounding}, {"leakage", k_rounding}}},
    {"Ia", "exact", gradient, k_slope, characterised, {{"jump_F", 0.00047}}},
    {"Ia", "exact", volume, k_flat, required, {{"sigma_F", k_rounding}}},
    {"Ia", "exact", volume, k_regular, required, {{"gamma_F_deg", k_rounding}}},
    {"Ia", "vps", depth, k_voxels, characterised, {{"sigma_F", 0.0073}, {"gamma_F_deg", 0.49}}},
    {"Ia", "vps", depth, k_voxels, characterised, {{"leakage", 0.0046}, {"noise_F", 7.9e-5}}},
    {"Ia", "vps", depth, k_enters, characterised, {{"jump_F", 0.0031}}},
    {"Ia", "vps", depth, k_scale, scale, {{"gain_F", 123}}},
    {"Ia", "vps", depth, k_energy, characterised, {{"nu_F", 0.011}}},
    {"Ia", "vps-field", depth, k_medial, characterised, {{"sigma_F", 0.023}, {"gamma_F_deg", 0.39}}},
    {"Ia", "vps-field", depth, k_medial, characterised, {{"leakage", 0.024}, {"noise_F", 8.7e-10}}},
    {"Ia", "vps-field", depth, k_slope, characterised, {{"jump_F", 0.00033}}},
    {"Ia", "vps-field", depth, k_scale, scale, {{"gain_F", 148}}},
    {"Ia", "vps-field", depth, k_energy, characterised, {{"nu_F", 0.0059}}},
    {"Ia", "ist", volume, k_cones, characterised, {{"sigma_F", 0.12}, {"gamma_F_deg", 0.86}}},
    {"Ia", "ist", volume, k_cones, characterised, {{"leakage", 0.0088}, {"noise_F", 0.0055}}},
    {"Ia", "ist", volume, k_slope, characterised, {{"jump_F", 0.00042}}},
    {"Ia", "ist", volume, k_scale, scale, {{"gain_F", 0.645}}},
    {"Ia", "ist", volume, k_energy, characterised, {{"nu_F", 0.21}}},
    {"Ia", "ist-10000", volume, k_cones, characterised, {{"sigma_F", 0.26}, {"gamma_F_deg", 1.5}}},
    {"Ia", "ist-10000", volume, k_cones, characterised, {{"leakage", 0.016}, {"noise_F", 0.026}}},
    {"Ia", "ist-10000", volume, k_slope, characterised, {{"jump_F", 0.00041}}},
    {"Ia", "ist-10000", volume, k_scale, scale, {{"gain_F", 0.522}}},
    {"Ia", "ist-10000", volume, k_energy, characterised, {{"nu_F", 0.61}}},
    {"Ia", "ist-volume", volume, k_inside, characterised, {{"sigma_F", 0.58}, {"gamma_F_deg", 28}}},
    {"Ia", "ist-volume", volume, k_inside, characterised, {{"leakage", 0.25}, {"noise_F", 0.55}}},
    {"Ia", "ist-volume", volume, k_slope, characterised, {{"jump_F", 0.0013}}},
    {"Ia", "ist-volume", volume, k_scale, scale, {{"gain_F", 0.326}}},
    {"Ia", "ist-volume", volume, k_energy, characterised, {{"nu_F", 2.5}}},
    {"Ia", "ist-descent", volume, k_gaps, characterised, {{"sigma_F", 0.12}, {"gamma_F_deg", 7.4}}},
    {"Ia", "ist-descent", volume, k_gaps, characterised, {{"leakage", 0.066}, {"noise_F", 0.021}}},
    {"Ia", "ist-descent", volume, k_slope, characterised, {{"jump_F", 0.0023}}},
    {"Ia", "ist-descent", volume, k_scale, scale, {{"gain_F", 0.917}}},
    {"Ia", "ist-descent", volume, k_energy, characterised, {{"nu_F", 0.26}}},
    {"Ia", "fcl-contacts", depth, k_pairs, characterised, {{"sigma_F", 0.0038}, {"gamma_F_deg", 0.018}}},
    {"Ia", "fcl-contacts", depth, k_pairs, characterised, {{"leakage", 0.038}, {"noise_F", 8.9e-6}}},
    {"Ia", "fcl-contacts", depth, k_set, characterised, {{"jump_F", 0.43}}},
    {"Ia", "fcl-contacts", depth, k_scale, scale, {{"gain_F", 0.999}}},
    {"Ia", "fcl-contacts", depth, k_energy, characterised, {{"nu_F", 0.0019}}},
    {"Ib", "exact", gradient, k_flat, required, {{"sigma_F", k_rounding}, {"noise_F", k_rounding}}},
    {"Ib", "exact", gradient, k_flat, required, {{"gain_F", k_rounding}, {"nu_F", k_rounding}}},
    {"Ib", "exact", gradient, k_regular, required, {{"gamma_F_deg", k_rounding}, {"leakage", k_rounding}}},
    {"Ib", "exact", gradient, k_slope, characterised, {{"jump_F", 0.0043}}},
    {"Ib", "exact", volume, k_flat, required, {{"sigma_F", k_rounding}}},
    {"Ib", "exact", volume, k_regular, required, {{"gamma_F_deg", k_rounding}}},
    {"Ib", "vps", depth, k_thin, characterised, {{"sigma_F", 0.28}, {"gamma_F_deg", 8.9}}},
    {"Ib", "vps", depth, k_thin, characterised, {{"leakage", 0.024}, {"noise_F", 0.052}}},
    {"Ib", "vps", depth, k_enters, characterised, {{"jump_F", 0.016}}},
    {"Ib", "vps", depth, k_scale, scale, {{"gain_F", 3.31}}},
    {"Ib", "vps", depth, k_energy, characterised, {{"nu_F", 0.62}}},
    {"Ib", "vps-field", depth, k_thin_field, weakness, {{"sigma_F", k_none}, {"misses", k_none}}},
    {"Ib", "ist", volume, k_cones, characterised, {{"sigma_F", 0.54}, {"gamma_F_deg", 18}}},
    {"Ib", "ist", volume, k_cones, characterised, {{"leakage", 0.073}, {"noise_F", 0.2}}},
    {"Ib", "ist", volume, k_slope, characterised, {{"jump_F", 0.0065}}},
    {"Ib", "ist", volume, k_scale, scale, {{"gain_F", 0.00038}}},
    {"Ib", "ist", volume, k_energy, characterised, {{"nu_F", 2.7}}},
    {"Ib", "ist-volume", volume, k_thin_spheres, characterised, {{"sigma_F", 0.63}, {"leakage", 0.31}}},
    {"Ib", "ist-volume", volume, k_thin_spheres, weakness, {{"gamma_F_deg", k_none}, {"noise_F", k_none}}},
    {"Ib", "ist-volume", volume, k_slope, characterised, {{"jump_F", 0.011}}},
    {"Ib", "ist-volume", volume, k_scale, scale, {{"gain_F", 0.000168}}},
    {"Ib", "ist-volume", volume, k_energy, characterised, {{"nu_F", 4.2}}},
    {"Ib", "ist-descent", volume, k_swallowed, characterised, {{"sigma_F", 0.61}, {"misses", 22}}},
    {"Ib", "ist-descent", volume, k_thin_spheres, weakness, {{"gamma_F_deg", k_none}}},
    {"Ib", "ist-descent", volume, k_scale, scale, {{"gain_F", 0.661}}},
    {"Ib", "ist-descent", volume, k_energy, characterised, {{"nu_F", 3}}},
    {"Ib", "fcl-contacts", depth, k_pairs, characterised, {{"sigma_F", 0.015}, {"leakage", 0.031}}},
    {"Ib", "fcl-contacts", depth, k_pairs, characterised, {{"noise_F", 8.1e-5}}},
    {"Ib", "fcl-contacts", depth, k_blind, weakness, {{"gamma_F_deg", k_none}}},
    {"Ib", "fcl-contacts", depth, k_set, characterised, {{"jump_F", 0.22}}},
    {"Ib", "fcl-contacts", depth, k_scale, scale, {{"gain_F", 1}}},
    {"Ib", "fcl-contacts", depth, k_energy, characterised, {{"nu_F", 0.012}}},
    {"II", "exact", gradient, k_facets, characterised, {{"sigma_F", 0.00011}, {"gamma_F_deg", 0.0041}}},
    {"II", "exact", gradient, k_facets, characterised, {{"leakage", 8e-5}, {"noise_F", 1e-8}}},
    {"II", "exact", gradient, k_facets, characterised, {{"gain_F", 7.8e-5}, {"nu_F", 0.00018}}},
    {"II", "exact", gradient, k_no_memory, required, {{"lag", k_rounding}}},
    {"II", "exact", gradient, k_conservative, required, {{"loop_work", k_rounding}}},
    {"II", "exact", gradient, k_slope, characterised, {{"jump_F", 3.1e-5}}},
    {"II", "exact", volume, k_facets, characterised, {{"sigma_F", 0.00011}, {"gamma_F_deg", 0.0041}}},
    {"II", "vps", depth, k_voxels, characterised, {{"sigma_F", 0.0084}, {"gamma_F_deg", 0.11}}},
    {"II", "vps", depth, k_voxels, characterised, {{"leakage", 4.4e-5}, {"noise_F", 1.2e-6}}},
    {"II", "vps", depth, k_voxels, characterised, {{"loop_work", 1.6e-7}}},
    {"II", "vps", depth, k_no_memory, characterised, {{"lag", 0.00016}}},
    {"II", "vps", depth, k_enters, characterised, {{"jump_F", 0.00021}}},
    {"II", "vps", depth, k_scale, scale, {{"gain_F", 570}}},
    {"II", "vps", depth, k_energy, characterised, {{"nu_F", 0.015}}},
    {"II", "vps-field", depth, k_points, characterised, {{"sigma_F", 0.00048}, {"gamma_F_deg", 0.0017}}},
    {"II", "vps-field", depth, k_points, characterised, {{"leakage", 2e-5}, {"noise_F", 2.8e-8}}},
    {"II", "vps-field", depth, k_points, characterised, {{"loop_work", 3e-8}}},
    {"II", "vps-field", depth, k_no_memory, characterised, {{"lag", 1.4e-6}}},
    {"II", "vps-field", depth, k_slope, characterised, {{"jump_F", 3.1e-5}}},
    {"II", "vps-field", depth, k_scale, scale, {{"gain_F", 623}}},
    {"II", "vps-field", depth, k_energy, characterised, {{"nu_F", 0.00087}}},
    {"II", "ist", volume, k_packing, characterised, {{"sigma_F", 0.0011}, {"noise_F", 1.1e-7}}},
    {"II", "ist", volume, k_edge_cones, characterised, {{"gamma_F_deg", 3.4}, {"leakage", 0.043}}},
    {"II", "ist", volume, k_edge_cones, characterised, {{"loop_work", 4.3e-5}}},
    {"II", "ist", volume, k_no_memory, characterised, {{"lag", 0.0014}}},
    {"II", "ist", volume, k_slope, characterised, {{"jump_F", 3.1e-5}}},
    {"II", "ist", volume, k_scale, scale, {{"gain_F", 0.928}}},
    {"II", "ist", volume, k_energy, characterised, {{"nu_F", 0.0021}}},
    {"II", "ist-10000", volume, k_packing, characterised, {{"sigma_F", 0.0077}, {"noise_F", 4.4e-6}}},
    {"II", "ist-10000", volume, k_edge_cones, characterised, {{"gamma_F_deg", 8.2}, {"leakage", 0.11}}},
    {"II", "ist-10000", volume, k_edge_cones, characterised, {{"loop_work", 0.00056}}},
    {"II", "ist-10000", volume, k_no_memory, characterised, {{"lag", 0.019}}},
    {"II", "ist-10000", volume, k_slope, characterised, {{"jump_F", 3.3e-5}}},
    {"II", "ist-10000", volume, k_scale, scale, {{"gain_F", 0.796}}},
    {"II", "ist-10000", volume, k_energy, characterised, {{"nu_F", 0.013}}},
    {"II", "ist-volume", volume, k_packing, characterised, {{"sigma_F", 0.0057}, {"gamma_F_deg", 1.3}}},
    {"II", "ist-volume", volume, k_packing, characterised, {{"leakage", 0.00011}, {"noise_F", 2.9e-6}}},
    {"II", "ist-volume", volume, k_packing, characterised, {{"loop_work", 1.8e-7}}},
    {"II", "ist-volume", volume, k_no_memory, characterised, {{"lag", 7.9e-5}}},
    {"II", "ist-volume", volume, k_slope, characterised, {{"jump_F", 3.2e-5}}},
    {"II", "ist-volume", volume, k_scale, scale, {{"gain_F", 0.765}}},
    {"II", "ist-volume", volume, k_energy, characterised, {{"nu_F", 0.0099}}},
    {"II", "ist-descent", volume, k_gaps, characterised, {{"sigma_F", 0.0042}, {"gamma_F_deg", 0.27}}},
    {"II", "ist-descent", volume, k_gaps, characterised, {{"leakage", 0.00011}, {"noise_F", 1.2e-5}}},
    {"II", "ist-descent", volume, k_gaps, characterised, {{"loop_work", 5.7e-6}}},
    {"II", "ist-descent", volume, k_no_memory, characterised, {{"lag", 8.4e-5}}},
    {"II", "ist-descent", volume, k_slope, characterised, {{"jump_F", 5.7e-5}}},
    {"II", "ist-descent", volume, k_scale, scale, {{"gain_F", 0.98}}},
    {"II", "ist-descent", volume, k_energy, characterised, {{"nu_F", 0.0074}}},
    {"II", "fcl-contacts", depth, k_pairs, characterised, {{"sigma_F", 0.091}, {"gamma_F_deg", 0.55}}},
    {"II", "fcl-contacts", depth, k_pairs, characterised, {{"leakage", 0.041}, {"noise_F", 0.0035}}},
    {"II", "fcl-contacts", depth, k_pairs, characterised, {{"lag", 2.8e-5}, {"loop_work", 8.2e-7}}},
    {"II", "fcl-contacts", depth, k_set, characterised, {{"jump_F", 0.03}}},
    {"II", "fcl-contacts", depth, k_scale, scale, {{"gain_F", 0.0796}}},
    {"II", "fcl-contacts", depth, k_energy, characterised, {{"nu_F", 0.16}}},
    {"III", "exact", gradient, k_flat, required, {{"sigma_T", k_rounding}, {"gamma_T_deg", k_rounding}}},
    {"III", "exact", gradient, k_flat, required, {{"noise_T", k_rounding}, {"sigma_F", k_rounding}}},
    {"III", "exact", gradient, k_flat, required, {{"gamma_F_deg", k_rounding}, {"gain_T", k_rounding}}},
    {"III", "exact", gradient, k_flat, required, {{"nu_T", k_rounding}}},
    {"III", "exact", gradient, k_kink, characterised, {{"jump_T", 1}}},
    {"III", "exact", volume, k_flat, required, {{"gamma_T_deg", k_rounding}}},
    {"III", "vps", traction, k_voxels, characterised, {{"sigma_T", 0.044}, {"gamma_T_deg", 0.3}}},
    {"III", "vps", traction, k_voxels, characterised, {{"noise_T", 0.00048}}},
    {"III", "vps", traction, k_plate, characterised, {{"leakage", 0.62}}},
    {"III", "vps", traction, k_enters, characterised, {{"jump_T", 0.0017}}},
    {"III", "vps", traction, k_scale, scale, {{"gain_T", 1}}},
    {"III", "vps", traction, k_energy, characterised, {{"nu_T", 0.11}}},
    {"III", "vps-field", wall_traction, k_edges, characterised, {{"sigma_T", 0.0023}, {"gamma_T_deg", 0.0017}}},
    {"III", "vps-field", wall_traction, k_edges, characterised, {{"leakage", 0.0019}, {"noise_T", 8.3e-8}}},
    {"III", "vps-field", wall_traction, k_slope, characterised, {{"jump_T", 1.6e-5}}},
    {"III", "vps-field", wall_traction, k_scale, scale, {{"gain_T", 0.994}}},
    {"III", "vps-field", wall_traction, k_energy, characterised, {{"nu_T", 0.0018}}},
    {"III", "ist", normals, k_cones, characterised, {{"sigma_T", 0.1}, {"gamma_T_deg", 3.3}, {"noise_T", 1.2e-7}}},
    {"III", "ist", normals, k_slope, characterised, {{"jump_T", 1.7e-5}}},
    {"III", "ist", normals, k_scale, scale, {{"gain_T", 0.386}}},
    {"III", "ist-10000", volume, k_cones, characterised, {{"sigma_T", 0.18}, {"gamma_T_deg", 6.8}}},
    {"III", "ist-10000", volume, k_cones, characterised, {{"leakage", 0.47}, {"noise_T", 2.2e-7}}},
    {"III", "ist-10000", volume, k_slope, characterised, {{"jump_T", 1.5e-5}}},
    {"III", "ist-10000", volume, k_scale, scale, {{"gain_T", 0.817}}},
    {"III", "ist-10000", volume, k_energy, characterised, {{"nu_T", 0.3}}},
    {"III", "ist-volume", volume, k_centers, characterised, {{"sigma_T", 0.17}, {"gamma_T_deg", 6.5}}},
    {"III", "ist-volume", volume, k_centers, characterised, {{"leakage", 0.25}, {"noise_T", 2.1e-5}}},
    {"III", "ist-volume", volume, k_slope, characterised, {{"jump_T", 1.5e-5}}},
    {"III", "ist-volume", volume, k_scale, scale, {{"gain_T", 0.967}}},
    {"III", "ist-volume", volume, k_energy, characterised, {{"nu_T", 0.11}}},
    {"III", "ist-descent", volume, k_gaps, characterised, {{"sigma_T", 0.071}, {"gamma_T_deg", 4.1}}},
    {"III", "ist-descent", volume, k_gaps, characterised, {{"leakage", 0.13}, {"noise_T", 5.1e-5}}},
    {"III", "ist-descent", volume, k_slope, characterised, {{"jump_T", 1.8e-5}}},
    {"III", "ist-descent", volume, k_scale, scale, {{"gain_T", 14.2}}},
    {"III", "ist-descent", volume, k_energy, characterised, {{"nu_T", 0.081}}},
    {"III", "fcl-contacts", depth, k_pairs, weakness, {{"sigma_T", k_none}}},
    {"III", "fcl-contacts", depth, k_sign, weakness, {{"gamma_T_deg", k_none}}},
    {"III", "fcl-contacts", depth, k_pairs, characterised, {{"leakage", 0.15}, {"noise_T", 0.0055}}},
    {"III", "fcl-contacts", depth, k_set, characterised, {{"jump_T", 0.56}}},
    {"III", "fcl-contacts", depth, k_scale, scale, {{"gain_T", 11.3}}},
    {"III", "fcl-contacts", depth, k_energy, characterised, {{"nu_T", 1.1}}},
    {"IV", "exact", gradient, k_facets, characterised, {{"sigma_F", 7e-5}, {"gamma_F_deg", 0.0078}}},
    {"IV", "exact", gradient, k_facets, characterised, {{"sigma_T", 0.0003}, {"gamma_T_deg", 0.051}}},
    {"IV", "exact", gradient, k_facets, characterised, {{"noise_F", 2.6e-8}, {"gain_F", 3e-6}}},
    {"IV", "exact", gradient, k_facets, characterised, {{"nu_F", 1e-5}}},
    {"IV", "exact", gradient, k_no_memory, required, {{"lag", k_rounding}}},
    {"IV", "exact", gradient, k_conservative, required, {{"loop_work", k_rounding}}},
    {"IV", "exact", gradient, k_kink, characterised, {{"jump_F", 0.78}}},
    {"IV", "vps", traction, k_snug, characterised, {{"sigma_F", 0.088}, {"gamma_F_deg", 2.9}}},
    {"IV", "vps", traction, k_snug, characterised, {{"sigma_T", 0.28}, {"gamma_T_deg", 26}}},
    {"IV", "vps", traction, k_snug, characterised, {{"noise_F", 6.9e-5}}},
    {"IV", "vps", depth, k_snug, characterised, {{"leakage", 0.11}}},
    {"IV", "vps", traction, k_no_memory, characterised, {{"lag", 0.028}}},
    {"IV", "vps", traction, k_voxels, characterised, {{"loop_work", 0.00065}}},
    {"IV", "vps", traction, k_enters, characterised, {{"jump_F", 0.00023}}},
    {"IV", "vps", traction, k_scale, scale, {{"gain_F", 0.967}}},
    {"IV", "vps", traction, k_energy, characterised, {{"nu_F", 0.16}}},
    {"IV", "vps-field", wall_traction, k_edges, characterised, {{"sigma_F", 0.00062}, {"gamma_F_deg", 0.042}}},
    {"IV", "vps-field", wall_traction, k_edges, characterised, {{"sigma_T", 0.0093}, {"gamma_T_deg", 0.13}}},
    {"IV", "vps-field", wall_traction, k_edges, characterised, {{"noise_F", 1.4e-7}}},
    {"IV", "vps-field", depth, k_edges, characterised, {{"leakage", 0.073}}},
    {"IV", "vps-field", wall_traction, k_no_memory, characterised, {{"lag", 7e-6}}},
    {"IV", "vps-field", wall_traction, k_points, characterised, {{"loop_work", 1.6e-7}}},
    {"IV", "vps-field", wall_traction, k_slope, characterised, {{"jump_F", 3.3e-5}}},
    {"IV", "vps-field", wall_traction, k_scale, scale, {{"gain_F", 0.997}}},
    {"IV", "vps-field", wall_traction, k_energy, characterised, {{"nu_F", 0.00086}}},
    {"IV", "ist", volume, k_cones, characterised, {{"sigma_F", 0.078}, {"noise_F", 4.1e-5}}},
    {"IV", "ist", volume, k_edge_cones, characterised, {{"gamma_F_deg", 5.8}, {"sigma_T", 0.44}}},
    {"IV", "ist", volume, k_edge_cones, characterised, {{"gamma_T_deg", 79}, {"loop_work", 0.0022}}},
    {"IV", "ist", volume, k_no_memory, characterised, {{"lag", 0.084}}},
    {"IV", "ist", volume, k_slope, characterised, {{"jump_F", 3.7e-5}}},
    {"IV", "ist", volume, k_scale, scale, {{"gain_F", 0.334}}},
    {"IV", "ist", volume, k_energy, characterised, {{"nu_F", 0.0068}}},
    {"IV", "ist-volume", volume, k_centers, characterised, {{"sigma_F", 0.062}, {"gamma_F_deg", 2.7}}},
    {"IV", "ist-volume", volume, k_centers, characterised, {{"sigma_T", 0.47}, {"noise_F", 5.6e-5}}},
    {"IV", "ist-volume", volume, k_centers, characterised, {{"loop_work", 6.9e-7}}},
    {"IV", "ist-volume", volume, k_centers, weakness, {{"gamma_T_deg", k_none}}},
    {"IV", "ist-volume", volume, k_packing, characterised, {{"lag", 0.015}}},
    {"IV", "ist-volume", volume, k_slope, characterised, {{"jump_F", 3.6e-5}}},
    {"IV", "ist-volume", volume, k_scale, scale, {{"gain_F", 0.256}}},
    {"IV", "ist-volume", volume, k_energy, characterised, {{"nu_F", 0.021}}},
    {"IV", "ist-descent", volume, k_gaps, characterised, {{"sigma_F", 0.041}, {"noise_F", 0.00052}}},
    {"IV", "ist-descent", volume, k_gaps, characterised, {{"loop_work", 0.00049}}},
    {"IV", "ist-descent", volume, k_steepest, characterised, {{"gamma_F_deg", 8.9}, {"sigma_T", 0.54}}},
    {"IV", "ist-descent", volume, k_steepest, characterised, {{"gamma_T_deg", 44}}},
    {"IV", "ist-descent", volume, k_no_memory, characterised, {{"lag", 0.011}}},
    {"IV", "ist-descent", volume, k_slope, characterised, {{"jump_F", 6.6e-5}}},
    {"IV", "ist-descent", volume, k_scale, scale, {{"gain_F", 0.854}}},
    {"IV", "ist-descent", volume, k_energy, characterised, {{"nu_F", 0.071}}},
    {"IV", "fcl-contacts", depth, k_pairs, characterised, {{"sigma_F", 0.32}, {"gamma_F_deg", 13}}},
    {"IV", "fcl-contacts", depth, k_pairs, characterised, {{"leakage", 1.4}, {"noise_F", 0.015}}},
    {"IV", "fcl-contacts", depth, k_pairs, characterised, {{"loop_work", 0.12}}},
    {"IV", "fcl-contacts", depth, k_pairs, weakness, {{"lag", k_none}}},
    {"IV", "fcl-contacts", depth, k_set, characterised, {{"jump_F", 0.46}}},
    {"IV", "fcl-contacts", depth, k_scale, scale, {{"gain_F", 0.0467}}},
    {"IV", "fcl-contacts", depth, k_energy, characterised, {{"nu_F", 0.98}}},
  };
  return lines;
}
// clang-format on

/// Every subject answers every step and does not tunnel, unless a row says otherwise.
void add_bounds_of_counts(std::vector<Bound>& list) {
  const auto has = [&](const Bound& subject, std::string_view measure) {
    return std::ranges::any_of(list, [&](const Bound& b) {
      return b.scenario == subject.scenario && b.algorithm == subject.algorithm && b.measure == measure;
    });
  };
  const std::vector<Bound> rows = list;
  for (const Bound& row : rows) {
    const auto add = [&](std::string_view measure, std::string_view reason) {
      if (!has(row, measure)) list.push_back({row.scenario, row.algorithm, row.law, measure, 0.0, reason, required});
    };
    add("misses", "does not tunnel");
    add("failed", "answers every step");
  }
}

/// How far a value is from the best one: 0 there, larger where it is worse.
double defect(const Bound& bound, double value) {
  const bool best_is_one = bound.measure.starts_with("nu") || bound.measure.starts_with("gain");
  return best_is_one ? std::max(value, 1.0 / value) - 1.0 : std::abs(value);
}

}  // namespace

std::string_view to_string(Kind kind) {
  constexpr std::string_view k_names[] = {"characterised", "required", "scale", "weakness"};
  return k_names[static_cast<std::size_t>(kind)];
}

Subject subject(std::string_view name) {
  // V along lines of centres instead of normal cones.
  if (name == "ist-volume") return {"ist", {"force=volume", "spheres=10000"}};
  // Of the paper's paths, where the default is finer.
  if (name == "ist-10000") return {"ist", {"spheres=10000"}};
  return {std::string(name), {}};
}

std::span<const Bound> bounds() {
  static const std::vector<Bound> all = [] {
    Registry registry;
    register_all_algorithms(registry);
    const auto is_built = [&](const BoundLine& line) {
      const std::string name = subject(line.algorithm).algorithm;
      return std::ranges::any_of(registry.all(), [&](const auto& a) { return a->traits().name == name; });
    };
    std::vector<Bound> list;
    const auto add = [&](const BoundLine& line) {
      for (const auto& [measure, bound] : line.measures) {
        list.push_back({line.scenario, line.algorithm, line.law, measure, bound, line.reason, line.kind});
      }
    };
    std::ranges::for_each(own_lines(), add);
    for (const std::vector<BoundLine>* const lines : {&backend_bounds(), &signal_bounds()}) {
      for (const BoundLine& line : *lines) {
        if (is_built(line)) add(line);
      }
    }
    add_bounds_of_counts(list);
    return list;
  }();
  return all;
}

double worst_value(std::string_view measure) {
  if (measure.starts_with("gamma")) return 180.0;  // degrees
  if (measure.starts_with("sigma")) return 1.0;    // difference of two magnitudes in 0..1
  return std::numeric_limits<double>::infinity();
}

double largest_defect(const Bound& bound) {
  if (bound.kind == required) return bound.bound;
  return std::min(k_margin * bound.bound, 0.5 * (bound.bound + worst_value(bound.measure)));
}

double smallest_defect(const Bound& bound) {
  const bool is_error = bound.measure.starts_with("sigma") || bound.measure.starts_with("gamma");
  return bound.kind == characterised && is_error ? bound.bound / k_better_margin : 0.0;
}

bool holds(const Bound& bound, double value) {
  if (bound.kind == weakness) return true;
  if (bound.kind == scale) return value >= bound.bound / k_scale_margin && value <= bound.bound * k_scale_margin;
  return defect(bound, value) <= largest_defect(bound) && defect(bound, value) >= smallest_defect(bound);
}

}  // namespace sixdof
