#pragma once

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/oracle/distance_flats.h>

/// The branch and bound behind DistanceOracle. Internal: use distance.h.
namespace sixdof::detail {

/// A pair of triangles in tree order.
struct TrianglePair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

/// Two nodes, leaves or triangles still to be looked into: an index into nodes(), k_leaf plus an index into leaves(),
/// or k_triangle plus an index into corners().
struct OpenPair {
  static constexpr std::uint32_t k_leaf = 1u << 31;
  static constexpr std::uint32_t k_triangle = 1u << 30;
  std::uint32_t a;
  std::uint32_t b;
  float lower;  // bound on the distance; negative: how deep the volumes overlap
};

/// A pair whose exact distance may wait until the end: its bound is small, but it is not certain to be the closest.
struct DeferredPair {
  TrianglePair pair;
  float lower;
};

/// Indices of a pair's triangles into mesh A's and mesh B's triangles(): decides ties.
using Rank = std::pair<std::uint32_t, std::uint32_t>;
inline constexpr Rank k_no_rank{~std::uint32_t{0}, ~std::uint32_t{0}};

/// What may hold ties, and the lowest rank that a pair of their triangles can have.
struct RankedPair {
  Rank lowest;
  OpenPair pair;
};

/// What was left alone because it may tie with the closest pair, no more.
struct TiedPair {
  OpenPair pair;
  double lower;  // bound on the distance
};

/// A pair of triangles and its exact distance.
struct MeasuredPair {
  TrianglePair pair;
  double distance;
};

/// How rounding blurs the distances of flat parts, as lengths; all 0 where a mesh has none. See DistanceQuery.
struct TieWindow {
  double error = 0.0;   ///< Of plane_gap() against triangle_triangle_distance().
  double margin = 0.0;  ///< A gap that comes so close to the smallest distance is a tie.
  double width = 0.0;   ///< Distances that exceed the smallest one by no more count as equal to it.
  static TieWindow of(const Tree& a, const Flats& flats_a, const Tree& b, const Flats& flats_b, const Pose& X_AB);
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
  const Flats* flats_a = nullptr;
  const Flats* flats_b = nullptr;
  Pose X_AB;
  TieWindow ties;
  double best =
      std::numeric_limits<double>::infinity();  ///< Only smaller distances are of interest; then the smallest.
  bool found = false;                           ///< `pair` and `closest` are set.
  TrianglePair pair;
  ClosestPoints closest;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< Guess of the direction from A to B at the closest points.
  TraversalCounts counts;
  std::vector<OpenPair> open;          ///< Scratch.
  std::vector<DeferredPair> deferred;  ///< Scratch.
  std::vector<MeasuredPair> measured;  ///< Those not above best + ties.width, as best was then.
  std::vector<TiedPair> tied;          ///< Scratch.
  std::vector<RankedPair> ranked;      ///< Scratch.
};

/// Offers the exact distance of one pair. Returns whether the distance went down.
bool offer_pair(Traversal& traversal, TrianglePair pair);

/// Exact distance, lower bound on it, and exact test of one pair.
ClosestPoints distance_of(const Traversal& traversal, TrianglePair pair);
double gap_of(const Traversal& traversal, TrianglePair pair);
bool intersects(const Traversal& traversal, TrianglePair pair);

Rank rank_of(const Traversal& traversal, TrianglePair pair);

/// Offers one pair that is probably close: from the closest samples, by turns to the closest corner of the other mesh.
/// Does nothing if a pair closer than the closest samples is known.
void offer_seed(Traversal& traversal, const Samples& a, const Samples& b);

/// Finds the closest pair of triangles not above traversal.best. Of all pairs that exceed the smallest distance by no
/// more than ties.width, that with the lowest index in mesh A, then in mesh B, is taken: neither the order in which
/// pairs are met nor what was offered before plays a part. Distance 0 ends the search, with any pair that meets.
void find_closest(Traversal& traversal);

/// Finds any intersecting pair of triangles: sets found and pair.
void find_intersection(Traversal& traversal);

}  // namespace sixdof::detail
