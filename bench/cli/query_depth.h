#pragma once

#include <cstdint>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>

namespace sixdof::cli {

/// What `sixdof query --depth` asks.
struct DepthRequest {
  bool asked = false;
  double tolerance = 1e-3;         ///< PenetrationOptions::tolerance.
  std::uint64_t budget = 400'000;  ///< PenetrationOptions::budget.
  std::vector<double> along;       ///< Three numbers of a direction, or none.
};

/// The interval of the penetration depth, and the depth along a direction, as keys and values.
/// @throws BadMesh unless both meshes are solids, BadArgument
nlohmann::ordered_json describe_depth(const Mesh& a, const Mesh& b, const Pose& X_AB, const DepthRequest& request);

}  // namespace sixdof::cli
