#include "bounds.h"

#include <array>

namespace sixdof {
namespace {

constexpr double k_zero = 0.0;
constexpr double k_rounding = 1e-9;

constexpr std::string_view k_flat = "flat contact: rounding only";
constexpr std::string_view k_regular = "regular polygon, sideways parts cancel: rounding only";
constexpr std::string_view k_facets = "96 facets, falls with the facets";
constexpr std::string_view k_conservative = "gradient of a volume: rounding only";
constexpr std::string_view k_no_miss = "does not tunnel";
constexpr std::string_view k_answers = "answers every stamp";
constexpr std::string_view k_pairs = "FCL's depth of a pair of triangles, mean over pairs";
constexpr std::string_view k_blind = "FCL's normal is that of the nearer side: through the plate, downwards";
constexpr std::string_view k_packing = "default packing of spheres; what is unfilled is not felt";

using enum IdealLaw;

// One row a line on purpose: a table to be read.
// clang-format off
constexpr std::array k_bounds{
    // scenario, algorithm, law, measure, bound, reason
    Bound{"Ia",  "exact",        gradient, "sigma_F",     k_rounding, k_flat},
    Bound{"Ia",  "exact",        volume,   "sigma_F",     k_rounding, k_flat},
    Bound{"Ia",  "exact",        volume,   "gamma_F_deg", k_rounding, k_regular},
    Bound{"Ia",  "exact",        volume,   "misses",      k_zero,     k_no_miss},
    Bound{"Ia",  "exact",        volume,   "failed",      k_zero,     k_answers},
    Bound{"Ia",  "exact",        volume,   "leakage",     k_rounding, k_regular},
    Bound{"Ia",  "exact",        volume,   "noise_F",     k_rounding, k_flat},
    Bound{"Ib",  "exact",        volume,   "sigma_F",     k_rounding, k_flat},
    Bound{"Ib",  "exact",        volume,   "gamma_F_deg", k_rounding, k_regular},
    Bound{"Ib",  "exact",        volume,   "misses",      k_zero,     k_no_miss},
    Bound{"II",  "exact",        gradient, "sigma_F",     1.6e-4,     k_facets},
    Bound{"II",  "exact",        volume,   "gamma_F_deg", 6e-3,       k_facets},
    Bound{"II",  "exact",        volume,   "leakage",     1.2e-4,     k_facets},
    Bound{"II",  "exact",        volume,   "noise_F",     k_rounding * 20, k_facets},
    Bound{"II",  "exact",        volume,   "loop_work",   k_rounding, k_conservative},
    Bound{"II",  "exact",        volume,   "lag",         k_rounding, k_facets},
    Bound{"III", "exact",        gradient, "sigma_T",     k_rounding, k_flat},
    Bound{"III", "exact",        volume,   "gamma_T_deg", k_rounding, k_flat},
    Bound{"III", "exact",        gradient, "misses",      k_zero,     k_flat},
    Bound{"IV",  "exact",        gradient, "sigma_F",     2e-4,       k_facets},
    Bound{"IV",  "exact",        gradient, "misses",      k_zero,     k_flat},
    Bound{"IV",  "exact",        gradient, "loop_work",   k_rounding, k_conservative},
    Bound{"Ia",  "fcl-contacts", depth,    "sigma_F",     6e-3,       k_pairs},
    Bound{"Ia",  "fcl-contacts", depth,    "gamma_F_deg", 0.03,       k_pairs},
    Bound{"Ia",  "fcl-contacts", depth,    "misses",      k_zero,     k_no_miss},
    Bound{"Ib",  "fcl-contacts", depth,    "gamma_F_deg", 180.0,      k_blind},
    Bound{"Ib",  "fcl-contacts", depth,    "misses",      k_zero,     k_blind},
    Bound{"II",  "fcl-contacts", depth,    "sigma_F",     0.13,       k_pairs},
    Bound{"II",  "fcl-contacts", depth,    "gamma_F_deg", 0.8,        k_pairs},
    Bound{"III", "fcl-contacts", depth,    "gamma_T_deg", 180.0,      k_pairs},
    Bound{"IV",  "fcl-contacts", depth,    "gamma_F_deg", 18.0,       k_pairs},
    Bound{"II",  "ist",          volume,   "sigma_F",     8e-3,       k_packing},
    Bound{"II",  "ist",          volume,   "gamma_F_deg", 1.8,        k_packing},
    Bound{"II",  "ist",          volume,   "misses",      k_zero,     k_no_miss},
    Bound{"III", "ist",          volume,   "sigma_T",     0.25,       k_packing},
    Bound{"IV",  "ist",          volume,   "gamma_F_deg", 4.3,        k_packing},
};
// clang-format on

}  // namespace

std::span<const Bound> bounds() { return k_bounds; }

Verdict judge(double value, double bound) {
  if (!(value <= bound)) return Verdict::worse;
  if (bound > k_rounding_bound && value < 0.5 * bound) return Verdict::too_loose;
  return Verdict::holds;
}

}  // namespace sixdof
