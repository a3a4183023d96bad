#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>
#include <sixdof/query/algorithm.h>
#include "bench/harness/judge.h"

namespace sixdof::bench {

/// What `exact` says of the convex hulls of two meshes: the truth of algorithms that answer for hulls
/// (Body::convex_hull).
class HullTruth {
 public:
  /// Nearer to contact than this fraction of A's diagonal, or overlapping by less than this fraction of the smaller
  /// hull's volume, nothing is judged: Qhull takes points within its rounding for coplanar, and some libraries keep
  /// vertices in 32 bits.
  static constexpr double k_contact = 1e-6;

  /// @throws BadArgument in a build without Qhull; BadMesh if the vertices of a mesh lie in a plane
  HullTruth(const Mesh& a, const Mesh& b);
  HullTruth(const HullTruth&) = delete;
  HullTruth& operator=(const HullTruth&) = delete;

  /// Empty near contact, and where `exact` has no answer.
  std::optional<KnownAnswer> at(const Pose& X_AB);

  /// @throws Error where `exact` has no answer
  std::vector<Response> responses(std::span<const Pose> poses);

 private:
  const Mesh a_, b_;
  const double diagonal_, smaller_volume_;
  std::unique_ptr<Query> query_;  ///< Of a_ and b_.
};

}  // namespace sixdof::bench
