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

  /// As a bucket of hulls would have it: a distance, or an overlap volume. It is the bucket of contact (0 %), where
  /// yes/no is not judged, if the hulls are as close to contact as k_distance_slack or, where the pose is of the set's
  /// bucket of contact, as the meshes are: if they are so far apart at most, or apart once B is moved by twice that
  /// length along the force (without a force, if the overlap is thinner than that length).
  /// @throws Error if `exact` has no answer
  KnownAnswer at(const BucketSample& bucket, const Pose& X_AB);

  /// Responses of `exact` at these poses. @throws Error likewise
  std::vector<Response> responses(std::span<const Pose> poses);

 private:
  const double diagonal_;  ///< Of A's box.
  const Mesh a_;
  std::unique_ptr<const Mesh> b_;  ///< Null for copies of one mesh.
  std::unique_ptr<Query> exact_;
};

}  // namespace sixdof::bench
