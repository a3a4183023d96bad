#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/tree.h>
#include <sixdof/geometry/triangle_distance.h>

/// Tests in double precision of pairs of subtrees that tie. Notation: see ray_cast_search.h. Internal: use
/// generation/distance_generator.h or translation_cast.h.
///
/// A pair of triangles ties with the best hit if its distance at the hit's translation is less than the target by no
/// more than k_cast_tie. Where faces lie over parallel faces, edges along edges or corners over corners, thousands of
/// pairs of volumes tie. Bounds in single precision cannot tell whether such a pair hits earlier, so that all of them
/// would be expanded. In double precision they are culled: the best hit stands for all of them. The test is a
/// separating axis n, for which the support values of both subtrees and the translation add up to the target:
///   min over A's points p of n . (-p) + min over B's points q of n . q + t n . u >= d.
/// The support value of a set along n is the least n . p of its points p.
///
/// Volumes are numbered as in detail::CloseVolume.
namespace sixdof::ray_cast {

/// Slabs and boxes of a node's children in double precision, [axis][lane], in the mesh's axes: |normal . p - middle|
/// <= half, |p - box_center| <= box_half. Lanes without a child are zero. With the children, so that a search in double
/// precision reads nothing else but corners.
struct alignas(64) PreciseVolumes {
  double normal[3][Tree::k_width];  ///< Unit vectors.
  double middle[Tree::k_width];
  double half[Tree::k_width];
  double box_center[3][Tree::k_width];
  double box_half[3][Tree::k_width];
  Tree::Child child[Tree::k_width];
  std::uint32_t child_count;
};

/// A mesh as the ray cast takes it. Coordinates are relative to the centre of the mesh's box. Immutable.
class CastMesh {
 public:
  explicit CastMesh(std::shared_ptr<const Tree> tree);

  const Tree& tree() const { return *tree_; }
  std::span<const PreciseVolumes> precise_volumes() const { return precise_volumes_; }  ///< Of each node's children.

  /// Triangle `t` in tree order, in double precision.
  TriangleCorners triangle(std::uint32_t t) const {
    const Tree::Corners& corners = tree_->corners()[t];
    const Eigen::Vector3d& center = tree_->center();
    return {corners[0] - center, corners[1] - center, corners[2] - center};
  }

 private:
  std::shared_ptr<const Tree> tree_;
  std::vector<PreciseVolumes> precise_volumes_;
};

/// The largest coplanar patch of A or B that was met face to face with the other body. Rounded coordinates tilt the
/// triangles of a flat face, and with them the axes between closest points, which then do not separate triangles
/// farther away. The mean normal of a large patch does. It is the same for many directions and targets, so that support
/// values along it are computed once.
struct CoplanarPatch {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< Unit vector, in A's frame, from A to B.
  float size = 0.0f;                                 ///< Squared diagonal of its box; 0 if there is no patch.

  /// Whether there is a patch, its normal is nearly parallel to `axis` and does not point against `direction`.
  /// @param axis unit vector from A to B between closest points
  bool is_facing(const Eigen::Vector3d& axis, const Eigen::Vector3d& direction) const;
};

/// Support values of the subtrees of one tree along one axis, by branch and bound. Values once found are kept until the
/// axis changes.
class TreeSupport {
 public:
  explicit TreeSupport(const CastMesh& mesh);

  /// @param axis unit vector in the mesh's axes
  void set_axis(const Eigen::Vector3d& axis);

  static constexpr double k_infinity = std::numeric_limits<double>::infinity();
  static constexpr double k_unknown = -k_infinity;

  /// The support value of a volume's triangles: exact, or too small by at most a few roundings of the tree's radius
  /// (k_support_tolerance, k_support_rounding), or by more where the budget ran out.
  /// @param budget triangles and volumes that may be evaluated; those that were are subtracted
  /// @return k_unknown if the budget is too small to begin
  double support_value(std::uint32_t volume, std::uint64_t& budget);

  std::uint64_t evaluations() const { return evaluations_; }  ///< Of triangles and volumes so far.

  /// A support value that was found.
  struct Known {
    double value;
    std::uint64_t axis_number;
  };

  /// What the search of subtrees takes.
  struct Search {
    const CastMesh& mesh;
    Eigen::Vector3d axis;
    double tolerance, rounding;
    Known* known;  ///< Of each node.
    std::uint64_t axis_number;
    std::uint64_t evaluations;
    std::uint64_t limit;  ///< Ends the search with bounds when evaluations reaches it.
  };

 private:
  const CastMesh& mesh_;
  Eigen::Vector3d axis_ = Eigen::Vector3d::Zero();
  std::uint64_t axis_number_ = 0;
  std::vector<Known> known_;  // of nodes, then leaves; valid if its axis_number is axis_number_; empty until needed
  std::uint64_t evaluations_ = 0;
};

/// Support values of the differences of two subtrees along one axis.
///
/// Each query adds to a budget of evaluations, and does nothing if the budget is too small. So all queries together
/// evaluate no more than the sum of what they add.
class DifferenceSupport {
 public:
  DifferenceSupport(const CastMesh& a, const CastMesh& b) : a_(a), b_(b) {}

  /// Forgets everything.
  /// @param R_AB from B's axes to A's
  void set_rotation(const Eigen::Matrix3d& R_AB) {
    R_ = R_AB;
    has_axis_ = false;
    budget_ = 0;
  }

  /// Support value of the differences q - p of the points p of a volume of A and q of one of B, as
  /// TreeSupport::support_value().
  /// @param axis in A's frame
  /// @param budget is added to what may be evaluated, in triangles and volumes
  double support_value(std::uint32_t a, std::uint32_t b, const Eigen::Vector3d& axis, std::uint64_t budget);

  std::uint64_t evaluations() const { return a_.evaluations() + b_.evaluations(); }  ///< Of triangles and volumes.

 private:
  TreeSupport a_, b_;
  Eigen::Matrix3d R_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d axis_ = Eigen::Vector3d::Zero();
  bool has_axis_ = false;
  std::uint64_t budget_ = 0;
};

struct Cast;

/// Whether two volumes are at least the target apart, up to half a tie, at the translation of the best hit and at all
/// larger ones. For volumes so small that bounds in single precision cannot tell them apart.
bool separated_in_double(const Cast& cast, std::uint32_t a, std::uint32_t b);

}  // namespace sixdof::ray_cast
