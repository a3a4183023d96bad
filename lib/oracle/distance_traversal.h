#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/geometry/triangle_distance.h>

/// The branch and bound behind DistanceOracle. Internal: use distance.h.
namespace sixdof::detail {

/// A pair of triangles in tree order.
struct TrianglePair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

/// Two children still to be looked into. A child is named by 8 * node + lane, the whole tree by k_root.
struct OpenPair {
  static constexpr std::uint32_t k_root = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t a;
  std::uint32_t b;
  float lower;  // bound on the distance; negative: how deep the volumes overlap
};

/// What a traversal looked at, for tuning and for tests that it stays sub-linear.
struct TraversalCounts {
  std::uint64_t nodes = 0;       ///< Nodes whose children were tested against a volume.
  std::uint64_t leaf_pairs = 0;  ///< Pairs of leaves whose triangles were bounded.
  std::uint64_t triangles = 0;   ///< Pairs of triangles measured exactly.
};

/// In and out of a traversal.
struct Traversal {
  const Tree* a = nullptr;
  const Tree* b = nullptr;
  Pose X_AB;
  double best =
      std::numeric_limits<double>::infinity();  ///< Only smaller distances are of interest; then the smallest.
  bool found = false;                           ///< `pair` and `closest` are set.
  TrianglePair pair;
  ClosestPoints closest;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< Guess of the direction from A to B at the closest points.
  TraversalCounts counts;
  std::vector<OpenPair> open;  ///< Scratch.
};

/// Offers the exact distance of one pair. Ties go to the pair with the smaller index in mesh A, then mesh B, so that
/// the order of the offers plays no part. Returns whether the distance went down.
bool offer_pair(Traversal& traversal, TrianglePair pair, const TriangleCorners& a, const TriangleCorners& b);

/// Finds the closest pair of triangles below traversal.best.
void find_closest(Traversal& traversal);

/// Finds any intersecting pair of triangles: sets found and pair.
void find_intersection(Traversal& traversal);

}  // namespace sixdof::detail
