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

/// Two nodes or leaves still to be looked into: an index into nodes(), or k_leaf plus an index into leaves().
struct OpenPair {
  static constexpr std::uint32_t k_leaf = 1u << 31;
  std::uint32_t a;
  std::uint32_t b;
  float lower;  // bound on the distance; negative: how deep the volumes overlap
};

/// A pair whose exact distance may wait until the end: its bound is small, but it is not certain to be the closest.
struct DeferredPair {
  TrianglePair pair;
  float lower;
};

/// What a traversal looked at, for tuning and for tests that it stays sub-linear.
struct TraversalCounts {
  std::uint64_t nodes = 0;       ///< Nodes whose children were tested against a volume.
  std::uint64_t leaf_pairs = 0;  ///< Pairs of leaves whose triangles were bounded.
  std::uint64_t triangles = 0;   ///< Pairs of triangles measured exactly.
};

/// A few corners spread over a surface, to begin a search with.
struct Samples {
  static constexpr std::size_t k_count = 64;
  explicit Samples(const Tree& tree);
  alignas(64) float point[3][k_count];  ///< Relative to the tree's centre.
  std::uint32_t leaf[k_count];          ///< The leaf each was taken from: the first corner of its first triangle.
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
  std::vector<OpenPair> open;          ///< Scratch.
  std::vector<DeferredPair> deferred;  ///< Scratch.
};

/// Offers the exact distance of one pair. Ties go to the pair with the smaller index in mesh A, then mesh B, so that
/// the order of the offers plays no part. Returns whether the distance went down.
bool offer_pair(Traversal& traversal, TrianglePair pair, const TriangleCorners& a, const TriangleCorners& b);

/// Offers one pair that is probably close: from the closest samples, by turns to the closest corner of the other mesh.
void offer_seed(Traversal& traversal, const Samples& a, const Samples& b);

/// Finds the closest pair of triangles below traversal.best.
void find_closest(Traversal& traversal);

/// Finds any intersecting pair of triangles: sets found and pair.
void find_intersection(Traversal& traversal);

}  // namespace sixdof::detail
