#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sixdof/geometry/mesh.h>
#include <sixdof/oracle/penetration.h>

namespace sixdof::bench {

/// Intervals of the penetration depths of a pair, for rows that judge depths. Kept in the cache on disk
/// (base/cache.h), by the content of the meshes and the poses.
class PenetrationTruths {
 public:
  /// Of the meshes, which outlive it. Nothing is computed here.
  PenetrationTruths(const Mesh& a, const Mesh& b) : a_(&a), b_(&b) {}

  /// Of their convex hulls, by oracle/convex_depth.h. @throws BadMesh if the vertices of a mesh lie in a plane
  static PenetrationTruths of_hulls(const Mesh& a, const Mesh& b);

  /// Poses of a row that are judged, at most: an interval may take seconds.
  static constexpr std::size_t k_most = 32;

  /// At the first of the poses, k_most at most. Translation and counts are not kept. Valid until the next call.
  /// @throws BadMesh unless both meshes are solids
  std::span<const PenetrationDepth> at(std::span<const Pose> poses);

 private:
  PenetrationDepth compute(const Pose& X_AB);

  const Mesh* a_;
  const Mesh* b_;
  std::shared_ptr<const Mesh> hull_a_, hull_b_;                 ///< Null if it is about the meshes.
  std::unique_ptr<const PenetrationOracle> oracle_;             ///< Made when a truth is not in the cache.
  std::map<std::string, std::vector<PenetrationDepth>> known_;  ///< By the key of the cache.
};

}  // namespace sixdof::bench
