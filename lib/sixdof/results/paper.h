#pragma once

#include <algorithm>
#include <array>
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

/// Voxels of the fixed body along its axes and points of the moving one (section 4.2.2), of k_paper_resolution_of. The
/// text says "Scenario I": both Ia and Ib.
struct PaperResolution {
  std::string_view scenario;
  std::array<int, 3> voxels;
  int points;
};
inline constexpr std::string_view k_paper_resolution_of = "vps";
inline constexpr PaperResolution k_paper_resolutions[]{{"Ia", {728, 24, 303}, 15669},
                                                       {"Ib", {728, 24, 303}, 15669},
                                                       {"II", {491, 816, 491}, 12640},
                                                       {"III", {1204, 604, 603}, 12474},
                                                       {"IV", {243, 123, 123}, 13295}};

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
