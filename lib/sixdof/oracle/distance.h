#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/distance_search.h>
#include <sixdof/query/algorithm.h>

/// Exact distance and exact yes/no of two triangle meshes. Results are in A's frame and in the meshes' length unit.
///
/// What is measured: A's triangles as given, and B's triangles with each corner p replaced by X_AB * p, rounded to
/// doubles. Between these triangles yes/no answers are exact (predicates.h), and the distance is the smallest of
/// triangle_triangle_distance() over all pairs. Its error is at most k_triangle_distance_error times (longest edge of
/// the closest pair + distance). Rounding the corners adds up to about 4e-16 times (|R p| + |t|).
///
/// Method: branch and bound over pairs of nodes of two bounding-volume trees, as in PQP (Larsen, Gottschalk, Lin and
/// Manocha, "Fast proximity queries with swept sphere volumes", 1999). Bounds on nodes and on pairs of triangles are
/// computed in floats, eight or more at once, and lowered by their rounding (distance_bounds-inl.h); what they cannot
/// prune is measured in double precision (distance_search.cpp). So the answer does not depend on the bounds: it has the
/// same bits on every instruction set, for every thread, warm or cold. Bounds of volumes that floats cannot tell apart
/// are computed in doubles (close_search.h), such as those of a body 1e-6 times as large as the other. For bodies
/// farther apart than 50 diameters (far_pair.h) the answer exceeds the smallest distance by at most 1.2e-15 of it.
/// Among pairs that are equally far up to that, the answer is not the one of lowest rank, but always the same one.
///
/// Ties: where surfaces are apart, the closest pair is the one with the lowest triangle in A, then in B, of all pairs
/// that are equally far; distance and points are those of this pair. Pairs are equally far if their distances are the
/// same double, or, if both meshes have coplanar patches (coplanar_patches.h), if they exceed the smallest by no more
/// than DistanceOracle::tie_width(): the distances of parallel faces are equal up to rounding for thousands of pairs.
namespace sixdof {

/// Two meshes prepared for distance queries: immutable, shared by the DistanceQuery objects of all threads.
///
/// Memory: a Tree per mesh and indices of coplanar patches; a row `prepare/algorithm:exact` reports a pair's bytes.
class DistanceOracle {
 public:
  /// Builds a tree per mesh; a single one if both are the same object.
  /// @throws BadMesh as Tree does.
  DistanceOracle(const Mesh& a, const Mesh& b);

  /// The bounding-volume tree of A, in A's mesh frame.
  const Tree& tree_a() const { return a_->tree; }
  /// That of B, in B's mesh frame; the same object as tree_a() if both meshes are one.
  const Tree& tree_b() const { return b_->tree; }

  /// Distances that differ by no more than this length count as equal: see Ties. 0 unless both meshes have a coplanar
  /// patch of four triangles or more; then 1.2e-14 times (radii of the meshes + distance of their centres) + 4.5e-15
  /// times (distances of the meshes' centres from their origins + |t|).
  double tie_width(const Pose& X_AB) const;

  /// Whether the bodies are certainly apart, neither one inside the other: asks convex bounds only (support_bound.h).
  bool certainly_apart(const Pose& X_AB) const;

  /// Memory of both trees, of the bounds and of the patches; what A and B share counts once.
  std::size_t bytes() const;

 private:
  friend class DistanceQuery;

  std::shared_ptr<const detail::DistanceBody> a_;
  std::shared_ptr<const detail::DistanceBody> b_;  // the same as a_ if both meshes are the same object
};

/// Queries of a DistanceOracle; one object per thread. The oracle outlives it.
///
/// Poses must be finite with a rotation matrix in R; they are not checked. A warm start begins with the triangles of
/// the object's last answer: it changes the time, never the answer.
class DistanceQuery {
 public:
  /// Nothing is computed here; the first query begins cold.
  explicit DistanceQuery(const DistanceOracle& oracle) : search_{{}, *oracle.a_, *oracle.b_} {}

  /// The distance of the surfaces with witnesses and their triangles. 0 if and only if the surfaces have a point in
  /// common; then the witnesses are one such point. Infinite if it exceeds the largest double.
  Separation distance(const Pose& X_AB, bool warm_start = true);

  /// Whether the surfaces have a point in common or, if both meshes are solid, a piece of one lies inside the other.
  bool collide(const Pose& X_AB, bool warm_start = true);

  /// Work of the last query.
  const detail::TraversalCounts& counts() const { return search_.counts; }

 private:
  void prepare(const Pose& X_AB, bool warm_start);

  detail::DistanceSearch search_;
  std::optional<TrianglePair> closest_pair_;       // of the last distance
  std::optional<TrianglePair> intersecting_pair_;  // of the last intersection
};

}  // namespace sixdof
