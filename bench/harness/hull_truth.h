#pragma once

#include <memory>
#include <span>
#include <vector>

#include <sixdof/geometry/mesh.h>
#include <sixdof/query/algorithm.h>
#include "bench/harness/judge.h"

namespace sixdof::bench {

/// The true answers about the convex hulls of two meshes: those of `exact` on the hulls (common/hulls.h). A set's poses
/// are solved for the meshes, so each has a truth of its own.
class HullTruth {
 public:
  /// @throws BadMesh if the vertices of a mesh lie in a plane
  HullTruth(const Mesh& a, const Mesh& b);
  HullTruth(const HullTruth&) = delete;
  HullTruth& operator=(const HullTruth&) = delete;

  /// As the bucket of a set would have it: a distance, or an overlap volume. The bucket is that of contact (0 %), where
  /// yes/no is not judged, if the hulls are closer to contact than k_distance_slack: if they are so far apart at most,
  /// or apart once B is moved by twice that length along the force. @throws Error if `exact` has no answer
  KnownAnswer at(const Pose& X_AB);

  /// Responses of `exact` at these poses. @throws Error likewise
  std::vector<Response> responses(std::span<const Pose> poses);

 private:
  const double diagonal_;  ///< Of A's box.
  const Mesh a_;
  std::unique_ptr<const Mesh> b_;  ///< Null for copies of one mesh.
  std::unique_ptr<Query> exact_;
};

}  // namespace sixdof::bench
