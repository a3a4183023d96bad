#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <sixdof/geometry/pose.h>

/// The configurations at which a row is at its worst, so that each can be looked at and asked again alone.

namespace sixdof::results {

/// Of a response at one configuration: what was measured and what is exact, in A's frame; torques about `reference`.
struct ComparedResponse {
  std::array<double, 3> force{}, torque{}, exact_force{}, exact_torque{}, reference{};
};

/// Of contacts at one configuration, for a picture: rounded to a millionth of A's diagonal, in A's frame.
struct ContactPicture {
  std::vector<std::array<double, 6>> contacts{};  ///< Points and normals.
  std::vector<std::array<double, 6>> curve{};     ///< Starts and ends of segments in which the surfaces cross.
};

/// Those of a row, by counter: where its largest value is, or the first configuration that it counts.
struct Outliers {
  std::string a = {}, b = {};                     ///< Meshes as a command line names them: names of models, or files.
  std::string command = {};                       ///< `sixdof query` with everything but --pose; may be empty.
  std::map<std::string, std::string> poses = {};  ///< As --pose takes them; rotations within a few roundings.
  std::map<std::string, ComparedResponse> responses = {};  ///< Of some of the poses.
  std::map<std::string, ContactPicture> contacts = {};     ///< Likewise.

  void add(const std::string& counter, const std::optional<Pose>& X_AB);

  /// The counter whose outlier represents a value of the row: for a mean, the counter of the largest single value.
  /// Empty where there is no such pose.
  std::string counter_of(const std::string& value) const;
  /// The command line that asks at the outlier of a value; empty where there is none.
  std::string command_of(const std::string& value) const;
};

/// Their key in a row's object.
inline constexpr const char* k_outliers_key = "outliers";

/// {"a", "b", "command", "poses": {COUNTER: "tx ty tz qw qx qy qz"}, "responses": {COUNTER: {"force": [x, y, z],
/// ...}}, "contacts": {COUNTER: {"contacts": [[...], ...], "curve": [[...], ...]}}}, without members that have no
/// content.
nlohmann::ordered_json to_json_object(const Outliers& outliers);

/// The inverse. @throws Error with what is wrong, e.g. "outliers.poses.max_ns is no pose"
Outliers parse_outliers(const nlohmann::ordered_json& object);

/// "tx ty tz qw qx qy qz" as w, x, y, z, tx, ty, tz; empty if these are not seven finite numbers.
std::optional<std::array<double, 7>> typed_pose(const std::string& text);

/// What the outlier of a counter is, e.g. "longest query"; the counter itself if it is not known.
std::string words_of_outlier(const std::string& counter);

}  // namespace sixdof::results
