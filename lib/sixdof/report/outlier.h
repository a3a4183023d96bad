#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace sixdof::report {

/// Of a response at one configuration: what was measured and what is exact, in A's frame; torques about `reference`.
struct ComparedResponse {
  std::array<double, 3> force{}, exact_force{}, torque{}, exact_torque{}, reference{};
};

/// A configuration where a counter of a row has its largest value, or the first that it counts.
struct Outlier {
  std::string pose;  ///< As `sixdof query --pose` takes it.
  std::optional<ComparedResponse> response;
};

/// Those of a row of `sixdof-bench`.
struct Outliers {
  std::string a, b;     ///< Meshes: names of models, or files.
  std::string command;  ///< That asks at one configuration, without --pose; may be empty.
  std::map<std::string, Outlier> by_counter;

  /// The outlier that stands for a value of the row: of a mean that with the largest value, of a time the slowest
  /// query. Null where there is none.
  const Outlier* of_value(const std::string& name) const;
  /// The command line that asks at the outlier of a value; empty where there is none.
  std::string command_of(const std::string& name) const;
  std::string command_of(const Outlier& outlier) const;
};

/// The object "outliers" of a row. @throws Error with what is wrong, e.g. "outliers.poses.max_ns is no pose"
Outliers parse_outliers(const nlohmann::ordered_json& object);

/// "tx ty tz qw qx qy qz" as w, x, y, z, tx, ty, tz; empty if these are not seven finite numbers.
std::optional<std::array<double, 7>> typed_pose(const std::string& text);

/// What the outlier of a counter is, e.g. "longest query"; the counter itself if it is not known.
std::string words_of_outlier(const std::string& counter);

}  // namespace sixdof::report
