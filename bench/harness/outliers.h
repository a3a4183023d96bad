#pragma once

#include <map>
#include <optional>
#include <string>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include <sixdof/geometry/pose.h>
#include <sixdof/query/algorithm.h>

/// The configurations at which a row is at its worst, so that each can be looked at and asked again alone.

namespace sixdof::bench {

/// A response beside the exact one, both about the same point.
struct ComparedResponse {
  Eigen::Vector3d force, torque;  ///< Measured, in A's frame; in units of the algorithm's own.
  Response exact;
};

/// One configuration.
struct Outlier {
  Pose X_AB;
  std::optional<ComparedResponse> response = {};  ///< Of an outlier of forces or torques.
};

/// Those of one row.
struct Outliers {
  std::string a, b;     ///< Meshes as a command line names them.
  std::string command;  ///< `sixdof query` with everything but --pose; empty for a program of --external.
  /// By counter: where its largest value is, or the first configuration that it counts.
  std::map<std::string, Outlier> by_counter;

  void add(const std::string& counter, const std::optional<Pose>& X_AB) {
    if (X_AB) by_counter[counter] = {.X_AB = *X_AB};
  }
};

/// Their key in a row's object.
inline constexpr const char* k_outliers_key = "outliers";

/// {"a": "elephant", "b": "elephant", "command": "sixdof query ...", "poses": {"max_ns": "tx ty tz qw qx qy qz"},
/// "responses": {"gamma_max_F_deg": {"force": [x, y, z], "torque", "exact_force", "exact_torque", "reference"}}}.
/// A pose asks at the same translation; its rotation differs by a few roundings (TypedPose). Members without content
/// are left out.
nlohmann::ordered_json to_json_object(const Outliers& outliers);

/// `sixdof query --a A --b B --algorithm NAME` with the parameters that have not their default; empty for a program of
/// --external.
std::string query_command(const std::string& a, const std::string& b, const Algorithm& algorithm,
                          const Settings& settings);

}  // namespace sixdof::bench
