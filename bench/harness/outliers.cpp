#include "bench/harness/outliers.h"

#include <array>
#include <cstddef>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/geometry/typed_pose.h>
#include <sixdof/process/remote_algorithm.h>
#include "bench/common/shell_text.h"

namespace sixdof::bench {
namespace {

using Json = nlohmann::ordered_json;

Json numbers(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

std::vector<std::string> assignments(const Settings& settings) {
  std::vector<std::string> list;
  std::istringstream text(settings.to_string());
  for (std::string item; std::getline(text, item, ',');) list.push_back(item);
  return list;
}

}  // namespace

Json to_json_object(const Outliers& outliers) {
  Json object = {{"a", outliers.a}, {"b", outliers.b}};
  if (!outliers.command.empty()) object["command"] = outliers.command;
  for (const auto& [counter, outlier] : outliers.by_counter) {
    object["poses"][counter] = TypedPose::of(outlier.X_AB).text();
    if (!outlier.response) continue;
    const auto& [force, torque, exact] = *outlier.response;
    object["responses"][counter] = {{"force", numbers(force)},
                                    {"torque", numbers(torque)},
                                    {"exact_force", numbers(exact.force)},
                                    {"exact_torque", numbers(exact.torque)},
                                    {"reference", numbers(exact.reference)}};
  }
  return object;
}

std::string query_command(const std::string& a, const std::string& b, const Algorithm& algorithm,
                          const Settings& settings) {
  const auto* const remote = dynamic_cast<const RemoteAlgorithm*>(&algorithm);
  if (remote != nullptr && remote->local() == nullptr) return {};
  std::string command = fmt::format("sixdof query --a {} --b {} --algorithm {}", shell_quoted(a), shell_quoted(b),
                                    algorithm.traits().name);
  const std::vector<std::string> chosen = assignments(settings), defaults = assignments(algorithm.settings());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i] != defaults[i]) command += " -p " + shell_quoted(chosen[i]);
  }
  return command + (is_isolated(algorithm) ? " --isolate" : "");
}

}  // namespace sixdof::bench
