#include <sixdof/process/protocol_values.h>

namespace sixdof::protocol {

// JSON has no words for what is not finite.
constexpr const char* k_nan = "nan";
constexpr const char* k_infinity = "inf";
constexpr const char* k_minus_infinity = "-inf";

Json number(double value) {
  if (std::isnan(value)) return k_nan;
  if (std::isinf(value)) return value > 0.0 ? k_infinity : k_minus_infinity;
  return value;
}

double number_of(const Json& json) {
  if (json.is_number()) return json.get<double>();
  const auto word = json.get<std::string>();
  if (word == k_nan) return std::numeric_limits<double>::quiet_NaN();
  if (word == k_infinity) return std::numeric_limits<double>::infinity();
  if (word == k_minus_infinity) return -std::numeric_limits<double>::infinity();
  throw Malformed(fmt::format("\"{}\" is no number", word));
}

double time_of(const Json& json) {
  const double ns = number_of(json);
  if (!std::isfinite(ns) || ns < 0.0) throw Malformed("a time is negative or not finite");
  return ns;
}

Json vector(const Eigen::Vector3d& v) { return {number(v.x()), number(v.y()), number(v.z())}; }

Eigen::Vector3d vector_of(const Json& json) {
  if (json.size() != 3) throw Malformed("a vector does not have three numbers");
  return {number_of(json.at(0)), number_of(json.at(1)), number_of(json.at(2))};
}

constexpr std::size_t k_pose_numbers = 12;

Json pose(const Pose& X_AB) {
  Json numbers = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) numbers.push_back(number(X_AB.R(row, column)));
  }
  for (const double x : X_AB.t) numbers.push_back(number(x));
  return numbers;
}

Pose pose_of(const Json& json) {
  if (json.size() != k_pose_numbers) throw Malformed("a pose does not have twelve numbers");
  Pose X_AB;
  for (int i = 0; i < 9; ++i) X_AB.R(i / 3, i % 3) = number_of(json.at(static_cast<std::size_t>(i)));
  for (int i = 0; i < 3; ++i) X_AB.t[i] = number_of(json.at(static_cast<std::size_t>(9 + i)));
  return X_AB;
}

Motion motion_of(const Json& json, const Pose& start) {
  return {start, vector_of(json.at("translation")), vector_of(json.at("rotation")), vector_of(json.at("reference"))};
}

Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

std::vector<double> times_of(const Json& json) {
  if (!json.is_array()) throw Malformed("times are not a list");
  std::vector<double> values;
  for (const Json& value : json) values.push_back(time_of(value));
  return values;
}

void put(Json& json, bool answer) { json["collide"] = answer; }
void put(Json& json, const Separation& answer) {
  json["distance"] = number(answer.distance);
  if (answer.has_witnesses) json.update({{"a", vector(answer.witness_a)}, {"b", vector(answer.witness_b)}});
  if (answer.triangle_a != Separation::k_no_triangle) json["triangle_a"] = answer.triangle_a;
  if (answer.triangle_b != Separation::k_no_triangle) json["triangle_b"] = answer.triangle_b;
}
void put(Json& json, const Response& answer) {
  json["penalty"] = number(answer.penalty);
  if (!std::isnan(answer.volume)) json["volume"] = number(answer.volume);
  json.update(
      {{"force", vector(answer.force)}, {"torque", vector(answer.torque)}, {"reference", vector(answer.reference)}});
}

void put(Json& json, const Impact& answer) {
  json["hit"] = answer.hit;
  if (!answer.hit) return;
  json["t"] = number(answer.t);
  if (answer.has_witnesses) json.update({{"a", vector(answer.witness_a)}, {"b", vector(answer.witness_b)}});
  if (!answer.normal.isZero(0.0)) json["normal"] = vector(answer.normal);
}

void put(Json& json, const Contacts& answer) {
  for (const char* key : {"points", "normals", "depths"}) json[key] = Json::array();
  for (const Contact& each : answer.list) {
    json["points"].push_back(vector(each.point));
    json["normals"].push_back(vector(each.normal));
    json["depths"].push_back(number(each.depth));
  }
}

void take(const Json& json, bool& answer) { answer = json.at("collide").get<bool>(); }
void take(const Json& json, Separation& answer) {
  answer.distance = number_of(json.at("distance"));
  answer.has_witnesses = json.contains("a");
  if (answer.has_witnesses) {
    answer.witness_a = vector_of(json.at("a"));
    answer.witness_b = vector_of(json.at("b"));
  }
  if (json.contains("triangle_a")) answer.triangle_a = count_of<std::uint32_t>(json.at("triangle_a"));
  if (json.contains("triangle_b")) answer.triangle_b = count_of<std::uint32_t>(json.at("triangle_b"));
}
void take(const Json& json, Response& answer) {
  answer.penalty = number_of(json.at("penalty"));
  if (json.contains("volume")) answer.volume = number_of(json.at("volume"));
  answer.force = vector_of(json.at("force"));
  answer.torque = vector_of(json.at("torque"));
  answer.reference = vector_of(json.at("reference"));
}

void take(const Json& json, Impact& answer) {
  answer.hit = json.at("hit").get<bool>();
  if (!answer.hit) return;
  answer.t = number_of(json.at("t"));
  answer.has_witnesses = json.contains("a");
  if (answer.has_witnesses) {
    answer.witness_a = vector_of(json.at("a"));
    answer.witness_b = vector_of(json.at("b"));
  }
  if (json.contains("normal")) answer.normal = vector_of(json.at("normal"));
}

void take(const Json& json, Contacts& answer) {
  const Json &points = json.at("points"), &normals = json.at("normals"), &depths = json.at("depths");
  if (!points.is_array() || normals.size() != points.size() || depths.size() != points.size()) {
    throw Malformed("not as many points, normals and depths of contacts");
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    answer.list.push_back({vector_of(points[i]), vector_of(normals.at(i)), number_of(depths.at(i))});
  }
}

}  // namespace sixdof::protocol
