#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/oracle/coplanar_patches.h>
#include <sixdof/oracle/seed_corners.h>
#include <sixdof/oracle/support_bound.h>
#include <sixdof/proximity/close_search.h>

/// The state of one distance query. Internal: use distance.h.
namespace sixdof::detail {

/// A node, leaf or triangle of each tree: an index into nodes(), k_leaf plus an index into leaves(), or k_triangle plus
/// an index into corners(). Either both are triangles or none is.
struct NodePair {
  static constexpr std::uint32_t k_leaf = CloseVolume::k_leaf;
  static constexpr std::uint32_t k_triangle = 1u << 30;
  std::uint32_t a;
  std::uint32_t b;
  float lower;  ///< Lower bound on the distance; negative where the volumes may overlap.

  static NodePair of(TrianglePair pair, float lower) { return {k_triangle + pair.a, k_triangle + pair.b, lower}; }
  bool is_of_triangles() const { return (a & k_leaf) == 0 && (a & k_triangle) != 0; }
  TrianglePair triangles() const { return {a - k_triangle, b - k_triangle}; }
};

/// A pair of triangles and its exact distance.
struct MeasuredPair {
  TrianglePair pair;
  double distance;
};

/// Decides ties: indices into A's and into B's Mesh::triangles(), in lexicographic order.
using Rank = std::pair<std::uint32_t, std::uint32_t>;
inline constexpr Rank k_no_rank{~std::uint32_t{0}, ~std::uint32_t{0}};

/// A pair and a bound in doubles. Of a pair that was pruned as a tie it is above the smallest distance less
/// ties.margin.
struct TiedPair {
  NodePair pair;
  double lower;  ///< Lower bound on the distance.
};

/// A tied pair and the smallest rank that a pair of its triangles can have.
struct RankedPair {
  Rank smallest;
  NodePair pair;
};

float smallest_leaf_of(const Tree& tree);

/// The first vertex of each piece of a surface, in ascending order. Pieces are connected through vertices: where
/// surfaces do not intersect, all of a piece lies on one side of the other surface.
std::vector<std::uint32_t> first_vertices_of_pieces(std::span<const Triangle> triangles, std::size_t vertices);

/// One mesh prepared for distance queries.
struct DistanceBody {
  explicit DistanceBody(const Mesh& mesh);
  /// Of a mesh that deforms (deforming_mesh.h). Its patches always count; it has no piece_vertices yet.
  explicit DistanceBody(Tree made);
  /// What is found from the tree, after that of a mesh that deforms has changed.
  void update();
  std::size_t bytes() const;

  Tree tree;
  Eigen::AlignedBox3d box;  ///< In the mesh's frame.
  SupportBound bound;       ///< Of a mesh that deforms: that of its box.
  CoplanarPatches patches;
  SeedCorners seeds;
  float smallest_leaf;  ///< Square of the shortest diagonal of a leaf's box.
  /// Of each connected piece of the surface one vertex; empty unless the mesh is solid.
  std::vector<Eigen::Vector3d> piece_vertices;
};

/// Rounding of the distances between coplanar patches (lengths); all 0 where a mesh has no patches.
struct TieWindow {
  double error = 0.0;   ///< Of plane_gap() against triangle_triangle_distance().
  double margin = 0.0;  ///< A gap above the smallest distance less this is a tie.
  double width = 0.0;   ///< Distances that exceed the smallest one by no more count as equal to it.
  static TieWindow of(const DistanceBody& a, const DistanceBody& b, const Pose& X_AB);
};

/// Work of one query.
struct TraversalCounts {
  std::uint64_t nodes = 0;       ///< Nodes expanded; in double precision, nodes and leaves.
  std::uint64_t leaf_pairs = 0;  ///< Pairs of leaves whose triangles were bounded.
  std::uint64_t triangles = 0;   ///< Pairs of triangles tested exactly.
};

/// Memory that searches use again.
struct DistanceScratch {
  std::vector<MeasuredPair> measured;  ///< Those not above best + ties.width, as best was then.
  std::vector<NodePair> stack;
  std::vector<NodePair> deferred;  ///< Triangles measured last, if their bounds are still small enough,
  std::vector<TiedPair> bounded;   ///< and these by bounds in doubles.
  std::vector<TiedPair> tied;
  std::vector<RankedPair> ranked;
  std::vector<ClosePair> close;
  std::vector<CornerVolume> corners;
  std::vector<std::uint32_t> triangles;
};

/// Input, output and scratch of one search.
struct DistanceSearch : DistanceScratch {
  const DistanceBody& a;
  const DistanceBody& b;
  Pose X_AB;
  TieWindow ties;
  double best = std::numeric_limits<double>::infinity();  ///< The smallest distance found.
  bool found = false;                                     ///< `pair` is set.
  bool of_bodies = false;     ///< Ends a search for an intersection, too, where a corner lies inside the other body.
  bool found_inside = false;  ///< It did. The meshes are solid: so the bodies meet, whether or not the surfaces do.
  TrianglePair pair;
  std::optional<ClosestPoints> closest;                 ///< Of `pair`, if they are known: see points_of().
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< Guess of the direction from A to B at the closest points.
  TraversalCounts counts;
};

/// Measures one pair exactly and keeps it if it is closer. Then sets `direction`, too, and returns true.
bool try_update(DistanceSearch& search, TrianglePair pair);

/// Keeps a pair if it is closer. Returns whether the distance decreased.
/// @param distance triangle_triangle_distance()
bool try_update(DistanceSearch& search, TrianglePair pair, double distance);

/// How points of B are mapped to A's frame: X_AB * p, rounded.
Eigen::Vector3d transform_point_of_b(const Pose& X_AB, const Eigen::Vector3d& p);

/// Corners of one of B's triangles in A's frame.
TriangleCorners corners_of_b(const DistanceSearch& search, std::uint32_t triangle);

/// Exact distance of one pair, a lower bound on it (triangle_gap()), the exact intersection test, and the pair's rank.
ClosestPoints distance_of(const DistanceSearch& search, TrianglePair pair);
double gap_of(const DistanceSearch& search, TrianglePair pair);
bool intersects(const DistanceSearch& search, TrianglePair pair);
Rank rank_of(const DistanceSearch& search, TrianglePair pair);

/// Whether one of a few corners lies inside the other mesh, which is closed: of those of a pair of triangles, and of
/// some that are spread over the surfaces.
/// @param turn 0, 1, ...: takes others of the latter
bool has_corner_inside(DistanceSearch& search, TrianglePair pair, std::size_t turn);

/// The closest points of search.pair; computed if they are not known.
const ClosestPoints& points_of(DistanceSearch& search);

/// Calls try_update() for one pair that is probably close: starts at the closest pair of seed corners and alternately
/// searches the corner of one mesh that is closest to that of the other. Does nothing if a pair closer than the seed
/// corners is known.
void seed_search(DistanceSearch& search);

/// Branch and bound for the closest pair of triangles whose distance is at most search.best. Of all pairs whose
/// distance exceeds the smallest by no more than ties.width, takes the one of smallest rank, whatever the order in
/// which pairs were met and whichever were known before. A distance of 0 ends the search, with any intersecting pair.
/// @param only_intersection finds any intersecting pair instead: sets found and pair, or found_inside
void find_pair(DistanceSearch& search, bool only_intersection);

}  // namespace sixdof::detail
