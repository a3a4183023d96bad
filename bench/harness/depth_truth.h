#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sixdof/geometry/mesh.h>
#include <sixdof/oracle/depth_integral.h>
#include <sixdof/query/algorithm.h>

namespace sixdof::bench {

/// The wrench of a law of depth at a pose.
struct DepthTruth {
  Response response;           ///< Without a volume.
  bool force_judged = false;   ///< Whether the force is known to k_judged_error.
  bool torque_judged = false;  ///< Likewise the torque.

  /// A truth with a larger estimate of its error, over its length, judges nothing.
  static constexpr double k_judged_error = 0.01;
};

/// What the own law of algorithms of depth says (oracle/depth_integral.h), by quadrature: for rows that compare
/// responses. Truths are kept in the cache on disk (base/cache.h), by the content of the meshes and the poses.
class DepthTruths {
 public:
  /// Both outlive it. Nothing is computed here.
  DepthTruths(const Mesh& a, const Mesh& b) : a_(&a), b_(&b) {}

  /// Poses of a row that are judged, at most: a quadrature may take a second.
  static constexpr std::size_t k_most = 32;

  /// At the first of the poses, k_most at most. Valid until the next call.
  /// @param law one that is_of_depth(); contacts have the truth of ResponseLaw::depth
  /// @throws BadMesh unless both meshes are solids
  std::span<const DepthTruth> at(std::span<const Pose> poses, ResponseLaw law);

 private:
  DepthTruth compute(const Pose& X_AB, DepthDirection direction);

  const Mesh* a_;
  const Mesh* b_;
  std::unique_ptr<const DepthOracle> oracle_;             ///< Made when a truth is not in the cache.
  std::map<std::string, std::vector<DepthTruth>> known_;  ///< By the key of the cache.
};

}  // namespace sixdof::bench
