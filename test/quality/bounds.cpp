#include "bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "backend_bounds.h"
#include "bench/common/all_algorithms.h"

namespace sixdof {
namespace {

constexpr double k_zero = 0.0;
constexpr double k_rounding = 1e-9;

// For all.
constexpr std::string_view k_no_miss = "does not tunnel";
constexpr std::string_view k_answers = "answers every step";
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
    // scenario, algorithm, law, measure, bound, reason; records: see Kind
    Bound{"Ia",  "exact",        gradient,      "sigma_F",     k_rounding, k_flat},
    Bound{"Ia",  "exact",        gradient,      "gamma_F_deg", k_rounding, k_regular},
    Bound{"Ia",  "exact",        gradient,      "misses",      k_zero,     k_no_miss},
    Bound{"Ia",  "exact",        gradient,      "failed",      k_zero,     k_answers},
    Bound{"Ia",  "exact",        gradient,      "leakage",     k_rounding, k_regular},
    Bound{"Ia",  "exact",        gradient,      "noise_F",     k_rounding, k_flat},
    Bound{"Ia",  "exact",        gradient,      "jump_F",      6e-4,       k_slope},
    Bound{"Ia",  "exact",        volume,        "sigma_F",     k_rounding, k_flat},
    Bound{"Ia",  "exact",        volume,        "gamma_F_deg", k_rounding, k_regular},
    Bound{"Ia",  "exact",        gradient,      "gain_F",      1,          k_scale, records},
    Bound{"Ia",  "exact",        gradient,      "nu_F",        1,          k_energy, records},
    Bound{"Ia",  "vps",          depth,         "sigma_F",     0.01,       k_voxels},
    Bound{"Ia",  "vps",          depth,         "gamma_F_deg", 0.8,        k_voxels},
    Bound{"Ia",  "vps",          depth,         "misses",      k_zero,     k_no_miss},
    Bound{"Ia",  "vps",          depth,         "failed",      k_zero,     k_answers},
    Bound{"Ia",  "vps",          depth,         "leakage",     0.006,      k_voxels},
    Bound{"Ia",  "vps",          depth,         "noise_F",     1e-4,       k_voxels},
    Bound{"Ia",  "vps",          depth,         "jump_F",      0.004,      k_enters},
    Bound{"Ia",  "vps",          depth,         "gain_F",      122.9,      k_scale, records},
    Bound{"Ia",  "vps",          depth,         "nu_F",        0.9896,     k_energy, records},
    Bound{"Ia",  "vps-field",    depth,         "sigma_F",     0.03,       k_medial},
    Bound{"Ia",  "vps-field",    depth,         "gamma_F_deg", 0.5,        k_medial},
    Bound{"Ia",  "vps-field",    depth,         "misses",      k_zero,     k_no_miss},
    Bound{"Ia",  "vps-field",    depth,         "failed",      k_zero,     k_answers},
    Bound{"Ia",  "vps-field",    depth,         "leakage",     0.04,       k_medial},
    Bound{"Ia",  "vps-field",    depth,         "noise_F",     1.2e-9,     k_medial},
    Bound{"Ia",  "vps-field",    depth,         "jump_F",      5e-4,       k_slope},
    Bound{"Ia",  "vps-field",    depth,         "gain_F",      148.3,      k_scale, records},
    Bound{"Ia",  "vps-field",    depth,         "nu_F",        0.9942,     k_energy, records},
    Bound{"Ia",  "ist",          volume,        "sigma_F",     0.35,       k_cones},
    Bound{"Ia",  "ist",          volume,        "gamma_F_deg", 2,          k_cones},
    Bound{"Ia",  "ist",          volume,        "misses",      k_zero,     k_no_miss},
    Bound{"Ia",  "ist",          volume,        "failed",      k_zero,     k_answers},
    Bound{"Ia",  "ist",          volume,        "leakage",     0.025,      k_cones},
    Bound{"Ia",  "ist",          volume,        "noise_F",     0.035,      k_cones},
    Bound{"Ia",  "ist",          volume,        "jump_F",      0.00055,    k_slope},
    Bound{"Ia",  "ist",          volume,        "gain_F",      0.5223,     k_scale, records},
    Bound{"Ia",  "ist",          volume,        "nu_F",        0.6225,     k_energy, records},
    Bound{"Ia",  "ist-volume",   volume,        "sigma_F",     0.8,        k_inside},
    Bound{"Ia",  "ist-volume",   volume,        "gamma_F_deg", 40,         k_inside},
    Bound{"Ia",  "ist-volume",   volume,        "misses",      k_zero,     k_no_miss},
    Bound{"Ia",  "ist-volume",   volume,        "failed",      k_zero,     k_answers},
    Bound{"Ia",  "ist-volume",   volume,        "leakage",     0.4,        k_inside},
    Bound{"Ia",  "ist-volume",   volume,        "noise_F",     0.8,        k_inside},
    Bound{"Ia",  "ist-volume",   volume,        "jump_F",      0.002,      k_slope},
    Bound{"Ia",  "ist-volume",   volume,        "gain_F",      0.3265,     k_scale, records},
    Bound{"Ia",  "ist-volume",   volume,        "nu_F",        0.2851,     k_energy, records},
    Bound{"Ia",  "ist-descent",  volume,        "sigma_F",     0.16,       k_gaps},
    Bound{"Ia",  "ist-descent",  volume,        "gamma_F_deg", 10,         k_gaps},
    Bound{"Ia",  "ist-descent",  volume,        "misses",      k_zero,     k_no_miss},
    Bound{"Ia",  "ist-descent",  volume,        "failed",      k_zero,     k_answers},
    Bound{"Ia",  "ist-descent",  volume,        "leakage",     0.09,       k_gaps},
    Bound{"Ia",  "ist-descent",  volume,        "noise_F",     0.03,       k_gaps},
    Bound{"Ia",  "ist-descent",  volume,        "jump_F",      0.004,      k_slope},
    Bound{"Ia",  "ist-descent",  volume,        "gain_F",      0.9169,     k_scale, records},
    Bound{"Ia",  "ist-descent",  volume,        "nu_F",        0.7959,     k_energy, records},
    Bound{"Ia",  "fcl-contacts", depth,         "sigma_F",     0.005,      k_pairs},
    Bound{"Ia",  "fcl-contacts", depth,         "gamma_F_deg", 0.025,      k_pairs},
    Bound{"Ia",  "fcl-contacts", depth,         "misses",      k_zero,     k_no_miss},
    Bound{"Ia",  "fcl-contacts", depth,         "failed",      k_zero,     k_answers},
    Bound{"Ia",  "fcl-contacts", depth,         "leakage",     0.05,       k_pairs},
    Bound{"Ia",  "fcl-contacts", depth,         "noise_F",     1.2e-5,     k_pairs},
    Bound{"Ia",  "fcl-contacts", depth,         "jump_F",      0.6,        k_set},
    Bound{"Ia",  "fcl-contacts", depth,         "gain_F",      0.9991,     k_scale, records},
    Bound{"Ia",  "fcl-contacts", depth,         "nu_F",        0.9981,     k_energy, records},
    Bound{"Ib",  "exact",        gradient,      "sigma_F",     k_rounding, k_flat},
    Bound{"Ib",  "exact",        gradient,      "gamma_F_deg", k_rounding, k_regular},
    Bound{"Ib",  "exact",        gradient,      "misses",      k_zero,     k_no_miss},
    Bound{"Ib",  "exact",        gradient,      "failed",      k_zero,     k_answers},
    Bound{"Ib",  "exact",        gradient,      "leakage",     k_rounding, k_regular},
    Bound{"Ib",  "exact",        gradient,      "noise_F",     k_rounding, k_flat},
    Bound{"Ib",  "exact",        gradient,      "jump_F",      0.006,      k_slope},
    Bound{"Ib",  "exact",        volume,        "sigma_F",     k_rounding, k_flat},
    Bound{"Ib",  "exact",        volume,        "gamma_F_deg", k_rounding, k_regular},
    Bound{"Ib",  "exact",        volume,        "misses",      k_zero,     k_no_miss},
    Bound{"Ib",  "exact",        gradient,      "gain_F",      1,          k_scale, records},
    Bound{"Ib",  "exact",        gradient,      "nu_F",        1,          k_energy, records},
    Bound{"Ib",  "vps",          depth,         "sigma_F",     0.4,        k_thin},
    Bound{"Ib",  "vps",          depth,         "gamma_F_deg", 12,         k_thin},
    Bound{"Ib",  "vps",          depth,         "misses",      k_zero,     k_no_miss},
    Bound{"Ib",  "vps",          depth,         "failed",      k_zero,     k_answers},
    Bound{"Ib",  "vps",          depth,         "leakage",     0.03,       k_thin},
    Bound{"Ib",  "vps",          depth,         "noise_F",     0.08,       k_thin},
    Bound{"Ib",  "vps",          depth,         "jump_F",      0.025,      k_enters},
    Bound{"Ib",  "vps",          depth,         "gain_F",      3.313,      k_scale, records},
    Bound{"Ib",  "vps",          depth,         "nu_F",        0.619,      k_energy, records},
    Bound{"Ib",  "vps-field",    depth,         "sigma_F",     1,          k_thin_field, records},
    Bound{"Ib",  "vps-field",    depth,         "misses",      182,        k_thin_field, records},
    Bound{"Ib",  "vps-field",    depth,         "failed",      k_zero,     k_answers},
    Bound{"Ib",  "ist",          volume,        "sigma_F",     0.75,       k_cones},
    Bound{"Ib",  "ist",          volume,        "gamma_F_deg", 25,         k_cones},
    Bound{"Ib",  "ist",          volume,        "misses",      k_zero,     k_no_miss},
    Bound{"Ib",  "ist",          volume,        "failed",      k_zero,     k_answers},
    Bound{"Ib",  "ist",          volume,        "leakage",     0.1,        k_cones},
    Bound{"Ib",  "ist",          volume,        "noise_F",     0.3,        k_cones},
    Bound{"Ib",  "ist",          volume,        "jump_F",      0.0085,     k_slope},
    Bound{"Ib",  "ist",          volume,        "gain_F",      0.0003799,  k_scale, records},
    Bound{"Ib",  "ist",          volume,        "nu_F",        0.2728,     k_energy, records},
    Bound{"Ib",  "ist-volume",   volume,        "sigma_F",     0.8,        k_thin_spheres},
    Bound{"Ib",  "ist-volume",   volume,        "gamma_F_deg", 103.8,      k_thin_spheres, records},
    Bound{"Ib",  "ist-volume",   volume,        "misses",      k_zero,     k_no_miss},
    Bound{"Ib",  "ist-volume",   volume,        "failed",      k_zero,     k_answers},
    Bound{"Ib",  "ist-volume",   volume,        "leakage",     0.4,        k_thin_spheres},
    Bound{"Ib",  "ist-volume",   volume,        "noise_F",     1.2,        k_thin_spheres},
    Bound{"Ib",  "ist-volume",   volume,        "jump_F",      0.015,      k_slope},
    Bound{"Ib",  "ist-volume",   volume,        "gain_F",      0.000168,   k_scale, records},
    Bound{"Ib",  "ist-volume",   volume,        "nu_F",        0.1941,     k_energy, records},
    Bound{"Ib",  "ist-descent",  volume,        "sigma_F",     0.8,        k_swallowed},
    Bound{"Ib",  "ist-descent",  volume,        "gamma_F_deg", 92.44,      k_thin_spheres, records},
    Bound{"Ib",  "ist-descent",  volume,        "misses",      22,         k_swallowed, records},
    Bound{"Ib",  "ist-descent",  volume,        "failed",      k_zero,     k_answers},
    Bound{"Ib",  "ist-descent",  volume,        "gain_F",      0.6608,     k_scale, records},
    Bound{"Ib",  "ist-descent",  volume,        "nu_F",        0.2486,     k_energy, records},
    Bound{"Ib",  "fcl-contacts", depth,         "sigma_F",     0.02,       k_pairs},
    Bound{"Ib",  "fcl-contacts", depth,         "gamma_F_deg", 179.9,      k_blind, records},
    Bound{"Ib",  "fcl-contacts", depth,         "misses",      k_zero,     k_no_miss},
    Bound{"Ib",  "fcl-contacts", depth,         "failed",      k_zero,     k_answers},
    Bound{"Ib",  "fcl-contacts", depth,         "leakage",     0.04,       k_pairs},
    Bound{"Ib",  "fcl-contacts", depth,         "noise_F",     1.2e-4,     k_pairs},
    Bound{"Ib",  "fcl-contacts", depth,         "jump_F",      0.3,        k_set},
    Bound{"Ib",  "fcl-contacts", depth,         "gain_F",      1,          k_scale, records},
    Bound{"Ib",  "fcl-contacts", depth,         "nu_F",        0.9879,     k_energy, records},
    Bound{"II",  "exact",        gradient,      "sigma_F",     1.5e-4,     k_facets},
    Bound{"II",  "exact",        gradient,      "gamma_F_deg", 0.006,      k_facets},
    Bound{"II",  "exact",        gradient,      "misses",      k_zero,     k_no_miss},
    Bound{"II",  "exact",        gradient,      "failed",      k_zero,     k_answers},
    Bound{"II",  "exact",        gradient,      "leakage",     1.2e-4,     k_facets},
    Bound{"II",  "exact",        gradient,      "noise_F",     1.5e-8,     k_facets},
    Bound{"II",  "exact",        gradient,      "lag",         k_rounding, k_no_memory},
    Bound{"II",  "exact",        gradient,      "loop_work",   k_rounding, k_conservative},
    Bound{"II",  "exact",        gradient,      "jump_F",      4e-5,       k_slope},
    Bound{"II",  "exact",        volume,        "sigma_F",     1.5e-4,     k_facets},
    Bound{"II",  "exact",        volume,        "gamma_F_deg", 0.006,      k_facets},
    Bound{"II",  "exact",        gradient,      "gain_F",      0.9999,     k_scale, records},
    Bound{"II",  "exact",        gradient,      "nu_F",        0.9998,     k_energy, records},
    Bound{"II",  "vps",          depth,         "sigma_F",     0.012,      k_voxels},
    Bound{"II",  "vps",          depth,         "gamma_F_deg", 0.15,       k_voxels},
    Bound{"II",  "vps",          depth,         "misses",      k_zero,     k_no_miss},
    Bound{"II",  "vps",          depth,         "failed",      k_zero,     k_answers},
    Bound{"II",  "vps",          depth,         "leakage",     6e-5,       k_voxels},
    Bound{"II",  "vps",          depth,         "noise_F",     2e-6,       k_voxels},
    Bound{"II",  "vps",          depth,         "lag",         2.5e-4,     k_no_memory},
    Bound{"II",  "vps",          depth,         "loop_work",   2.5e-7,     k_voxels},
    Bound{"II",  "vps",          depth,         "jump_F",      3e-4,       k_enters},
    Bound{"II",  "vps",          depth,         "gain_F",      570.1,      k_scale, records},
    Bound{"II",  "vps",          depth,         "nu_F",        0.985,      k_energy, records},
    Bound{"II",  "vps-field",    depth,         "sigma_F",     6e-4,       k_points},
    Bound{"II",  "vps-field",    depth,         "gamma_F_deg", 0.0025,     k_points},
    Bound{"II",  "vps-field",    depth,         "misses",      k_zero,     k_no_miss},
    Bound{"II",  "vps-field",    depth,         "failed",      k_zero,     k_answers},
    Bound{"II",  "vps-field",    depth,         "leakage",     3e-5,       k_points},
    Bound{"II",  "vps-field",    depth,         "noise_F",     4e-8,       k_points},
    Bound{"II",  "vps-field",    depth,         "lag",         2e-6,       k_no_memory},
    Bound{"II",  "vps-field",    depth,         "loop_work",   4e-8,       k_points},
    Bound{"II",  "vps-field",    depth,         "jump_F",      4e-5,       k_slope},
    Bound{"II",  "vps-field",    depth,         "gain_F",      623.1,      k_scale, records},
    Bound{"II",  "vps-field",    depth,         "nu_F",        0.9991,     k_energy, records},
    Bound{"II",  "ist",          volume,        "sigma_F",     0.01,       k_packing},
    Bound{"II",  "ist",          volume,        "gamma_F_deg", 11,         k_edge_cones},
    Bound{"II",  "ist",          volume,        "misses",      k_zero,     k_no_miss},
    Bound{"II",  "ist",          volume,        "failed",      k_zero,     k_answers},
    Bound{"II",  "ist",          volume,        "leakage",     0.15,       k_edge_cones},
    Bound{"II",  "ist",          volume,        "noise_F",     6e-06,      k_packing},
    Bound{"II",  "ist",          volume,        "lag",         0.03,       k_no_memory},
    Bound{"II",  "ist",          volume,        "loop_work",   0.00075,    k_edge_cones},
    Bound{"II",  "ist",          volume,        "jump_F",      4.5e-05,    k_slope},
    Bound{"II",  "ist",          volume,        "gain_F",      0.7958,     k_scale, records},
    Bound{"II",  "ist",          volume,        "nu_F",        0.9869,     k_energy, records},
    Bound{"II",  "ist-volume",   volume,        "sigma_F",     0.008,      k_packing},
    Bound{"II",  "ist-volume",   volume,        "gamma_F_deg", 1.8,        k_packing},
    Bound{"II",  "ist-volume",   volume,        "misses",      k_zero,     k_no_miss},
    Bound{"II",  "ist-volume",   volume,        "failed",      k_zero,     k_answers},
    Bound{"II",  "ist-volume",   volume,        "leakage",     1.5e-4,     k_packing},
    Bound{"II",  "ist-volume",   volume,        "noise_F",     4e-6,       k_packing},
    Bound{"II",  "ist-volume",   volume,        "lag",         1e-4,       k_no_memory},
    Bound{"II",  "ist-volume",   volume,        "loop_work",   2.5e-7,     k_packing},
    Bound{"II",  "ist-volume",   volume,        "jump_F",      5e-5,       k_slope},
    Bound{"II",  "ist-volume",   volume,        "gain_F",      0.7651,     k_scale, records},
    Bound{"II",  "ist-volume",   volume,        "nu_F",        0.9902,     k_energy, records},
    Bound{"II",  "ist-descent",  volume,        "sigma_F",     0.006,      k_gaps},
    Bound{"II",  "ist-descent",  volume,        "gamma_F_deg", 0.4,        k_gaps},
    Bound{"II",  "ist-descent",  volume,        "misses",      k_zero,     k_no_miss},
    Bound{"II",  "ist-descent",  volume,        "failed",      k_zero,     k_answers},
    Bound{"II",  "ist-descent",  volume,        "leakage",     0.00015,    k_gaps},
    Bound{"II",  "ist-descent",  volume,        "noise_F",     2e-5,       k_gaps},
    Bound{"II",  "ist-descent",  volume,        "lag",         0.00015,    k_no_memory},
    Bound{"II",  "ist-descent",  volume,        "loop_work",   1e-5,       k_gaps},
    Bound{"II",  "ist-descent",  volume,        "jump_F",      0.0001,     k_slope},
    Bound{"II",  "ist-descent",  volume,        "gain_F",      0.9797,     k_scale, records},
    Bound{"II",  "ist-descent",  volume,        "nu_F",        0.9927,     k_energy, records},
    Bound{"II",  "fcl-contacts", depth,         "sigma_F",     0.12,       k_pairs},
    Bound{"II",  "fcl-contacts", depth,         "gamma_F_deg", 0.8,        k_pairs},
    Bound{"II",  "fcl-contacts", depth,         "misses",      k_zero,     k_no_miss},
    Bound{"II",  "fcl-contacts", depth,         "failed",      k_zero,     k_answers},
    Bound{"II",  "fcl-contacts", depth,         "leakage",     0.06,       k_pairs},
    Bound{"II",  "fcl-contacts", depth,         "noise_F",     0.005,      k_pairs},
    Bound{"II",  "fcl-contacts", depth,         "lag",         4e-5,       k_pairs},
    Bound{"II",  "fcl-contacts", depth,         "loop_work",   1.2e-6,     k_pairs},
    Bound{"II",  "fcl-contacts", depth,         "jump_F",      0.04,       k_set},
    Bound{"II",  "fcl-contacts", depth,         "gain_F",      0.07959,    k_scale, records},
    Bound{"II",  "fcl-contacts", depth,         "nu_F",        0.8635,     k_energy, records},
    Bound{"III", "exact",        gradient,      "sigma_T",     k_rounding, k_flat},
    Bound{"III", "exact",        gradient,      "gamma_T_deg", k_rounding, k_flat},
    Bound{"III", "exact",        gradient,      "misses",      k_zero,     k_no_miss},
    Bound{"III", "exact",        gradient,      "failed",      k_zero,     k_answers},
    Bound{"III", "exact",        gradient,      "noise_T",     k_rounding, k_flat},
    Bound{"III", "exact",        gradient,      "jump_T",      1.5,        k_kink},
    Bound{"III", "exact",        gradient,      "sigma_F",     k_rounding, k_flat},
    Bound{"III", "exact",        gradient,      "gamma_F_deg", k_rounding, k_flat},
    Bound{"III", "exact",        volume,        "gamma_T_deg", k_rounding, k_flat},
    Bound{"III", "exact",        volume,        "misses",      k_zero,     k_no_miss},
    Bound{"III", "exact",        gradient,      "gain_T",      1,          k_scale, records},
    Bound{"III", "exact",        gradient,      "nu_T",        1,          k_energy, records},
    Bound{"III", "vps",          traction,      "sigma_T",     0.06,       k_voxels},
    Bound{"III", "vps",          traction,      "gamma_T_deg", 0.4,        k_voxels},
    Bound{"III", "vps",          traction,      "misses",      k_zero,     k_no_miss},
    Bound{"III", "vps",          traction,      "failed",      k_zero,     k_answers},
    Bound{"III", "vps",          traction,      "leakage",     0.8,        k_plate},
    Bound{"III", "vps",          traction,      "noise_T",     8e-4,       k_voxels},
    Bound{"III", "vps",          traction,      "jump_T",      0.0025,     k_enters},
    Bound{"III", "vps",          traction,      "gain_T",      1.002,      k_scale, records},
    Bound{"III", "vps",          traction,      "nu_T",        0.9043,     k_energy, records},
    Bound{"III", "vps-field",    wall_traction, "sigma_T",     0.003,      k_edges},
    Bound{"III", "vps-field",    wall_traction, "gamma_T_deg", 0.0025,     k_edges},
    Bound{"III", "vps-field",    wall_traction, "misses",      k_zero,     k_no_miss},
    Bound{"III", "vps-field",    wall_traction, "failed",      k_zero,     k_answers},
    Bound{"III", "vps-field",    wall_traction, "leakage",     0.0025,     k_edges},
    Bound{"III", "vps-field",    wall_traction, "noise_T",     1.2e-7,     k_edges},
    Bound{"III", "vps-field",    wall_traction, "jump_T",      2e-5,       k_slope},
    Bound{"III", "vps-field",    wall_traction, "gain_T",      0.994,      k_scale, records},
    Bound{"III", "vps-field",    wall_traction, "nu_T",        0.9982,     k_energy, records},
    Bound{"III", "ist",          volume,        "sigma_T",     0.25,       k_cones},
    Bound{"III", "ist",          volume,        "gamma_T_deg", 9,          k_cones},
    Bound{"III", "ist",          volume,        "misses",      k_zero,     k_no_miss},
    Bound{"III", "ist",          volume,        "failed",      k_zero,     k_answers},
    Bound{"III", "ist",          volume,        "leakage",     0.65,       k_cones},
    Bound{"III", "ist",          volume,        "noise_T",     3e-07,      k_cones},
    Bound{"III", "ist",          volume,        "jump_T",      2e-05,      k_slope},
    Bound{"III", "ist",          volume,        "gain_T",      0.8174,     k_scale, records},
    Bound{"III", "ist",          volume,        "nu_T",        1.3,        k_energy, records},
    Bound{"III", "ist-volume",   volume,        "sigma_T",     0.25,       k_centers},
    Bound{"III", "ist-volume",   volume,        "gamma_T_deg", 10,         k_centers},
    Bound{"III", "ist-volume",   volume,        "misses",      k_zero,     k_no_miss},
    Bound{"III", "ist-volume",   volume,        "failed",      k_zero,     k_answers},
    Bound{"III", "ist-volume",   volume,        "leakage",     0.4,        k_centers},
    Bound{"III", "ist-volume",   volume,        "noise_T",     3e-5,       k_centers},
    Bound{"III", "ist-volume",   volume,        "jump_T",      2e-5,       k_slope},
    Bound{"III", "ist-volume",   volume,        "gain_T",      0.9667,     k_scale, records},
    Bound{"III", "ist-volume",   volume,        "nu_T",        1.11,       k_energy, records},
    Bound{"III", "ist-descent",  volume,        "sigma_T",     0.1,        k_gaps},
    Bound{"III", "ist-descent",  volume,        "gamma_T_deg", 6,          k_gaps},
    Bound{"III", "ist-descent",  volume,        "misses",      k_zero,     k_no_miss},
    Bound{"III", "ist-descent",  volume,        "failed",      k_zero,     k_answers},
    Bound{"III", "ist-descent",  volume,        "leakage",     0.2,        k_gaps},
    Bound{"III", "ist-descent",  volume,        "noise_T",     8e-5,       k_gaps},
    Bound{"III", "ist-descent",  volume,        "jump_T",      3e-5,       k_slope},
    Bound{"III", "ist-descent",  volume,        "gain_T",      14.25,      k_scale, records},
    Bound{"III", "ist-descent",  volume,        "nu_T",        0.9253,     k_energy, records},
    Bound{"III", "fcl-contacts", depth,         "sigma_T",     0.6,        k_pairs},
    Bound{"III", "fcl-contacts", depth,         "gamma_T_deg", 176,        k_sign, records},
    Bound{"III", "fcl-contacts", depth,         "misses",      k_zero,     k_no_miss},
    Bound{"III", "fcl-contacts", depth,         "failed",      k_zero,     k_answers},
    Bound{"III", "fcl-contacts", depth,         "leakage",     0.2,        k_pairs},
    Bound{"III", "fcl-contacts", depth,         "noise_T",     0.008,      k_pairs},
    Bound{"III", "fcl-contacts", depth,         "jump_T",      0.8,        k_set},
    Bound{"III", "fcl-contacts", depth,         "gain_T",      11.3,       k_scale, records},
    Bound{"III", "fcl-contacts", depth,         "nu_T",        2.101,      k_energy, records},
    Bound{"IV",  "exact",        gradient,      "sigma_F",     1e-4,       k_facets},
    Bound{"IV",  "exact",        gradient,      "gamma_F_deg", 0.01,       k_facets},
    Bound{"IV",  "exact",        gradient,      "sigma_T",     4e-4,       k_facets},
    Bound{"IV",  "exact",        gradient,      "gamma_T_deg", 0.08,       k_facets},
    Bound{"IV",  "exact",        gradient,      "misses",      k_zero,     k_no_miss},
    Bound{"IV",  "exact",        gradient,      "failed",      k_zero,     k_answers},
    Bound{"IV",  "exact",        gradient,      "noise_F",     4e-8,       k_facets},
    Bound{"IV",  "exact",        gradient,      "lag",         k_rounding, k_no_memory},
    Bound{"IV",  "exact",        gradient,      "loop_work",   k_rounding, k_conservative},
    Bound{"IV",  "exact",        gradient,      "jump_F",      1,          k_kink},
    Bound{"IV",  "exact",        gradient,      "gain_F",      1,          k_scale, records},
    Bound{"IV",  "exact",        gradient,      "nu_F",        1,          k_energy, records},
    Bound{"IV",  "vps",          traction,      "sigma_F",     0.12,       k_snug},
    Bound{"IV",  "vps",          traction,      "gamma_F_deg", 4,          k_snug},
    Bound{"IV",  "vps",          traction,      "sigma_T",     0.4,        k_snug},
    Bound{"IV",  "vps",          traction,      "gamma_T_deg", 40,         k_snug},
    Bound{"IV",  "vps",          traction,      "misses",      k_zero,     k_no_miss},
    Bound{"IV",  "vps",          traction,      "failed",      k_zero,     k_answers},
    Bound{"IV",  "vps",          depth,         "leakage",     0.15,       k_snug},
    Bound{"IV",  "vps",          traction,      "noise_F",     1e-4,       k_snug},
    Bound{"IV",  "vps",          traction,      "lag",         0.04,       k_no_memory},
    Bound{"IV",  "vps",          traction,      "loop_work",   0.001,      k_voxels},
    Bound{"IV",  "vps",          traction,      "jump_F",      3e-4,       k_enters},
    Bound{"IV",  "vps",          traction,      "gain_F",      0.9673,     k_scale, records},
    Bound{"IV",  "vps",          traction,      "nu_F",        0.865,      k_energy, records},
    Bound{"IV",  "vps-field",    wall_traction, "sigma_F",     8e-4,       k_edges},
    Bound{"IV",  "vps-field",    wall_traction, "gamma_F_deg", 0.06,       k_edges},
    Bound{"IV",  "vps-field",    wall_traction, "sigma_T",     0.012,      k_edges},
    Bound{"IV",  "vps-field",    wall_traction, "gamma_T_deg", 0.2,        k_edges},
    Bound{"IV",  "vps-field",    wall_traction, "misses",      k_zero,     k_no_miss},
    Bound{"IV",  "vps-field",    wall_traction, "failed",      k_zero,     k_answers},
    Bound{"IV",  "vps-field",    depth,         "leakage",     0.1,        k_edges},
    Bound{"IV",  "vps-field",    wall_traction, "noise_F",     2e-7,       k_edges},
    Bound{"IV",  "vps-field",    wall_traction, "lag",         1e-5,       k_no_memory},
    Bound{"IV",  "vps-field",    wall_traction, "loop_work",   2.5e-7,     k_points},
    Bound{"IV",  "vps-field",    wall_traction, "jump_F",      5e-5,       k_slope},
    Bound{"IV",  "vps-field",    wall_traction, "gain_F",      0.9966,     k_scale, records},
    Bound{"IV",  "vps-field",    wall_traction, "nu_F",        0.9991,     k_energy, records},
    Bound{"IV",  "ist",          volume,        "sigma_F",     0.11,       k_cones},
    Bound{"IV",  "ist",          volume,        "gamma_F_deg", 8,          k_edge_cones},
    Bound{"IV",  "ist",          volume,        "sigma_T",     0.6,        k_edge_cones},
    Bound{"IV",  "ist",          volume,        "gamma_T_deg", 79.27,      k_edge_cones, records},
    Bound{"IV",  "ist",          volume,        "misses",      k_zero,     k_no_miss},
    Bound{"IV",  "ist",          volume,        "failed",      k_zero,     k_answers},
    Bound{"IV",  "ist",          volume,        "noise_F",     5.5e-05,    k_cones},
    Bound{"IV",  "ist",          volume,        "lag",         0.15,       k_no_memory},
    Bound{"IV",  "ist",          volume,        "loop_work",   0.003,      k_edge_cones},
    Bound{"IV",  "ist",          volume,        "jump_F",      5e-05,      k_slope},
    Bound{"IV",  "ist",          volume,        "gain_F",      0.3342,     k_scale, records},
    Bound{"IV",  "ist",          volume,        "nu_F",        0.9932,     k_energy, records},
    Bound{"IV",  "ist-volume",   volume,        "sigma_F",     0.08,       k_centers},
    Bound{"IV",  "ist-volume",   volume,        "gamma_F_deg", 4,          k_centers},
    Bound{"IV",  "ist-volume",   volume,        "sigma_T",     0.6,        k_centers},
    Bound{"IV",  "ist-volume",   volume,        "gamma_T_deg", 100.6,      k_centers, records},
    Bound{"IV",  "ist-volume",   volume,        "misses",      k_zero,     k_no_miss},
    Bound{"IV",  "ist-volume",   volume,        "failed",      k_zero,     k_answers},
    Bound{"IV",  "ist-volume",   volume,        "noise_F",     8e-5,       k_centers},
    Bound{"IV",  "ist-volume",   volume,        "lag",         0.02,       k_packing},
    Bound{"IV",  "ist-volume",   volume,        "loop_work",   1e-6,       k_centers},
    Bound{"IV",  "ist-volume",   volume,        "jump_F",      5e-5,       k_slope},
    Bound{"IV",  "ist-volume",   volume,        "gain_F",      0.2557,     k_scale, records},
    Bound{"IV",  "ist-volume",   volume,        "nu_F",        0.9791,     k_energy, records},
    Bound{"IV",  "ist-descent",  volume,        "sigma_F",     0.06,       k_gaps},
    Bound{"IV",  "ist-descent",  volume,        "gamma_F_deg", 12,         k_steepest},
    Bound{"IV",  "ist-descent",  volume,        "sigma_T",     0.7,        k_steepest},
    Bound{"IV",  "ist-descent",  volume,        "gamma_T_deg", 60,         k_steepest},
    Bound{"IV",  "ist-descent",  volume,        "misses",      k_zero,     k_no_miss},
    Bound{"IV",  "ist-descent",  volume,        "failed",      k_zero,     k_answers},
    Bound{"IV",  "ist-descent",  volume,        "noise_F",     0.0008,     k_gaps},
    Bound{"IV",  "ist-descent",  volume,        "lag",         0.015,      k_no_memory},
    Bound{"IV",  "ist-descent",  volume,        "loop_work",   0.0007,     k_gaps},
    Bound{"IV",  "ist-descent",  volume,        "jump_F",      0.0001,     k_slope},
    Bound{"IV",  "ist-descent",  volume,        "gain_F",      0.854,      k_scale, records},
    Bound{"IV",  "ist-descent",  volume,        "nu_F",        0.9334,     k_energy, records},
    Bound{"IV",  "fcl-contacts", depth,         "sigma_F",     0.4,        k_pairs},
    Bound{"IV",  "fcl-contacts", depth,         "gamma_F_deg", 18,         k_pairs},
    Bound{"IV",  "fcl-contacts", depth,         "misses",      k_zero,     k_no_miss},
    Bound{"IV",  "fcl-contacts", depth,         "failed",      k_zero,     k_answers},
    Bound{"IV",  "fcl-contacts", depth,         "leakage",     2,          k_pairs},
    Bound{"IV",  "fcl-contacts", depth,         "noise_F",     0.02,       k_pairs},
    Bound{"IV",  "fcl-contacts", depth,         "lag",         8,          k_pairs},
    Bound{"IV",  "fcl-contacts", depth,         "loop_work",   0.2,        k_pairs},
    Bound{"IV",  "fcl-contacts", depth,         "jump_F",      0.6,        k_set},
    Bound{"IV",  "fcl-contacts", depth,         "gain_F",      0.04666,    k_scale, records},
    Bound{"IV",  "fcl-contacts", depth,         "nu_F",        0.5057,     k_energy, records},
};
// clang-format on

}  // namespace

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
    return list;
  }();
  return all;
}

Verdict judge(double value, double bound, Kind kind) {
  if (kind == Kind::records) {
    return std::abs(value - bound) <= k_record_tolerance * bound ? Verdict::holds : Verdict::changed;
  }
  if (!(value <= bound)) return Verdict::worse;
  if (bound > k_rounding_bound && value < 0.5 * bound) return Verdict::too_loose;
  return Verdict::holds;
}

}  // namespace sixdof
