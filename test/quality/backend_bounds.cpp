#include "backend_bounds.h"

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

}  // namespace

// clang-format off
const std::vector<BoundLine>& backend_bounds() {
  static const std::vector<BoundLine> lines{
    {"Ia", "bullet-gimpact", depth, k_clipped, characterised, {{"sigma_F", 0.058}, {"gamma_F_deg", 0.31}}},
    {"Ia", "bullet-gimpact", depth, k_clipped, characterised, {{"leakage", 0.0086}, {"noise_F", 0.002}}},
    {"Ia", "bullet-gimpact", depth, k_set, characterised, {{"jump_F", 0.37}}},
    {"Ia", "bullet-gimpact", depth, k_scale, scale, {{"gain_F", 0.986}}},
    {"Ia", "bullet-gimpact", depth, k_energy, characterised, {{"nu_F", 0.024}}},
    {"Ia", "ode", depth, k_crossing, characterised, {{"sigma_F", 0.16}, {"gamma_F_deg", 3.3}}},
    {"Ia", "ode", depth, k_crossing, characterised, {{"leakage", 0.067}, {"noise_F", 0.036}}},
    {"Ia", "ode", depth, k_set, characterised, {{"jump_F", 0.7}}},
    {"Ia", "ode", depth, k_scale, scale, {{"gain_F", 0.96}}},
    {"Ia", "ode", depth, k_energy, characterised, {{"nu_F", 0.057}}},
    {"Ib", "bullet-gimpact", depth, k_behind, characterised, {{"sigma_F", 0.88}, {"leakage", 0.075}}},
    {"Ib", "bullet-gimpact", depth, k_behind, characterised, {{"noise_F", 0.074}}},
    {"Ib", "bullet-gimpact", depth, k_sides, weakness, {{"gamma_F_deg", k_none}}},
    {"Ib", "bullet-gimpact", depth, k_set, characterised, {{"jump_F", 0.91}}},
    {"Ib", "bullet-gimpact", depth, k_scale, scale, {{"gain_F", 0.0998}}},
    {"Ib", "bullet-gimpact", depth, k_energy, characterised, {{"nu_F", 5.9}}},
    {"Ib", "ode", depth, k_crossing, characterised, {{"sigma_F", 0.3}, {"leakage", 0.016}}},
    {"Ib", "ode", depth, k_crossing, characterised, {{"noise_F", 0.0026}}},
    {"Ib", "ode", depth, k_sides, weakness, {{"gamma_F_deg", k_none}}},
    {"Ib", "ode", depth, k_set, characterised, {{"jump_F", 0.035}}},
    {"Ib", "ode", depth, k_scale, scale, {{"gain_F", 1.7}}},
    {"Ib", "ode", depth, k_energy, characterised, {{"nu_F", 0.23}}},
    {"II", "bullet-gimpact", depth, k_clipped, characterised, {{"sigma_F", 0.17}, {"gamma_F_deg", 3.2}}},
    {"II", "bullet-gimpact", depth, k_clipped, characterised, {{"leakage", 0.19}, {"noise_F", 0.0017}, {"lag", 0.14}}},
    {"II", "bullet-gimpact", depth, k_clipped, characterised, {{"loop_work", 0.0038}}},
    {"II", "bullet-gimpact", depth, k_set, characterised, {{"jump_F", 0.0073}}},
    {"II", "bullet-gimpact", depth, k_scale, scale, {{"gain_F", 0.0723}}},
    {"II", "bullet-gimpact", depth, k_energy, characterised, {{"nu_F", 0.38}}},
    {"II", "ode", depth, k_crossing, characterised, {{"sigma_F", 0.055}, {"gamma_F_deg", 1.2}}},
    {"II", "ode", depth, k_crossing, characterised, {{"leakage", 0.034}, {"noise_F", 0.0013}}},
    {"II", "ode", depth, k_crossing, characterised, {{"lag", 0.0017}, {"loop_work", 5.1e-5}}},
    {"II", "ode", depth, k_set, characterised, {{"jump_F", 0.021}}},
    {"II", "ode", depth, k_scale, scale, {{"gain_F", 0.0518}}},
    {"II", "ode", depth, k_energy, characterised, {{"nu_F", 0.1}}},
    {"III", "bullet-gimpact", depth, k_behind, weakness, {{"sigma_T", k_none}, {"noise_T", k_none}}},
    {"III", "bullet-gimpact", depth, k_sides, weakness, {{"gamma_T_deg", k_none}}},
    {"III", "bullet-gimpact", depth, k_behind, characterised, {{"leakage", 0.88}}},
    {"III", "bullet-gimpact", depth, k_set, characterised, {{"jump_T", 1.3}}},
    {"III", "bullet-gimpact", depth, k_scale, scale, {{"gain_T", 1.26}}},
    {"III", "bullet-gimpact", depth, k_energy, characterised, {{"nu_T", 0.31}}},
    {"III", "ode", depth, k_crossing, weakness, {{"sigma_T", k_none}}},
    {"III", "ode", depth, k_sides, weakness, {{"gamma_T_deg", k_none}}},
    {"III", "ode", depth, k_crossing, characterised, {{"leakage", 0.81}, {"noise_T", 0.26}}},
    {"III", "ode", depth, k_set, characterised, {{"jump_T", 0.93}}},
    {"III", "ode", depth, k_scale, scale, {{"gain_T", 1.38}}},
    {"III", "ode", depth, k_energy, characterised, {{"nu_T", 0.026}}},
    {"IV", "bullet-gimpact", depth, k_behind, characterised, {{"sigma_F", 0.5}, {"gamma_F_deg", 40}}},
    {"IV", "bullet-gimpact", depth, k_behind, characterised, {{"leakage", 4.3}, {"noise_F", 0.42}}},
    {"IV", "bullet-gimpact", depth, k_behind, characterised, {{"loop_work", 0.023}}},
    {"IV", "bullet-gimpact", depth, k_behind, weakness, {{"lag", k_none}}},
    {"IV", "bullet-gimpact", depth, k_set, characterised, {{"jump_F", 1.1}}},
    {"IV", "bullet-gimpact", depth, k_scale, scale, {{"gain_F", 0.0335}}},
    {"IV", "bullet-gimpact", depth, k_energy, characterised, {{"nu_F", 1.8}}},
    {"IV", "ode", depth, k_crossing, characterised, {{"sigma_F", 0.37}, {"gamma_F_deg", 10}}},
    {"IV", "ode", depth, k_crossing, characterised, {{"leakage", 1.6}, {"noise_F", 0.027}}},
    {"IV", "ode", depth, k_crossing, characterised, {{"loop_work", 0.063}}},
    {"IV", "ode", depth, k_crossing, weakness, {{"lag", k_none}}},
    {"IV", "ode", depth, k_set, characterised, {{"jump_F", 0.47}}},
    {"IV", "ode", depth, k_scale, scale, {{"gain_F", 0.0337}}},
    {"IV", "ode", depth, k_energy, characterised, {{"nu_F", 1.3}}},
  };
  return lines;
}
// clang-format on

}  // namespace sixdof
