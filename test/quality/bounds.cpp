#include "bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "backend_bounds.h"
#include "bench/common/all_algorithms.h"

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
constexpr std::string_view k_packing = "default packing of spheres; unfilled volume does not count";
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

// One row per line.
// clang-format off
constexpr std::array k_bounds{
    // scenario, algorithm, law, measure, bound, reason, kind; every subject has zero misses and failures besides
    Bound{"Ia",  "vps",          depth,         "sigma_F",     0.043,      k_paper, required},
    Bound{"Ia",  "ist-descent",  volume,        "sigma_F",     0.176,      k_paper, required},
    Bound{"II",  "vps",          depth,         "gamma_F_deg", 2.40,       k_paper, required},
    Bound{"II",  "ist-descent",  volume,        "gamma_F_deg", 7.64,       k_paper, required},
    Bound{"III", "vps",          traction,      "sigma_T",     0.169,      k_paper, required},
    Bound{"III", "ist-descent",  volume,        "sigma_T",     0.112,      k_paper, required},
    Bound{"Ia",  "exact",        gradient,      "sigma_F",     k_rounding, k_flat, required},
    Bound{"Ia",  "exact",        gradient,      "gamma_F_deg", k_rounding, k_regular, required},
    Bound{"Ia",  "exact",        gradient,      "leakage",     k_rounding, k_regular, required},
    Bound{"Ia",  "exact",        gradient,      "noise_F",     k_rounding, k_flat, required},
    Bound{"Ia",  "exact",        gradient,      "jump_F",      0.00047,    k_slope},
    Bound{"Ia",  "exact",        volume,        "sigma_F",     k_rounding, k_flat, required},
    Bound{"Ia",  "exact",        volume,        "gamma_F_deg", k_rounding, k_regular, required},
    Bound{"Ia",  "exact",        gradient,      "gain_F",      k_rounding, k_flat, required},
    Bound{"Ia",  "exact",        gradient,      "nu_F",        k_rounding, k_flat, required},
    Bound{"Ia",  "vps",          depth,         "sigma_F",     0.0073,     k_voxels},
    Bound{"Ia",  "vps",          depth,         "gamma_F_deg", 0.49,       k_voxels},
    Bound{"Ia",  "vps",          depth,         "leakage",     0.0046,     k_voxels},
    Bound{"Ia",  "vps",          depth,         "noise_F",     7.9e-5,     k_voxels},
    Bound{"Ia",  "vps",          depth,         "jump_F",      0.0031,     k_enters},
    Bound{"Ia",  "vps",          depth,         "gain_F",      123,        k_scale, scale},
    Bound{"Ia",  "vps",          depth,         "nu_F",        0.011,      k_energy},
    Bound{"Ia",  "vps-field",    depth,         "sigma_F",     0.023,      k_medial},
    Bound{"Ia",  "vps-field",    depth,         "gamma_F_deg", 0.39,       k_medial},
    Bound{"Ia",  "vps-field",    depth,         "leakage",     0.024,      k_medial},
    Bound{"Ia",  "vps-field",    depth,         "noise_F",     8.7e-10,    k_medial},
    Bound{"Ia",  "vps-field",    depth,         "jump_F",      0.00033,    k_slope},
    Bound{"Ia",  "vps-field",    depth,         "gain_F",      148,        k_scale, scale},
    Bound{"Ia",  "vps-field",    depth,         "nu_F",        0.0059,     k_energy},
    Bound{"Ia",  "ist",          volume,        "sigma_F",     0.26,       k_cones},
    Bound{"Ia",  "ist",          volume,        "gamma_F_deg", 1.5,        k_cones},
    Bound{"Ia",  "ist",          volume,        "leakage",     0.016,      k_cones},
    Bound{"Ia",  "ist",          volume,        "noise_F",     0.026,      k_cones},
    Bound{"Ia",  "ist",          volume,        "jump_F",      0.00041,    k_slope},
    Bound{"Ia",  "ist",          volume,        "gain_F",      0.522,      k_scale, scale},
    Bound{"Ia",  "ist",          volume,        "nu_F",        0.61,       k_energy},
    Bound{"Ia",  "ist-volume",   volume,        "sigma_F",     0.58,       k_inside},
    Bound{"Ia",  "ist-volume",   volume,        "gamma_F_deg", 28,         k_inside},
    Bound{"Ia",  "ist-volume",   volume,        "leakage",     0.25,       k_inside},
    Bound{"Ia",  "ist-volume",   volume,        "noise_F",     0.55,       k_inside},
    Bound{"Ia",  "ist-volume",   volume,        "jump_F",      0.0013,     k_slope},
    Bound{"Ia",  "ist-volume",   volume,        "gain_F",      0.326,      k_scale, scale},
    Bound{"Ia",  "ist-volume",   volume,        "nu_F",        2.5,        k_energy},
    Bound{"Ia",  "ist-descent",  volume,        "sigma_F",     0.12,       k_gaps},
    Bound{"Ia",  "ist-descent",  volume,        "gamma_F_deg", 7.4,        k_gaps},
    Bound{"Ia",  "ist-descent",  volume,        "leakage",     0.066,      k_gaps},
    Bound{"Ia",  "ist-descent",  volume,        "noise_F",     0.021,      k_gaps},
    Bound{"Ia",  "ist-descent",  volume,        "jump_F",      0.0023,     k_slope},
    Bound{"Ia",  "ist-descent",  volume,        "gain_F",      0.917,      k_scale, scale},
    Bound{"Ia",  "ist-descent",  volume,        "nu_F",        0.26,       k_energy},
    Bound{"Ia",  "fcl-contacts", depth,         "sigma_F",     0.0038,     k_pairs},
    Bound{"Ia",  "fcl-contacts", depth,         "gamma_F_deg", 0.018,      k_pairs},
    Bound{"Ia",  "fcl-contacts", depth,         "leakage",     0.038,      k_pairs},
    Bound{"Ia",  "fcl-contacts", depth,         "noise_F",     8.9e-6,     k_pairs},
    Bound{"Ia",  "fcl-contacts", depth,         "jump_F",      0.43,       k_set},
    Bound{"Ia",  "fcl-contacts", depth,         "gain_F",      0.999,      k_scale, scale},
    Bound{"Ia",  "fcl-contacts", depth,         "nu_F",        0.0019,     k_energy},
    Bound{"Ib",  "exact",        gradient,      "sigma_F",     k_rounding, k_flat, required},
    Bound{"Ib",  "exact",        gradient,      "gamma_F_deg", k_rounding, k_regular, required},
    Bound{"Ib",  "exact",        gradient,      "leakage",     k_rounding, k_regular, required},
    Bound{"Ib",  "exact",        gradient,      "noise_F",     k_rounding, k_flat, required},
    Bound{"Ib",  "exact",        gradient,      "jump_F",      0.0043,     k_slope},
    Bound{"Ib",  "exact",        volume,        "sigma_F",     k_rounding, k_flat, required},
    Bound{"Ib",  "exact",        volume,        "gamma_F_deg", k_rounding, k_regular, required},
    Bound{"Ib",  "exact",        gradient,      "gain_F",      k_rounding, k_flat, required},
    Bound{"Ib",  "exact",        gradient,      "nu_F",        k_rounding, k_flat, required},
    Bound{"Ib",  "vps",          depth,         "sigma_F",     0.28,       k_thin},
    Bound{"Ib",  "vps",          depth,         "gamma_F_deg", 8.9,        k_thin},
    Bound{"Ib",  "vps",          depth,         "leakage",     0.024,      k_thin},
    Bound{"Ib",  "vps",          depth,         "noise_F",     0.052,      k_thin},
    Bound{"Ib",  "vps",          depth,         "jump_F",      0.016,      k_enters},
    Bound{"Ib",  "vps",          depth,         "gain_F",      3.31,       k_scale, scale},
    Bound{"Ib",  "vps",          depth,         "nu_F",        0.62,       k_energy},
    Bound{"Ib",  "vps-field",    depth,         "sigma_F",     k_none,     k_thin_field, weakness},
    Bound{"Ib",  "vps-field",    depth,         "misses",      k_none,     k_thin_field, weakness},
    Bound{"Ib",  "ist",          volume,        "sigma_F",     0.54,       k_cones},
    Bound{"Ib",  "ist",          volume,        "gamma_F_deg", 18,         k_cones},
    Bound{"Ib",  "ist",          volume,        "leakage",     0.073,      k_cones},
    Bound{"Ib",  "ist",          volume,        "noise_F",     0.2,        k_cones},
    Bound{"Ib",  "ist",          volume,        "jump_F",      0.0065,     k_slope},
    Bound{"Ib",  "ist",          volume,        "gain_F",      0.00038,    k_scale, scale},
    Bound{"Ib",  "ist",          volume,        "nu_F",        2.7,        k_energy},
    Bound{"Ib",  "ist-volume",   volume,        "sigma_F",     0.63,       k_thin_spheres},
    Bound{"Ib",  "ist-volume",   volume,        "gamma_F_deg", k_none,     k_thin_spheres, weakness},
    Bound{"Ib",  "ist-volume",   volume,        "leakage",     0.31,       k_thin_spheres},
    Bound{"Ib",  "ist-volume",   volume,        "noise_F",     k_none,     k_thin_spheres, weakness},
    Bound{"Ib",  "ist-volume",   volume,        "jump_F",      0.011,      k_slope},
    Bound{"Ib",  "ist-volume",   volume,        "gain_F",      0.000168,   k_scale, scale},
    Bound{"Ib",  "ist-volume",   volume,        "nu_F",        4.2,        k_energy},
    Bound{"Ib",  "ist-descent",  volume,        "sigma_F",     0.61,       k_swallowed},
    Bound{"Ib",  "ist-descent",  volume,        "gamma_F_deg", k_none,     k_thin_spheres, weakness},
    Bound{"Ib",  "ist-descent",  volume,        "misses",      22,         k_swallowed},
    Bound{"Ib",  "ist-descent",  volume,        "gain_F",      0.661,      k_scale, scale},
    Bound{"Ib",  "ist-descent",  volume,        "nu_F",        3,          k_energy},
    Bound{"Ib",  "fcl-contacts", depth,         "sigma_F",     0.015,      k_pairs},
    Bound{"Ib",  "fcl-contacts", depth,         "gamma_F_deg", k_none,     k_blind, weakness},
    Bound{"Ib",  "fcl-contacts", depth,         "leakage",     0.031,      k_pairs},
    Bound{"Ib",  "fcl-contacts", depth,         "noise_F",     8.1e-5,     k_pairs},
    Bound{"Ib",  "fcl-contacts", depth,         "jump_F",      0.22,       k_set},
    Bound{"Ib",  "fcl-contacts", depth,         "gain_F",      1,          k_scale, scale},
    Bound{"Ib",  "fcl-contacts", depth,         "nu_F",        0.012,      k_energy},
    Bound{"II",  "exact",        gradient,      "sigma_F",     0.00011,    k_facets},
    Bound{"II",  "exact",        gradient,      "gamma_F_deg", 0.0041,     k_facets},
    Bound{"II",  "exact",        gradient,      "leakage",     8e-5,       k_facets},
    Bound{"II",  "exact",        gradient,      "noise_F",     1e-8,       k_facets},
    Bound{"II",  "exact",        gradient,      "lag",         k_rounding, k_no_memory, required},
    Bound{"II",  "exact",        gradient,      "loop_work",   k_rounding, k_conservative, required},
    Bound{"II",  "exact",        gradient,      "jump_F",      3.1e-5,     k_slope},
    Bound{"II",  "exact",        volume,        "sigma_F",     0.00011,    k_facets},
    Bound{"II",  "exact",        volume,        "gamma_F_deg", 0.0041,     k_facets},
    Bound{"II",  "exact",        gradient,      "gain_F",      7.8e-5,     k_facets},
    Bound{"II",  "exact",        gradient,      "nu_F",        0.00018,    k_facets},
    Bound{"II",  "vps",          depth,         "sigma_F",     0.0084,     k_voxels},
    Bound{"II",  "vps",          depth,         "gamma_F_deg", 0.11,       k_voxels},
    Bound{"II",  "vps",          depth,         "leakage",     4.4e-5,     k_voxels},
    Bound{"II",  "vps",          depth,         "noise_F",     1.2e-6,     k_voxels},
    Bound{"II",  "vps",          depth,         "lag",         0.00016,    k_no_memory},
    Bound{"II",  "vps",          depth,         "loop_work",   1.6e-7,     k_voxels},
    Bound{"II",  "vps",          depth,         "jump_F",      0.00021,    k_enters},
    Bound{"II",  "vps",          depth,         "gain_F",      570,        k_scale, scale},
    Bound{"II",  "vps",          depth,         "nu_F",        0.015,      k_energy},
    Bound{"II",  "vps-field",    depth,         "sigma_F",     0.00048,    k_points},
    Bound{"II",  "vps-field",    depth,         "gamma_F_deg", 0.0017,     k_points},
    Bound{"II",  "vps-field",    depth,         "leakage",     2e-5,       k_points},
    Bound{"II",  "vps-field",    depth,         "noise_F",     2.8e-8,     k_points},
    Bound{"II",  "vps-field",    depth,         "lag",         1.4e-6,     k_no_memory},
    Bound{"II",  "vps-field",    depth,         "loop_work",   3e-8,       k_points},
    Bound{"II",  "vps-field",    depth,         "jump_F",      3.1e-5,     k_slope},
    Bound{"II",  "vps-field",    depth,         "gain_F",      623,        k_scale, scale},
    Bound{"II",  "vps-field",    depth,         "nu_F",        0.00087,    k_energy},
    Bound{"II",  "ist",          volume,        "sigma_F",     0.0077,     k_packing},
    Bound{"II",  "ist",          volume,        "gamma_F_deg", 8.2,        k_edge_cones},
    Bound{"II",  "ist",          volume,        "leakage",     0.11,       k_edge_cones},
    Bound{"II",  "ist",          volume,        "noise_F",     4.4e-6,     k_packing},
    Bound{"II",  "ist",          volume,        "lag",         0.019,      k_no_memory},
    Bound{"II",  "ist",          volume,        "loop_work",   0.00056,    k_edge_cones},
    Bound{"II",  "ist",          volume,        "jump_F",      3.3e-5,     k_slope},
    Bound{"II",  "ist",          volume,        "gain_F",      0.796,      k_scale, scale},
    Bound{"II",  "ist",          volume,        "nu_F",        0.013,      k_energy},
    Bound{"II",  "ist-volume",   volume,        "sigma_F",     0.0057,     k_packing},
    Bound{"II",  "ist-volume",   volume,        "gamma_F_deg", 1.3,        k_packing},
    Bound{"II",  "ist-volume",   volume,        "leakage",     0.00011,    k_packing},
    Bound{"II",  "ist-volume",   volume,        "noise_F",     2.9e-6,     k_packing},
    Bound{"II",  "ist-volume",   volume,        "lag",         7.9e-5,     k_no_memory},
    Bound{"II",  "ist-volume",   volume,        "loop_work",   1.8e-7,     k_packing},
    Bound{"II",  "ist-volume",   volume,        "jump_F",      3.2e-5,     k_slope},
    Bound{"II",  "ist-volume",   volume,        "gain_F",      0.765,      k_scale, scale},
    Bound{"II",  "ist-volume",   volume,        "nu_F",        0.0099,     k_energy},
    Bound{"II",  "ist-descent",  volume,        "sigma_F",     0.0042,     k_gaps},
    Bound{"II",  "ist-descent",  volume,        "gamma_F_deg", 0.27,       k_gaps},
    Bound{"II",  "ist-descent",  volume,        "leakage",     0.00011,    k_gaps},
    Bound{"II",  "ist-descent",  volume,        "noise_F",     1.2e-5,     k_gaps},
    Bound{"II",  "ist-descent",  volume,        "lag",         8.4e-5,     k_no_memory},
    Bound{"II",  "ist-descent",  volume,        "loop_work",   5.7e-6,     k_gaps},
    Bound{"II",  "ist-descent",  volume,        "jump_F",      5.7e-5,     k_slope},
    Bound{"II",  "ist-descent",  volume,        "gain_F",      0.98,       k_scale, scale},
    Bound{"II",  "ist-descent",  volume,        "nu_F",        0.0074,     k_energy},
    Bound{"II",  "fcl-contacts", depth,         "sigma_F",     0.091,      k_pairs},
    Bound{"II",  "fcl-contacts", depth,         "gamma_F_deg", 0.55,       k_pairs},
    Bound{"II",  "fcl-contacts", depth,         "leakage",     0.041,      k_pairs},
    Bound{"II",  "fcl-contacts", depth,         "noise_F",     0.0035,     k_pairs},
    Bound{"II",  "fcl-contacts", depth,         "lag",         2.8e-5,     k_pairs},
    Bound{"II",  "fcl-contacts", depth,         "loop_work",   8.2e-7,     k_pairs},
    Bound{"II",  "fcl-contacts", depth,         "jump_F",      0.03,       k_set},
    Bound{"II",  "fcl-contacts", depth,         "gain_F",      0.0796,     k_scale, scale},
    Bound{"II",  "fcl-contacts", depth,         "nu_F",        0.16,       k_energy},
    Bound{"III", "exact",        gradient,      "sigma_T",     k_rounding, k_flat, required},
    Bound{"III", "exact",        gradient,      "gamma_T_deg", k_rounding, k_flat, required},
    Bound{"III", "exact",        gradient,      "noise_T",     k_rounding, k_flat, required},
    Bound{"III", "exact",        gradient,      "jump_T",      1,          k_kink},
    Bound{"III", "exact",        gradient,      "sigma_F",     k_rounding, k_flat, required},
    Bound{"III", "exact",        gradient,      "gamma_F_deg", k_rounding, k_flat, required},
    Bound{"III", "exact",        volume,        "gamma_T_deg", k_rounding, k_flat, required},
    Bound{"III", "exact",        gradient,      "gain_T",      k_rounding, k_flat, required},
    Bound{"III", "exact",        gradient,      "nu_T",        k_rounding, k_flat, required},
    Bound{"III", "vps",          traction,      "sigma_T",     0.044,      k_voxels},
    Bound{"III", "vps",          traction,      "gamma_T_deg", 0.3,        k_voxels},
    Bound{"III", "vps",          traction,      "leakage",     0.62,       k_plate},
    Bound{"III", "vps",          traction,      "noise_T",     0.00048,    k_voxels},
    Bound{"III", "vps",          traction,      "jump_T",      0.0017,     k_enters},
    Bound{"III", "vps",          traction,      "gain_T",      1,          k_scale, scale},
    Bound{"III", "vps",          traction,      "nu_T",        0.11,       k_energy},
    Bound{"III", "vps-field",    wall_traction, "sigma_T",     0.0023,     k_edges},
    Bound{"III", "vps-field",    wall_traction, "gamma_T_deg", 0.0017,     k_edges},
    Bound{"III", "vps-field",    wall_traction, "leakage",     0.0019,     k_edges},
    Bound{"III", "vps-field",    wall_traction, "noise_T",     8.3e-8,     k_edges},
    Bound{"III", "vps-field",    wall_traction, "jump_T",      1.6e-5,     k_slope},
    Bound{"III", "vps-field",    wall_traction, "gain_T",      0.994,      k_scale, scale},
    Bound{"III", "vps-field",    wall_traction, "nu_T",        0.0018,     k_energy},
    Bound{"III", "ist",          volume,        "sigma_T",     0.18,       k_cones},
    Bound{"III", "ist",          volume,        "gamma_T_deg", 6.8,        k_cones},
    Bound{"III", "ist",          volume,        "leakage",     0.47,       k_cones},
    Bound{"III", "ist",          volume,        "noise_T",     2.2e-7,     k_cones},
    Bound{"III", "ist",          volume,        "jump_T",      1.5e-5,     k_slope},
    Bound{"III", "ist",          volume,        "gain_T",      0.817,      k_scale, scale},
    Bound{"III", "ist",          volume,        "nu_T",        0.3,        k_energy},
    Bound{"III", "ist-volume",   volume,        "sigma_T",     0.17,       k_centers},
    Bound{"III", "ist-volume",   volume,        "gamma_T_deg", 6.5,        k_centers},
    Bound{"III", "ist-volume",   volume,        "leakage",     0.25,       k_centers},
    Bound{"III", "ist-volume",   volume,        "noise_T",     2.1e-5,     k_centers},
    Bound{"III", "ist-volume",   volume,        "jump_T",      1.5e-5,     k_slope},
    Bound{"III", "ist-volume",   volume,        "gain_T",      0.967,      k_scale, scale},
    Bound{"III", "ist-volume",   volume,        "nu_T",        0.11,       k_energy},
    Bound{"III", "ist-descent",  volume,        "sigma_T",     0.071,      k_gaps},
    Bound{"III", "ist-descent",  volume,        "gamma_T_deg", 4.1,        k_gaps},
    Bound{"III", "ist-descent",  volume,        "leakage",     0.13,       k_gaps},
    Bound{"III", "ist-descent",  volume,        "noise_T",     5.1e-5,     k_gaps},
    Bound{"III", "ist-descent",  volume,        "jump_T",      1.8e-5,     k_slope},
    Bound{"III", "ist-descent",  volume,        "gain_T",      14.2,       k_scale, scale},
    Bound{"III", "ist-descent",  volume,        "nu_T",        0.081,      k_energy},
    Bound{"III", "fcl-contacts", depth,         "sigma_T",     k_none,     k_pairs, weakness},
    Bound{"III", "fcl-contacts", depth,         "gamma_T_deg", k_none,     k_sign, weakness},
    Bound{"III", "fcl-contacts", depth,         "leakage",     0.15,       k_pairs},
    Bound{"III", "fcl-contacts", depth,         "noise_T",     0.0055,     k_pairs},
    Bound{"III", "fcl-contacts", depth,         "jump_T",      0.56,       k_set},
    Bound{"III", "fcl-contacts", depth,         "gain_T",      11.3,       k_scale, scale},
    Bound{"III", "fcl-contacts", depth,         "nu_T",        1.1,        k_energy},
    Bound{"IV",  "exact",        gradient,      "sigma_F",     7e-5,       k_facets},
    Bound{"IV",  "exact",        gradient,      "gamma_F_deg", 0.0078,     k_facets},
    Bound{"IV",  "exact",        gradient,      "sigma_T",     0.0003,     k_facets},
    Bound{"IV",  "exact",        gradient,      "gamma_T_deg", 0.051,      k_facets},
    Bound{"IV",  "exact",        gradient,      "noise_F",     2.6e-8,     k_facets},
    Bound{"IV",  "exact",        gradient,      "lag",         k_rounding, k_no_memory, required},
    Bound{"IV",  "exact",        gradient,      "loop_work",   k_rounding, k_conservative, required},
    Bound{"IV",  "exact",        gradient,      "jump_F",      0.78,       k_kink},
    Bound{"IV",  "exact",        gradient,      "gain_F",      3e-6,       k_facets},
    Bound{"IV",  "exact",        gradient,      "nu_F",        1e-5,       k_facets},
    Bound{"IV",  "vps",          traction,      "sigma_F",     0.088,      k_snug},
    Bound{"IV",  "vps",          traction,      "gamma_F_deg", 2.9,        k_snug},
    Bound{"IV",  "vps",          traction,      "sigma_T",     0.28,       k_snug},
    Bound{"IV",  "vps",          traction,      "gamma_T_deg", 26,         k_snug},
    Bound{"IV",  "vps",          depth,         "leakage",     0.11,       k_snug},
    Bound{"IV",  "vps",          traction,      "noise_F",     6.9e-5,     k_snug},
    Bound{"IV",  "vps",          traction,      "lag",         0.028,      k_no_memory},
    Bound{"IV",  "vps",          traction,      "loop_work",   0.00065,    k_voxels},
    Bound{"IV",  "vps",          traction,      "jump_F",      0.00023,    k_enters},
    Bound{"IV",  "vps",          traction,      "gain_F",      0.967,      k_scale, scale},
    Bound{"IV",  "vps",          traction,      "nu_F",        0.16,       k_energy},
    Bound{"IV",  "vps-field",    wall_traction, "sigma_F",     0.00062,    k_edges},
    Bound{"IV",  "vps-field",    wall_traction, "gamma_F_deg", 0.042,      k_edges},
    Bound{"IV",  "vps-field",    wall_traction, "sigma_T",     0.0093,     k_edges},
    Bound{"IV",  "vps-field",    wall_traction, "gamma_T_deg", 0.13,       k_edges},
    Bound{"IV",  "vps-field",    depth,         "leakage",     0.073,      k_edges},
    Bound{"IV",  "vps-field",    wall_traction, "noise_F",     1.4e-7,     k_edges},
    Bound{"IV",  "vps-field",    wall_traction, "lag",         7e-6,       k_no_memory},
    Bound{"IV",  "vps-field",    wall_traction, "loop_work",   1.6e-7,     k_points},
    Bound{"IV",  "vps-field",    wall_traction, "jump_F",      3.3e-5,     k_slope},
    Bound{"IV",  "vps-field",    wall_traction, "gain_F",      0.997,      k_scale, scale},
    Bound{"IV",  "vps-field",    wall_traction, "nu_F",        0.00086,    k_energy},
    Bound{"IV",  "ist",          volume,        "sigma_F",     0.078,      k_cones},
    Bound{"IV",  "ist",          volume,        "gamma_F_deg", 5.8,        k_edge_cones},
    Bound{"IV",  "ist",          volume,        "sigma_T",     0.44,       k_edge_cones},
    Bound{"IV",  "ist",          volume,        "gamma_T_deg", 79,         k_edge_cones},
    Bound{"IV",  "ist",          volume,        "noise_F",     4.1e-5,     k_cones},
    Bound{"IV",  "ist",          volume,        "lag",         0.084,      k_no_memory},
    Bound{"IV",  "ist",          volume,        "loop_work",   0.0022,     k_edge_cones},
    Bound{"IV",  "ist",          volume,        "jump_F",      3.7e-5,     k_slope},
    Bound{"IV",  "ist",          volume,        "gain_F",      0.334,      k_scale, scale},
    Bound{"IV",  "ist",          volume,        "nu_F",        0.0068,     k_energy},
    Bound{"IV",  "ist-volume",   volume,        "sigma_F",     0.062,      k_centers},
    Bound{"IV",  "ist-volume",   volume,        "gamma_F_deg", 2.7,        k_centers},
    Bound{"IV",  "ist-volume",   volume,        "sigma_T",     0.47,       k_centers},
    Bound{"IV",  "ist-volume",   volume,        "gamma_T_deg", k_none,     k_centers, weakness},
    Bound{"IV",  "ist-volume",   volume,        "noise_F",     5.6e-5,     k_centers},
    Bound{"IV",  "ist-volume",   volume,        "lag",         0.015,      k_packing},
    Bound{"IV",  "ist-volume",   volume,        "loop_work",   6.9e-7,     k_centers},
    Bound{"IV",  "ist-volume",   volume,        "jump_F",      3.6e-5,     k_slope},
    Bound{"IV",  "ist-volume",   volume,        "gain_F",      0.256,      k_scale, scale},
    Bound{"IV",  "ist-volume",   volume,        "nu_F",        0.021,      k_energy},
    Bound{"IV",  "ist-descent",  volume,        "sigma_F",     0.041,      k_gaps},
    Bound{"IV",  "ist-descent",  volume,        "gamma_F_deg", 8.9,        k_steepest},
    Bound{"IV",  "ist-descent",  volume,        "sigma_T",     0.54,       k_steepest},
    Bound{"IV",  "ist-descent",  volume,        "gamma_T_deg", 44,         k_steepest},
    Bound{"IV",  "ist-descent",  volume,        "noise_F",     0.00052,    k_gaps},
    Bound{"IV",  "ist-descent",  volume,        "lag",         0.011,      k_no_memory},
    Bound{"IV",  "ist-descent",  volume,        "loop_work",   0.00049,    k_gaps},
    Bound{"IV",  "ist-descent",  volume,        "jump_F",      6.6e-5,     k_slope},
    Bound{"IV",  "ist-descent",  volume,        "gain_F",      0.854,      k_scale, scale},
    Bound{"IV",  "ist-descent",  volume,        "nu_F",        0.071,      k_energy},
    Bound{"IV",  "fcl-contacts", depth,         "sigma_F",     0.32,       k_pairs},
    Bound{"IV",  "fcl-contacts", depth,         "gamma_F_deg", 13,         k_pairs},
    Bound{"IV",  "fcl-contacts", depth,         "leakage",     1.4,        k_pairs},
    Bound{"IV",  "fcl-contacts", depth,         "noise_F",     0.015,      k_pairs},
    Bound{"IV",  "fcl-contacts", depth,         "lag",         k_none,     k_pairs, weakness},
    Bound{"IV",  "fcl-contacts", depth,         "loop_work",   0.12,       k_pairs},
    Bound{"IV",  "fcl-contacts", depth,         "jump_F",      0.46,       k_set},
    Bound{"IV",  "fcl-contacts", depth,         "gain_F",      0.0467,     k_scale, scale},
    Bound{"IV",  "fcl-contacts", depth,         "nu_F",        0.98,       k_energy},
};
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
  if (name == "ist-volume") return {"ist", {"force=volume"}};
  return {std::string(name), {}};
}

std::span<const Bound> bounds() {
  static const std::vector<Bound> all = [] {
    Registry registry;
    register_all_algorithms(registry);
    const auto is_built = [&](const Bound& bound) {
      return std::ranges::any_of(registry.all(), [&](const auto& a) { return a->traits().name == bound.algorithm; });
    };
    std::vector<Bound> list(k_bounds.begin(), k_bounds.end());
    std::ranges::copy_if(backend_bounds(), std::back_inserter(list), is_built);
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

bool holds(const Bound& bound, double value) {
  if (bound.kind == weakness) return true;
  if (bound.kind == scale) return value >= bound.bound / k_scale_margin && value <= bound.bound * k_scale_margin;
  return defect(bound, value) <= largest_defect(bound);
}

}  // namespace sixdof
