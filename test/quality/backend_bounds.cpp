#include "backend_bounds.h"

#include <array>

namespace sixdof {
namespace {

constexpr double k_zero = 0.0;

constexpr std::string_view k_no_miss = "does not tunnel";
constexpr std::string_view k_answers = "answers every step";
constexpr std::string_view k_scale = "force per unit of the ideal: the mean of depths has no unit of its own";
constexpr std::string_view k_energy = "energy of the normalised signal: ripple and shape, as sigma";
constexpr std::string_view k_set = "the set of contacts changes from step to step";
constexpr std::string_view k_sides = "a contact knows two triangles, not which side of the body is nearer";
// bullet-gimpact
constexpr std::string_view k_clipped = "GImpact's depth of points of a clipped triangle, mean over points";
constexpr std::string_view k_behind = "what lies behind the plane of a triangle counts, as deep as it is";
// ode
constexpr std::string_view k_crossing = "ODE's depth of a pair of triangles that intersect, mean over points";

using enum IdealLaw;
using enum Kind;

// One row per line, as in bounds.cpp.
// clang-format off
constexpr std::array k_backend_bounds{
    Bound{"Ia",  "bullet-gimpact", depth, "sigma_F",     0.072,      k_clipped},
    Bound{"Ia",  "bullet-gimpact", depth, "gamma_F_deg", 0.39,       k_clipped},
    Bound{"Ia",  "bullet-gimpact", depth, "misses",      k_zero,     k_no_miss},
    Bound{"Ia",  "bullet-gimpact", depth, "failed",      k_zero,     k_answers},
    Bound{"Ia",  "bullet-gimpact", depth, "leakage",     0.011,      k_clipped},
    Bound{"Ia",  "bullet-gimpact", depth, "noise_F",     0.0025,     k_clipped},
    Bound{"Ia",  "bullet-gimpact", depth, "jump_F",      0.47,       k_set},
    Bound{"Ia",  "bullet-gimpact", depth, "gain_F",      0.9864,     k_scale, records},
    Bound{"Ia",  "bullet-gimpact", depth, "nu_F",        0.9761,     k_energy, records},
    Bound{"Ia",  "ode",            depth, "sigma_F",     0.21,       k_crossing},
    Bound{"Ia",  "ode",            depth, "gamma_F_deg", 4.1,        k_crossing},
    Bound{"Ia",  "ode",            depth, "misses",      k_zero,     k_no_miss},
    Bound{"Ia",  "ode",            depth, "failed",      k_zero,     k_answers},
    Bound{"Ia",  "ode",            depth, "leakage",     0.084,      k_crossing},
    Bound{"Ia",  "ode",            depth, "noise_F",     0.045,      k_crossing},
    Bound{"Ia",  "ode",            depth, "jump_F",      0.88,       k_set},
    Bound{"Ia",  "ode",            depth, "gain_F",      0.9597,     k_scale, records},
    Bound{"Ia",  "ode",            depth, "nu_F",        0.9464,     k_energy, records},
    Bound{"Ib",  "bullet-gimpact", depth, "sigma_F",     0.882,      k_behind, records},
    Bound{"Ib",  "bullet-gimpact", depth, "gamma_F_deg", 135.2,      k_sides, records},
    Bound{"Ib",  "bullet-gimpact", depth, "misses",      k_zero,     k_no_miss},
    Bound{"Ib",  "bullet-gimpact", depth, "failed",      k_zero,     k_answers},
    Bound{"Ib",  "bullet-gimpact", depth, "leakage",     0.094,      k_behind},
    Bound{"Ib",  "bullet-gimpact", depth, "noise_F",     0.093,      k_behind},
    Bound{"Ib",  "bullet-gimpact", depth, "jump_F",      1.2,        k_set},
    Bound{"Ib",  "bullet-gimpact", depth, "gain_F",      0.09985,    k_scale, records},
    Bound{"Ib",  "bullet-gimpact", depth, "nu_F",        0.1443,     k_energy, records},
    Bound{"Ib",  "ode",            depth, "sigma_F",     0.39,       k_crossing},
    Bound{"Ib",  "ode",            depth, "gamma_F_deg", 170.6,      k_sides, records},
    Bound{"Ib",  "ode",            depth, "misses",      k_zero,     k_no_miss},
    Bound{"Ib",  "ode",            depth, "failed",      k_zero,     k_answers},
    Bound{"Ib",  "ode",            depth, "leakage",     0.021,      k_crossing},
    Bound{"Ib",  "ode",            depth, "noise_F",     0.0033,     k_crossing},
    Bound{"Ib",  "ode",            depth, "jump_F",      0.044,      k_set},
    Bound{"Ib",  "ode",            depth, "gain_F",      1.705,      k_scale, records},
    Bound{"Ib",  "ode",            depth, "nu_F",        0.8154,     k_energy, records},
    Bound{"II",  "bullet-gimpact", depth, "sigma_F",     0.22,       k_clipped},
    Bound{"II",  "bullet-gimpact", depth, "gamma_F_deg", 4.1,        k_clipped},
    Bound{"II",  "bullet-gimpact", depth, "misses",      k_zero,     k_no_miss},
    Bound{"II",  "bullet-gimpact", depth, "failed",      k_zero,     k_answers},
    Bound{"II",  "bullet-gimpact", depth, "leakage",     0.25,       k_clipped},
    Bound{"II",  "bullet-gimpact", depth, "noise_F",     0.0022,     k_clipped},
    Bound{"II",  "bullet-gimpact", depth, "lag",         0.18,       k_clipped},
    Bound{"II",  "bullet-gimpact", depth, "loop_work",   0.0048,     k_clipped},
    Bound{"II",  "bullet-gimpact", depth, "jump_F",      0.0092,     k_set},
    Bound{"II",  "bullet-gimpact", depth, "gain_F",      0.07226,    k_scale, records},
    Bound{"II",  "bullet-gimpact", depth, "nu_F",        0.726,      k_energy, records},
    Bound{"II",  "ode",            depth, "sigma_F",     0.069,      k_crossing},
    Bound{"II",  "ode",            depth, "gamma_F_deg", 1.5,        k_crossing},
    Bound{"II",  "ode",            depth, "misses",      k_zero,     k_no_miss},
    Bound{"II",  "ode",            depth, "failed",      k_zero,     k_answers},
    Bound{"II",  "ode",            depth, "leakage",     0.043,      k_crossing},
    Bound{"II",  "ode",            depth, "noise_F",     0.0016,     k_crossing},
    Bound{"II",  "ode",            depth, "lag",         0.0022,     k_crossing},
    Bound{"II",  "ode",            depth, "loop_work",   6.5e-05,    k_crossing},
    Bound{"II",  "ode",            depth, "jump_F",      0.027,      k_set},
    Bound{"II",  "ode",            depth, "gain_F",      0.0518,     k_scale, records},
    Bound{"II",  "ode",            depth, "nu_F",        0.9088,     k_energy, records},
    Bound{"III", "bullet-gimpact", depth, "sigma_T",     0.52,       k_behind},
    Bound{"III", "bullet-gimpact", depth, "gamma_T_deg", 102.4,      k_sides, records},
    Bound{"III", "bullet-gimpact", depth, "misses",      k_zero,     k_no_miss},
    Bound{"III", "bullet-gimpact", depth, "failed",      k_zero,     k_answers},
    Bound{"III", "bullet-gimpact", depth, "leakage",     1.1,        k_behind},
    Bound{"III", "bullet-gimpact", depth, "noise_T",     2.919e+04,  k_behind, records},
    Bound{"III", "bullet-gimpact", depth, "jump_T",      1.7,        k_set},
    Bound{"III", "bullet-gimpact", depth, "gain_T",      1.26,       k_scale, records},
    Bound{"III", "bullet-gimpact", depth, "nu_T",        0.764,      k_energy, records},
    Bound{"III", "ode",            depth, "sigma_T",     0.56,       k_crossing},
    Bound{"III", "ode",            depth, "gamma_T_deg", 137,        k_sides, records},
    Bound{"III", "ode",            depth, "misses",      k_zero,     k_no_miss},
    Bound{"III", "ode",            depth, "failed",      k_zero,     k_answers},
    Bound{"III", "ode",            depth, "leakage",     1.1,        k_crossing},
    Bound{"III", "ode",            depth, "noise_T",     0.33,       k_crossing},
    Bound{"III", "ode",            depth, "jump_T",      1.2,        k_set},
    Bound{"III", "ode",            depth, "gain_T",      1.385,      k_scale, records},
    Bound{"III", "ode",            depth, "nu_T",        1.026,      k_energy, records},
    Bound{"IV",  "bullet-gimpact", depth, "sigma_F",     0.63,       k_behind},
    Bound{"IV",  "bullet-gimpact", depth, "gamma_F_deg", 51,         k_behind},
    Bound{"IV",  "bullet-gimpact", depth, "misses",      k_zero,     k_no_miss},
    Bound{"IV",  "bullet-gimpact", depth, "failed",      k_zero,     k_answers},
    Bound{"IV",  "bullet-gimpact", depth, "leakage",     5.4,        k_behind},
    Bound{"IV",  "bullet-gimpact", depth, "noise_F",     0.54,       k_behind},
    Bound{"IV",  "bullet-gimpact", depth, "lag",         0.47,       k_behind},
    Bound{"IV",  "bullet-gimpact", depth, "loop_work",   0.03,       k_behind},
    Bound{"IV",  "bullet-gimpact", depth, "jump_F",      1.4,        k_set},
    Bound{"IV",  "bullet-gimpact", depth, "gain_F",      0.03355,    k_scale, records},
    Bound{"IV",  "bullet-gimpact", depth, "nu_F",        0.3515,     k_energy, records},
    Bound{"IV",  "ode",            depth, "sigma_F",     0.46,       k_crossing},
    Bound{"IV",  "ode",            depth, "gamma_F_deg", 14,         k_crossing},
    Bound{"IV",  "ode",            depth, "misses",      k_zero,     k_no_miss},
    Bound{"IV",  "ode",            depth, "failed",      k_zero,     k_answers},
    Bound{"IV",  "ode",            depth, "leakage",     2,          k_crossing},
    Bound{"IV",  "ode",            depth, "noise_F",     0.035,      k_crossing},
    Bound{"IV",  "ode",            depth, "lag",         3.9,        k_crossing},
    Bound{"IV",  "ode",            depth, "loop_work",   0.079,      k_crossing},
    Bound{"IV",  "ode",            depth, "jump_F",      0.6,        k_set},
    Bound{"IV",  "ode",            depth, "gain_F",      0.0337,     k_scale, records},
    Bound{"IV",  "ode",            depth, "nu_F",        0.444,      k_energy, records},
};
// clang-format on

}  // namespace

std::span<const Bound> backend_bounds() { return k_backend_bounds; }

}  // namespace sixdof
