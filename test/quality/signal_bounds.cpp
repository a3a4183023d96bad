#include "signal_bounds.h"

namespace sixdof {
namespace {

// Volumes of some thousand terms, and spectra of two hundred unit vectors.
constexpr double k_rounding = 1e-9;

constexpr std::string_view k_flat = "the penalty is the volume of a flat contact: rounding only";
constexpr std::string_view k_steady = "the direction is steady and right: rounding only";

using enum IdealLaw;
using enum Kind;

}  // namespace

// clang-format off
const std::vector<BoundLine>& signal_bounds() {
  static const std::vector<BoundLine> lines{
    // scenario, algorithm, law, reason, kind, measures
    {"Ia", "exact", gradient, k_flat, required, {{"sigma_q", k_rounding}, {"gain_q", k_rounding}}},
    {"Ia", "exact", gradient, k_steady, required, {{"nu_direction_F", k_rounding}}},
    {"Ib", "exact", gradient, k_flat, required, {{"sigma_q", k_rounding}, {"gain_q", k_rounding}}},
    {"Ib", "exact", gradient, k_steady, required, {{"nu_direction_F", k_rounding}}},
    {"III", "exact", gradient, k_flat, required, {{"sigma_q", k_rounding}, {"gain_q", k_rounding}}},
    {"III", "exact", gradient, k_steady, required, {{"nu_direction_T", k_rounding}}},
  };
  return lines;
}
// clang-format on

}  // namespace sixdof
