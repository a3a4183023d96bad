#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/distance_traversal.h>
#include <sixdof/query/algorithm.h>

namespace sixdof {

/// What one query needs besides the pose.
struct DistanceOptions {
  /// Only distances up to this are of interest: a length. Where the surfaces are farther apart, the query ends as soon
  /// as that is certain.
  double upper_bound = std::numeric_limits<double>::infinity();
  /// Begin with the closest triangles of this query object's last answer. Changes the time, never the distance.
  bool warm_start = true;
};

/// Two meshes prepared for exact distances at any pose: immutable, shared by the DistanceQuery objects of all threads.
/// The meshes outlive it.
///
/// A mesh of a million triangles takes 151 MB (its tree), and 2 to 8 MB more if it has flat parts: bytes() of
/// torus-knot-1m, box-1m and elephant-1m, which the growth of the process (148 MB and 2 to 6 MB) bears out.
class DistanceOracle {
 public:
  /// Builds a tree per mesh; a single one if both are the same object.
  /// @throws BadMesh as Tree does.
  DistanceOracle(const Mesh& a, const Mesh& b);

  /// With trees that exist already: those of the meshes `a` and `b`.
  DistanceOracle(const Mesh& a, std::shared_ptr<const Tree> tree_a, const Mesh& b, std::shared_ptr<const Tree> tree_b);

  const std::shared_ptr<const Tree>& tree_a() const { return tree_a_; }
  const std::shared_ptr<const Tree>& tree_b() const { return tree_b_; }

  /// A vertex of each connected piece of a surface, and the piece's box, in the mesh's frame; empty unless the mesh is
  /// solid.
  struct Piece {
    Eigen::Vector3d vertex;
    Eigen::AlignedBox3d box;
  };
  const std::vector<Piece>& pieces_a() const { return pieces_a_; }
  const std::vector<Piece>& pieces_b() const { return pieces_b_; }
  bool solid_a() const { return solid_a_; }
  bool solid_b() const { return solid_b_; }

  /// Distances that differ by no more than this length count as equal, and DistanceQuery may answer with any of them: 0
  /// unless both trees have flat parts, subtrees of 4 triangles and more in one plane. It is a few times what rounding
  /// makes of the distances between two flat parts that are parallel: 1.2e-14 times (radii of the meshes + distance of
  /// their centres) + 4.5e-15 times (distances of the meshes' centres from their origins + |t|).
  double tie_width(const Pose& X_AB) const;

  const detail::Samples& samples_a() const { return samples_a_; }
  const detail::Samples& samples_b() const { return samples_b_; }
  const detail::Flats& flats_a() const { return *flats_a_; }
  const detail::Flats& flats_b() const { return *flats_b_; }

  std::size_t bytes() const;

 private:
  std::shared_ptr<const Tree> tree_a_;
  std::shared_ptr<const Tree> tree_b_;
  bool solid_a_;
  bool solid_b_;
  std::vector<Piece> pieces_a_;
  std::vector<Piece> pieces_b_;
  detail::Samples samples_a_;
  detail::Samples samples_b_;
  std::shared_ptr<const detail::Flats> flats_a_;
  std::shared_ptr<const detail::Flats> flats_b_;
};

/// Asks an oracle; one object per thread. The oracle outlives it.
///
/// What is measured: A's triangles as given, and B's triangles with each corner p replaced by X_AB * p, rounded to
/// doubles. Between these polyhedra yes/no answers are exact, and a distance is the smallest of
/// triangle_triangle_distance() over all pairs of triangles: its error is k_triangle_distance_error times (longest edge
/// of the closest pair + distance). Rounding the corners adds up to about 4e-16 times (|R p| + |t|) to what the real
/// numbers behind X_AB would give: relative to the meshes' size at the origin, relative to the offset far from it.
///
/// Ties: where surfaces are apart, the closest pair is the one with the lowest triangle in A, then in B, of all pairs
/// that are equally far; distance and points are those of this pair. Pairs are equally far if their distances are the
/// same double, or, if both meshes have flat parts, if they exceed the smallest by no more than tie_width(): a ship's
/// deck over another is thousands of pairs that differ by their rounding alone. Where surfaces meet, witnesses are any
/// one common point.
///
/// The answer has the same bits on every instruction set, for every thread, warm or cold.
///
/// Poses must be finite with a rotation matrix in R; nothing is checked here.
class DistanceQuery {
 public:
  explicit DistanceQuery(const DistanceOracle& oracle);

  /// With witnesses and their triangles; 0 if and only if the surfaces have a point in common. Beyond the upper bound:
  /// infinity, without witnesses.
  Separation distance(const Pose& X_AB, const DistanceOptions& options = {});

  /// Whether the surfaces have a point in common.
  bool surfaces_intersect(const Pose& X_AB, bool warm_start = true);

  /// Whether the bodies have a point in common: the surfaces, or, as far as a mesh is solid, a piece of the one inside
  /// the other.
  bool collide(const Pose& X_AB, bool warm_start = true);

  /// Number of times the surface of A (solid) winds around a point `p` in A's frame that is not on the surface: 1
  /// inside, 0 outside.
  int winding_a(const Eigen::Vector3d& p) const;

  /// The same for B's surface at X_AB; `p` in A's frame.
  int winding_b(const Pose& X_AB, const Eigen::Vector3d& p) const;

  /// What the last query looked at.
  const detail::TraversalCounts& counts() const { return traversal_.counts; }

 private:
  void prepare(const Pose& X_AB, bool warm_start);
  bool may_meet(const Pose& X_AB);
  bool intersect(const Pose& X_AB, bool warm_start);

  const DistanceOracle& oracle_;
  detail::Traversal traversal_;
  std::optional<detail::TrianglePair> closest_pair_;       // of the last distance
  std::optional<detail::TrianglePair> intersecting_pair_;  // of the last intersection
  mutable std::vector<std::uint32_t> open_;
};

}  // namespace sixdof
