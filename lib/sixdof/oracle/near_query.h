#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/distance_search.h>
#include <sixdof/oracle/nested.h>

/// Distances between any two of many meshes, up to a limit. Definitions, method and bits are those of distance.h. A
/// mesh is prepared once for queries with all others. A search ends as soon as the distance certainly exceeds the
/// limit.
namespace sixdof {

/// A mesh prepared for queries with any other: shared by all threads. Immutable unless it is that of a DeformingMesh.
class PreparedMesh {
 public:
  /// The mesh need not outlive it. @throws BadMesh as Tree does
  explicit PreparedMesh(const Mesh& mesh) : body_(std::make_shared<const detail::DistanceBody>(mesh)) {}

  const Tree& tree() const { return body_->tree; }
  const Eigen::AlignedBox3d& box() const { return body_->box; }  ///< In the mesh's frame.
  std::size_t bytes() const { return body_->bytes(); }

 private:
  friend class NearQuery;
  friend class DeformingMesh;
  explicit PreparedMesh(std::shared_ptr<const detail::DistanceBody> body) : body_(std::move(body)) {}
  std::shared_ptr<const detail::DistanceBody> body_;
};

/// Where a search of one pair of bodies may begin: the triangles of its last answer, in tree order. It changes the time
/// of a query, never the answer.
struct NearHint {
  static constexpr std::uint32_t k_none = ~std::uint32_t{0};
  TrianglePair triangles{k_none, k_none};
  bool known() const { return triangles.a != k_none; }
};

/// One object per thread. Poses must be finite with a rotation matrix in R; they are not checked.
class NearQuery {
 public:
  static constexpr double k_no_limit = std::numeric_limits<double>::infinity();

  /// The distance of the surfaces, with the bits of DistanceQuery::distance(), if it does not exceed `limit`.
  /// @param limit a length, at least 0
  std::optional<double> distance(const PreparedMesh& a, const PreparedMesh& b, const Pose& X_AB, double limit,
                                 NearHint& hint);

  /// Whether the surfaces have a point in common: distance() would be 0.
  bool surfaces_meet(const PreparedMesh& a, const PreparedMesh& b, const Pose& X_AB, NearHint& hint);

  /// Whether a piece of one body lies inside the other, given that the surfaces do not meet: with surfaces_meet() the
  /// answer of DistanceQuery::collide(). False unless both meshes are solid.
  bool is_nested(const PreparedMesh& a, const PreparedMesh& b, const Pose& X_AB) {
    return detail::is_nested(*a.body_, *b.body_, X_AB, triangles_);
  }

  /// Whether the bodies are farther apart than 50 times their size: then distance() finds one of the closest pairs that
  /// differ by roundings, and which one depends on the trees (oracle/far_pair.h).
  static bool are_far(const PreparedMesh& a, const PreparedMesh& b, const Pose& X_AB);

  /// Of all queries so far.
  const detail::TraversalCounts& counts() const { return counts_; }

 private:
  template <class Ask>
  auto with_search(const PreparedMesh& a, const PreparedMesh& b, const Pose& X_AB, const Ask& ask);

  detail::TraversalCounts counts_;
  detail::DistanceScratch scratch_;
  std::vector<std::uint32_t> triangles_;
};

}  // namespace sixdof
