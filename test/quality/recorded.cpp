#include "recorded.h"

#include <cctype>
#include <map>
#include <utility>

#include <sixdof/scenario/path_settings.h>
#include "bench/common/all_algorithms.h"

namespace sixdof {

const Recorded& recorded(const std::string& scenario, const std::string& algorithm) {
  static std::map<std::pair<std::string, std::string>, Recorded> cache;
  const auto [entry, is_new] = cache.try_emplace({scenario, algorithm});
  Recorded& r = entry->second;
  if (is_new) {
    Registry registry;
    register_all_algorithms(registry);
    const auto& [name, parameters] = subject(algorithm);
    const Algorithm& found = registry.find(name);
    r.settings = settings_along(scenario, found, parameters);
    r.scenario = make_scenario(scenario);
    r.query = found.prepare(r.scenario->a(), r.scenario->b(), r.settings);
    r.recording = record(*r.scenario, *r.query, k_gate_steps);
  }
  return r;
}

std::optional<double> measured(const Bound& bound, const Recording& recording) {
  const Recorded& r = recorded(std::string(bound.scenario), std::string(bound.algorithm));
  for (const auto& [name, value] : evaluate(*r.scenario, recording, bound.law)) {
    if (name == bound.measure) return value;
  }
  return std::nullopt;
}

std::string test_name(std::initializer_list<std::string_view> parts) {
  std::string name;
  for (const std::string_view part : parts) {
    if (!name.empty()) name += '_';
    for (const char c : part) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  }
  return name;
}

}  // namespace sixdof
