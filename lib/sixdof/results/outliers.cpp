#include <sixdof/results/outliers.h>

#include <cmath>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/geometry/typed_pose.h>
#include <sixdof/results/result_json.h>

namespace sixdof::results {
namespace {

/// Values of a row whose outlier has another counter.
constexpr std::pair<const char*, const char*> k_counter_of[] = {
    {"gamma_F_deg", "gamma_max_F_deg"},        {"gamma_F_p95_deg", "gamma_max_F_deg"},
    {"gamma_T_deg", "gamma_max_T_deg"},        {"error_rms", "error_max"},
    {"volume_error_mean", "volume_error_max"}, {"phantom_force_mean", "phantom_force_max"}};

constexpr std::pair<const char*, const char*> k_words[] = {
    {"max_ns", "longest query"},
    {"max_least_ns", "longest query, the least of three times"},
    {"error_max", "largest error"},
    {"volume_error_max", "largest error of the volume"},
    {"phantom_force_max", "largest force though the bodies are apart"},
    {"gamma_max_F_deg", "largest angle of the force"},
    {"gamma_max_T_deg", "largest angle of the torque"},
    {"magnitude_error_F", "largest error of the force's magnitude"},
    {"magnitude_error_T", "largest error of the torque's magnitude"},
    {"failed", "first without an answer"},
    {"mismatch", "first wrong answer"},
    {"contact_off_max", "contact farthest from both bodies"},
    {"contact_normal_max_deg", "normal farthest from every true one"},
    {"too_shallow_max", "depth that is too shallow by the largest part"},
    {"too_deep_max", "depth that is too deep by the largest part"},
    {"misses", "first without a force"}};

}  // namespace

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ComparedResponse, force, torque, exact_force, exact_torque, reference)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ContactPicture, contacts, curve)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Outliers, a, b, command, poses, responses, contacts)

void Outliers::add(const std::string& counter, const std::optional<Pose>& X_AB) {
  if (X_AB) poses[counter] = TypedPose::of(*X_AB).text();
}

std::string Outliers::counter_of(const std::string& value) const {
  std::string counter = value;
  for (const auto& [name, other] : k_counter_of) {
    if (value == name) counter = other;
  }
  return poses.contains(counter) ? counter : std::string();
}

std::string Outliers::command_of(const std::string& value) const {
  const std::string counter = counter_of(value);
  if (command.empty() || counter.empty()) return {};
  return fmt::format("{} --pose \"{}\"", command, poses.at(counter));
}

nlohmann::ordered_json to_json_object(const Outliers& outliers) {
  nlohmann::ordered_json object = nlohmann::json(outliers);
  if (outliers.command.empty()) object.erase("command");
  if (outliers.poses.empty()) object.erase("poses");
  if (outliers.responses.empty()) object.erase("responses");
  if (outliers.contacts.empty()) object.erase("contacts");
  return object;
}

Outliers parse_outliers(const nlohmann::ordered_json& object) {
  Outliers outliers;
  try {
    outliers = nlohmann::json(object).get<Outliers>();
  } catch (const nlohmann::json::exception& e) {
    throw Error("outliers: " + words_of(e));
  }
  for (const auto& [counter, pose] : outliers.poses) {
    if (!typed_pose(pose)) throw Error(fmt::format("outliers.poses.{} is no pose", counter));
  }
  return outliers;
}

std::optional<std::array<double, 7>> typed_pose(const std::string& text) {
  std::istringstream numbers(text);
  std::array<double, 7> n{};
  for (double& value : n) {
    if (!(numbers >> value) || !std::isfinite(value)) return std::nullopt;
  }
  std::string more;
  if (numbers >> more) return std::nullopt;
  return std::array<double, 7>{n[3], n[4], n[5], n[6], n[0], n[1], n[2]};
}

std::string words_of_outlier(const std::string& counter) {
  for (const auto& [name, words] : k_words) {
    if (counter == name) return words;
  }
  return counter;
}

}  // namespace sixdof::results
