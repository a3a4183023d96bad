#include <sixdof/scenario/path_settings.h>

#include <algorithm>

#include <sixdof/query/variant.h>

namespace sixdof {
namespace {

struct PathResolution {
  std::string_view scenario, algorithm;
  std::vector<std::string> assignments;
};

/// Of Ib and IV, for which the paper prints no value, there is none.
const std::vector<PathResolution>& resolutions() {
  static const std::vector<PathResolution> all{{"Ia", "ist", {"spheres=150000", "spheres_b=10000"}},
                                               {"II", "ist", {"spheres=300000", "spheres_b=1000"}},
                                               {"III", "ist", {"spheres=40000", "spheres_b=60000"}}};
  return all;
}

std::string parameter_of(const std::string& assignment) { return assignment.substr(0, assignment.find('=')); }

}  // namespace

Settings settings_along(std::string_view scenario, const Algorithm& algorithm,
                        const std::vector<std::string>& assignments) {
  const std::string& name = algorithm.traits().name;
  std::vector<std::string> set = variant_assignments(name);
  set.insert(set.end(), assignments.begin(), assignments.end());
  const auto is_set = [&](const std::string& parameter) {
    return std::ranges::any_of(set, [&](const std::string& each) { return parameter_of(each) == parameter; });
  };
  Settings settings = algorithm.settings();
  for (const PathResolution& resolution : resolutions()) {
    const bool is_meant = resolution.scenario == scenario && resolution.algorithm == base_name(name);
    const auto& list = resolution.assignments;
    if (is_meant && std::ranges::none_of(list, is_set, parameter_of)) settings.set_all(list);
  }
  settings.set_all(assignments);
  return settings;
}

}  // namespace sixdof
