#include "bench/cli/query_depth.h"

#include <chrono>
#include <cmath>
#include <optional>

#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/oracle/penetration.h>
#include <sixdof/oracle/solid.h>
#include "bench/cli/shared.h"

namespace sixdof::cli {
namespace {

using Clock = std::chrono::steady_clock;

std::int64_t nanoseconds_since(Clock::time_point begin) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin).count();
}

}  // namespace

nlohmann::ordered_json describe_depth(const Mesh& a, const Mesh& b, const Pose& X_AB, const DepthRequest& request) {
  for (const Mesh* mesh : {&a, &b}) {
    if (!mesh->solid()) throw BadMesh(mesh->name() + ": " + mesh->why_not_solid() + k_repair_hint);
  }
  Eigen::Vector3d along = Eigen::Vector3d::Zero();
  if (!request.along.empty()) {
    along = Eigen::Vector3d(request.along.data());
    if (!(along.allFinite() && along.norm() > 0.0)) throw BadArgument("--along: not a direction");
    along.normalize();
  }
  const auto begin = Clock::now();
  const PenetrationOracle oracle(a, b);
  const std::int64_t prepare_ns = nanoseconds_since(begin);
  const auto asked = Clock::now();
  const PenetrationDepth found = oracle.evaluate(X_AB, {.tolerance = request.tolerance, .budget = request.budget});
  const std::int64_t evaluate_ns = nanoseconds_since(asked);
  const bool overlaps = found.hi > 0.0 && found.translation.norm() > 0.0;
  nlohmann::ordered_json json{
      {"depth_lo", found.lo},           {"depth_hi", found.hi},
      {"closed", found.closed},         {"relative_width", found.hi > 0.0 ? (found.hi - found.lo) / found.hi : 0.0},
      {"direction", nullptr},           {"translation", nullptr},
      {"depth_along", nullptr},         {"cells", found.cells},
      {"open_cells", found.open_cells}, {"measurements", found.measurements},
      {"casts", found.casts},           {"prepare_ns", prepare_ns},
      {"time_ns", evaluate_ns}};
  if (overlaps) {
    json["direction"] = coordinates(found.translation.normalized());
    json["translation"] = coordinates(found.translation);
  }
  if (!along.isZero(0.0)) {
    if (const std::optional<double> depth = oracle.directional_depth(X_AB, along)) json["depth_along"] = *depth;
  }
  return json;
}

}  // namespace sixdof::cli
