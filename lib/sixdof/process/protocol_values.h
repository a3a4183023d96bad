#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/geometry/motion.h>
#include <sixdof/process/protocol.h>
#include <sixdof/query/algorithm.h>

/// Numbers, poses and answers of the protocol as JSON. Internal: use protocol.h. What reads throws Malformed, or an
/// exception of the JSON library for another kind of value.
namespace sixdof::protocol {

using Json = nlohmann::ordered_json;

/// A whole number >= 0. A conversion would cut off what is behind the point, and wrap what is negative or too large.
template <class Count>
Count count_of(const Json& json) {
  constexpr double k_exact = 0x1p53;  // doubles up to here are all whole numbers
  if (json.is_number_unsigned()) {
    const auto count = json.get<std::uint64_t>();
    if (count <= std::numeric_limits<Count>::max()) return static_cast<Count>(count);
  } else if (json.is_number_float()) {
    const auto count = json.get<double>();
    constexpr double k_most = std::min(k_exact, static_cast<double>(std::numeric_limits<Count>::max()));
    if (count >= 0.0 && count <= k_most && std::floor(count) == count) return static_cast<Count>(count);
  }
  throw Malformed("a count is not a whole number, or out of range");
}

/// A number; what is not finite as "nan", "inf" or "-inf", for which JSON has no words.
Json number(double value);
double number_of(const Json& json);  ///< Of number().
double time_of(const Json& json);    ///< Nanoseconds: finite, not negative.

Json vector(const Eigen::Vector3d& v);        ///< Three numbers.
Eigen::Vector3d vector_of(const Json& json);  ///< Of vector().

/// Twelve numbers: the rotation matrix by rows, then the translation (length).
Json pose(const Pose& X_AB);
Pose pose_of(const Json& json);  ///< Of pose().

/// A motion from a start: "translation" (length), "rotation" (radians), "reference" (length).
Motion motion_of(const Json& json, const Pose& start);

Json numbers(const std::vector<double>& values);  ///< A list of number().
std::vector<double> times_of(const Json& json);   ///< A list of time_of().

// An answer, by the keys of process/README.md, into a JSON object, and out of it.
void put(Json& json, bool answer);                ///< Yes or no.
void put(Json& json, const Separation& answer);   ///< A distance.
void put(Json& json, const Response& answer);     ///< A force and a torque.
void put(Json& json, const Impact& answer);       ///< A first contact.
void put(Json& json, const Contacts& answer);     ///< Lists of points, normals and depths.
void take(const Json& json, bool& answer);        ///< Yes or no.
void take(const Json& json, Separation& answer);  ///< A distance.
void take(const Json& json, Response& answer);    ///< A force and a torque.
void take(const Json& json, Impact& answer);      ///< A first contact.
void take(const Json& json, Contacts& answer);    ///< Contacts; `answer` is empty before.

}  // namespace sixdof::protocol
