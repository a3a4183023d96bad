#include <sixdof/report/outlier.h>

#include <cmath>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/report/result_json.h>

namespace sixdof::report {
namespace {

using Json = nlohmann::ordered_json;

/// Values of a row whose outlier has another counter.
constexpr std::pair<const char*, const char*> k_counter_of[] = {{"gamma_F_deg", "gamma_max_F_deg"},
                                                                {"gamma_F_p95_deg", "gamma_max_F_deg"},
                                                                {"gamma_T_deg", "gamma_max_T_deg"},
                                                                {"error_rms", "error_max"},
                                                                {"volume_error_mean", "volume_error_max"}};

constexpr std::pair<const char*, const char*> k_words[] = {
    {"max_ns", "longest query"},
    {"max_least_ns", "longest query, the least of three times"},
    {"error_max", "largest error"},
    {"volume_error_max", "largest error of the volume"},
    {"gamma_max_F_deg", "largest angle of the force"},
    {"gamma_max_T_deg", "largest angle of the torque"},
    {"magnitude_error_F", "largest error of the force's magnitude"},
    {"magnitude_error_T", "largest error of the torque's magnitude"},
    {"failed", "first without an answer"},
    {"mismatch", "first wrong answer"},
    {"misses", "first without a force"}};

std::array<double, 3> vector_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  std::array<double, 3> vector{};
  const bool has_three = found != object.end() && found->is_array() && found->size() == vector.size();
  for (std::size_t i = 0; has_three && i < vector.size(); ++i) {
    if (!found->at(i).is_number()) throw Error(fmt::format("outliers: {} is no vector", key));
    vector[i] = found->at(i).get<double>();
  }
  if (!has_three) throw Error(fmt::format("outliers: {} is no vector", key));
  return vector;
}

}  // namespace

const Outlier* Outliers::of_value(const std::string& name) const {
  std::string counter = name;
  for (const auto& [value, other] : k_counter_of) {
    if (name == value) counter = other;
  }
  const auto found = by_counter.find(counter);
  return found == by_counter.end() ? nullptr : &found->second;
}

std::string Outliers::command_of(const Outlier& outlier) const {
  return command.empty() ? std::string() : fmt::format("{} --pose \"{}\"", command, outlier.pose);
}

std::string Outliers::command_of(const std::string& name) const {
  const Outlier* const outlier = of_value(name);
  return outlier == nullptr ? std::string() : command_of(*outlier);
}

Outliers parse_outliers(const Json& object) {
  if (!object.is_object()) throw Error("outliers is no object");
  Outliers outliers{
      .a = text_at(object, "a"), .b = text_at(object, "b"), .command = text_at(object, "command"), .by_counter = {}};
  const Json none = Json::object();
  const Json& poses = object.contains("poses") ? object.at("poses") : none;
  const Json& responses = object.contains("responses") ? object.at("responses") : none;
  if (!poses.is_object() || !responses.is_object()) throw Error("outliers: poses or responses is no object");
  for (const auto& [counter, pose] : poses.items()) {
    Outlier outlier{.pose = pose.is_string() ? pose.get<std::string>() : std::string(), .response = {}};
    if (!typed_pose(outlier.pose)) throw Error(fmt::format("outliers.poses.{} is no pose", counter));
    if (responses.contains(counter)) {
      const Json& response = responses.at(counter);
      if (!response.is_object()) throw Error(fmt::format("outliers.responses.{} is no object", counter));
      outlier.response = {.force = vector_at(response, "force"),
                          .exact_force = vector_at(response, "exact_force"),
                          .torque = vector_at(response, "torque"),
                          .exact_torque = vector_at(response, "exact_torque"),
                          .reference = vector_at(response, "reference")};
    }
    outliers.by_counter.emplace(counter, std::move(outlier));
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

}  // namespace sixdof::report
