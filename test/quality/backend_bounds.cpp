#include "backend_bounds.h"

#include <array>
#include <limits>

namespace sixdof {
namespace {

constexpr double k_none = std::numeric_limits<double>::quiet_NaN();  // of a weakness

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
    Bound{"Ia",  "bullet-gimpact", depth, "sigma_F",     0.058,      k_clipped},
    Bound{"Ia",  "bullet-gimpact", depth, "gamma_F_deg", 0.31,       k_clipped},
    Bound{"Ia",  "bullet-gimpact", depth, "leakage",     0.0086,     k_clipped},
    Bound{"Ia",  "bullet-gimpact", depth, "noise_F",     0.002,      k_clipped},
    Bound{"Ia",  "bullet-gimpact", depth, "jump_F",      0.37,       k_set},
    Bound{"Ia",  "bullet-gimpact", depth, "gain_F",      0.986,      k_scale, scale},
    Bound{"Ia",  "bullet-gimpact", depth, "nu_F",        0.024,      k_energy},
    Bound{"Ia",  "ode",            depth, "sigma_F",     0.16,       k_crossing},
    Bound{"Ia",  "ode",            depth, "gamma_F_deg", 3.3,        k_crossing},
    Bound{"Ia",  "ode",            depth, "leakage",     0.067,      k_crossing},
    Bound{"Ia",  "ode",            depth, "noise_F",     0.036,      k_crossing},
    Bound{"Ia",  "ode",            depth, "jump_F",      0.7,        k_set},
    Bound{"Ia",  "ode",            depth, "gain_F",      0.96,       k_scale, scale},
    Bound{"Ia",  "ode",            depth, "nu_F",        0.057,      k_energy},
    Bound{"Ib",  "bullet-gimpact", depth, "sigma_F",     0.88,       k_behind},
    Bound{"Ib",  "bullet-gimpact", depth, "gamma_F_deg", k_none,     k_sides, weakness},
    Bound{"Ib",  "bullet-gimpact", depth, "leakage",     0.075,      k_behind},
    Bound{"Ib",  "bullet-gimpact", depth, "noise_F",     0.074,      k_behind},
    Bound{"Ib",  "bullet-gimpact", depth, "jump_F",      0.91,       k_set},
    Bound{"Ib",  "bullet-gimpact", depth, "gain_F",      0.0998,     k_scale, scale},
    Bound{"Ib",  "bullet-gimpact", depth, "nu_F",        5.9,        k_energy},
    Bound{"Ib",  "ode",            depth, "sigma_F",     0.3,        k_crossing},
    Bound{"Ib",  "ode",            depth, "gamma_F_deg", k_none,     k_sides, weakness},
    Bound{"Ib",  "ode",            depth, "leakage",     0.016,      k_crossing},
    Bound{"Ib",  "ode",            depth, "noise_F",     0.0026,     k_crossing},
    Bound{"Ib",  "ode",            depth, "jump_F",      0.035,      k_set},
    Bound{"Ib",  "ode",            depth, "gain_F",      1.7,        k_scale, scale},
    Bound{"Ib",  "ode",            depth, "nu_F",        0.23,       k_energy},
    Bound{"II",  "bullet-gimpact", depth, "sigma_F",     0.17,       k_clipped},
    Bound{"II",  "bullet-gimpact", depth, "gamma_F_deg", 3.2,        k_clipped},
    Bound{"II",  "bullet-gimpact", depth, "leakage",     0.19,       k_clipped},
    Bound{"II",  "bullet-gimpact", depth, "noise_F",     0.0017,     k_clipped},
    Bound{"II",  "bullet-gimpact", depth, "lag",         0.14,       k_clipped},
    Bound{"II",  "bullet-gimpact", depth, "loop_work",   0.0038,     k_clipped},
    Bound{"II",  "bullet-gimpact", depth, "jump_F",      0.0073,     k_set},
    Bound{"II",  "bullet-gimpact", depth, "gain_F",      0.0723,     k_scale, scale},
    Bound{"II",  "bullet-gimpact", depth, "nu_F",        0.38,       k_energy},
    Bound{"II",  "ode",            depth, "sigma_F",     0.055,      k_crossing},
    Bound{"II",  "ode",            depth, "gamma_F_deg", 1.2,        k_crossing},
    Bound{"II",  "ode",            depth, "leakage",     0.034,      k_crossing},
    Bound{"II",  "ode",            depth, "noise_F",     0.0013,     k_crossing},
    Bound{"II",  "ode",            depth, "lag",         0.0017,     k_crossing},
    Bound{"II",  "ode",            depth, "loop_work",   5.1e-5,     k_crossing},
    Bound{"II",  "ode",            depth, "jump_F",      0.021,      k_set},
    Bound{"II",  "ode",            depth, "gain_F",      0.0518,     k_scale, scale},
    Bound{"II",  "ode",            depth, "nu_F",        0.1,        k_energy},
    Bound{"III", "bullet-gimpact", depth, "sigma_T",     k_none,     k_behind, weakness},
    Bound{"III", "bullet-gimpact", depth, "gamma_T_deg", k_none,     k_sides, weakness},
    Bound{"III", "bullet-gimpact", depth, "leakage",     0.88,       k_behind},
    Bound{"III", "bullet-gimpact", depth, "noise_T",     k_none,     k_behind, weakness},
    Bound{"III", "bullet-gimpact", depth, "jump_T",      1.3,        k_set},
    Bound{"III", "bullet-gimpact", depth, "gain_T",      1.26,       k_scale, scale},
    Bound{"III", "bullet-gimpact", depth, "nu_T",        0.31,       k_energy},
    Bound{"III", "ode",            depth, "sigma_T",     k_none,     k_crossing, weakness},
    Bound{"III", "ode",            depth, "gamma_T_deg", k_none,     k_sides, weakness},
    Bound{"III", "ode",            depth, "leakage",     0.81,       k_crossing},
    Bound{"III", "ode",            depth, "noise_T",     0.26,       k_crossing},
    Bound{"III", "ode",            depth, "jump_T",      0.93,       k_set},
    Bound{"III", "ode",            depth, "gain_T",      1.38,       k_scale, scale},
    Bound{"III", "ode",            depth, "nu_T",        0.026,      k_energy},
    Bound{"IV",  "bullet-gimpact", depth, "sigma_F",     0.5,        k_behind},
    Bound{"IV",  "bullet-gimpact", depth, "gamma_F_deg", 40,         k_behind},
    Bound{"IV",  "bullet-gimpact", depth, "leakage",     4.3,        k_behind},
    Bound{"IV",  "bullet-gimpact", depth, "noise_F",     0.42,       k_behind},
    Bound{"IV",  "bullet-gimpact", depth, "lag",         k_none,     k_behind, weakness},
    Bound{"IV",  "bullet-gimpact", depth, "loop_work",   0.023,      k_behind},
    Bound{"IV",  "bullet-gimpact", depth, "jump_F",      1.1,        k_set},
    Bound{"IV",  "bullet-gimpact", depth, "gain_F",      0.0335,     k_scale, scale},
    Bound{"IV",  "bullet-gimpact", depth, "nu_F",        1.8,        k_energy},
    Bound{"IV",  "ode",            depth, "sigma_F",     0.37,       k_crossing},
    Bound{"IV",  "ode",            depth, "gamma_F_deg", 10,         k_crossing},
    Bound{"IV",  "ode",            depth, "leakage",     1.6,        k_crossing},
    Bound{"IV",  "ode",            depth, "noise_F",     0.027,      k_crossing},
    Bound{"IV",  "ode",            depth, "lag",         k_none,     k_crossing, weakness},
    Bound{"IV",  "ode",            depth, "loop_work",   0.063,      k_crossing},
    Bound{"IV",  "ode",            depth, "jump_F",      0.47,       k_set},
    Bound{"IV",  "ode",            depth, "gain_F",      0.0337,     k_scale, scale},
    Bound{"IV",  "ode",            depth, "nu_F",        1.3,        k_energy},
};
// clang-format on

}  // namespace

std::span<const Bound> backend_bounds() { return k_backend_bounds; }

}  // namespace sixdof
