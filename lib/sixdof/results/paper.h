#pragma once

#include <algorithm>
#include <optional>
#include <string_view>

/// What Weller et al. 2010 print of vps and ist (lib/sixdof/scenario/README.md).

namespace sixdof::results {

struct PaperValue {
  std::string_view scenario, algorithm, measure;
  double value;
};

/// Measures at k_paper_mean_ns, by names of the table of metrics; and the mean |eta predicted - measured| over all
/// scenarios (section 3.2.3).
inline constexpr const char* k_eta_difference = "eta_difference";
inline constexpr PaperValue k_paper_values[]{
    {"Ia", "vps", "sigma_F", 0.043},      {"Ia", "ist", "sigma_F", 0.176},  {"II", "vps", "gamma_F_deg", 2.4},
    {"II", "ist", "gamma_F_deg", 7.64},   {"III", "vps", "sigma_T", 0.169}, {"III", "ist", "sigma_T", 0.112},
    {"III", "vps", "nu_T", 0.62},         {"III", "ist", "nu_T", 1.12},     {"", "vps", k_eta_difference, 0.012},
    {"", "ist", k_eta_difference, 0.021},
};

/// Mean query time of the paper's table, on a Core2 Quad Q9450 (2008).
inline constexpr double k_paper_mean_ns = 0.9e6;

inline std::optional<double> paper_value(std::string_view scenario, std::string_view algorithm,
                                         std::string_view measure) {
  const auto* const found = std::ranges::find_if(k_paper_values, [&](const PaperValue& each) {
    return each.scenario == scenario && each.algorithm == algorithm && each.measure == measure;
  });
  return found == std::ranges::end(k_paper_values) ? std::nullopt : std::optional(found->value);
}

}  // namespace sixdof::results
