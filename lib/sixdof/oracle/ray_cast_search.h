#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/ray_cast_ties.h>

/// The branch and bound of the ray cast. Internal: use generation/distance_generator.h or translation_cast.h.
///
/// Notation. B is translated by t u, where u is the ray's direction; at t = 0 the centre of B's box is at the ray's
/// offset, usually zero, from that of A's. For a pair of triangles, or of volumes around many of them, S is the
/// Minkowski difference {q - p} of the points q of B at t = 0 and p of A. The pair's distance at t is that of the
/// origin from S + t u: for triangles a convex function of t. A pair hits at the target distance d at t_ab(d), the
/// largest t at which its distance is d. The first hit of the ray with the difference of the meshes, grown by d, is
/// t(d) = max over all pairs of triangles of t_ab(d).
///
/// Triangles are in A's axes, relative to the centres of the meshes' boxes. Volumes stay in the frames of their trees,
/// and are numbered as in detail::CloseVolume.
///
/// Search. `best` holds the largest t_ab(d) found so far. A dual-tree traversal expands pairs of volumes, until a
/// separating axis n with n . u >= 0 shows that the distance is at least d at that t, and so at every larger one:
///   min over s in S of n . s + t n . u >= d.
/// Then the pair is culled. Pairs of triangles that are left are measured by try_update(). The left side is a line in t
/// which does not depend on d: the pair's separating-axis bound (CastFront), which culls it for smaller targets, too.
namespace sixdof::ray_cast {

/// Tolerance of distances, in units of Cast::size(): the error of exact distances and of their use. A pair of triangles
/// whose distance at best.translation is less than d by no more than this, and d / 2, ties with the best hit and does
/// not replace it. So of many faces that tie only the first is expanded.
constexpr double k_cast_tie = 1e-14;

/// A hit. Before there is one, `pair` is empty, the translation is the least of interest, and the axes are guesses.
struct Hit {
  double translation = 0.0;  ///< t at which the pair's distance is the target.
  std::optional<TrianglePair> pair;
  /// Unit vector from A to B between the pair's closest points.
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  /// Unit vector along which the pair of triangles that try_update() rejected last is separated by the target, up to a
  /// tie; `axis` if it rejected none since.
  Eigen::Vector3d separating_axis = Eigen::Vector3d::UnitX();
};

struct CastCounts {
  std::uint64_t nodes = 0;       ///< Nodes whose children were bounded against a volume.
  std::uint64_t leaf_pairs = 0;  ///< Pairs of leaves whose triangles were bounded.
  std::uint64_t distances = 0;   ///< Exact distances of two triangles.
};

/// The front of a dual-tree traversal: what the search for one target of a ray leaves for the next.
///
/// To expand a pair of volumes is to bound the children of one of them against the other. The pairs of a child and the
/// other volume that were not expanded themselves are the front: each pair of triangles is below exactly one of
/// them. A pair of the front has a separating-axis bound: at translation t its distance is at least
///   offset + slope * t
/// for t up to that at which the bound was made, and at least the value there for larger t. The slope is 0 to 1. A
/// smaller target, which is met at a smaller translation, expands only pairs whose bounds no longer reach it.
struct CastFront {
  static constexpr float k_no_bound = -1e30f;     ///< Offset of a pair that no axis is known to separate.
  static constexpr float k_not_in_front = 1e30f;  ///< Offset of a lane without a child, or whose pair was expanded.

  struct Expansion {
    std::uint32_t node;   ///< Its children were bounded
    std::uint32_t other;  ///< against this volume of the other tree.
    bool expands_a;       ///< Whether the node is of tree A.
  };

  /// Separating-axis bounds of the children of one expansion, [lane].
  struct alignas(64) AxisBounds {
    float offset[Tree::k_width];
    float slope[Tree::k_width];
  };

  /// A pair of volumes still to be expanded: a child of an expansion's node, and its other volume.
  struct Pending {
    std::uint32_t a, b;
    std::uint32_t expansion, lane;
    float lower;  ///< Orders the children of an expansion: the least first.
    float size;   ///< Of the larger volume: squared diagonal.
  };

  std::vector<Expansion> expansions;
  std::vector<AxisBounds> bounds;  ///< Of each expansion.
  std::size_t initial_size = 0;    ///< Number of expansions after the first target.
  double target = 0.0;             ///< The last one.

  std::vector<Pending> pending;  ///< Scratch: a stack.
  /// Scratch: expansions with a child whose bound no longer reaches the target, and the least bound.
  std::vector<std::pair<float, std::uint32_t>> uncovered;

  void clear() {
    expansions.clear();
    bounds.clear();
  }
};

/// One ray, and what is known about it.
struct Cast {
  /// Both meshes outlive it.
  Cast(const CastMesh& mesh_a, const CastMesh& mesh_b)
      : a(mesh_a), b(mesh_b), patch_support(mesh_a, mesh_b), axis_support(mesh_a, mesh_b) {}

  /// Forgets everything.
  /// @param R_AB from B's axes to A's
  void set_rotation(const Eigen::Matrix3d& R_AB) {
    R = R_AB;
    patch.size = 0.0f;
    patch_support.set_rotation(R);
    axis_support.set_rotation(R);
    front.clear();
  }

  const CastMesh& a;
  const CastMesh& b;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< u
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();      ///< From A's centre to B's at t = 0; perpendicular to u.
  double least = 0.0;                                    ///< Translation of interest.
  double target = 0.0;                                   ///< d
  Hit best;
  CastCounts counts;
  CastFront front;                  ///< Of this direction; to be cleared when it changes.
  CoplanarPatch patch;              ///< Of A or B, over one of the other.
  DifferenceSupport patch_support;  ///< Along its normal.
  DifferenceSupport axis_support;   ///< Along best.separating_axis.

  /// Length that errors are relative to.
  double size() const { return a.tree().radius() + b.tree().radius() + target + offset.norm(); }
  /// Upper bound on the distance between two translations of interest.
  double reach() const { return 1.01 * size() + std::max(0.0, -least); }
  /// By how much the distance of a pair that ties may be below the target. At most half the target: triangles that
  /// intersect never tie, even where the target is smaller than the rounding, as for contact of a small A with a large
  /// B.
  double tie() const { return std::min(k_cast_tie * size(), 0.5 * target); }
};

/// Finds the pair of triangles with the largest t_ab(target) above best.translation, and sets `best`; leaves it
/// unchanged if there is none. The front of a larger target on the same ray saves most of the work. Every instruction
/// set does the same floating-point operations in the same order, so all find the same pair.
void find_first_hit(Cast& cast);

/// Finds the first hits of rays for descending targets. Each search starts from the hit of the target before it.
class RaySearch {
 public:
  /// Both meshes outlive the search.
  RaySearch(const CastMesh& a, const CastMesh& b) : cast_(a, b) {}

  /// Forgets everything.
  /// @param R_AB from B's axes to A's
  void set_rotation(const Eigen::Matrix3d& R_AB) { cast_.set_rotation(R_AB); }

  /// @param direction unit vector
  /// @param offset of B's centre from the line through A's, perpendicular to the direction (length)
  /// @param least translation of interest; not below minus the sum of both meshes' radii
  void start_ray(const Eigen::Vector3d& direction, const Eigen::Vector3d& offset = Eigen::Vector3d::Zero(),
                 double least = 0.0);

  /// Finds the first hit for the ray's next target.
  /// @param target positive, and not larger than the one before
  /// @return null if there is none at the least translation or more, up to a tie; otherwise valid until the next call
  const Hit* find_next(double target);

  const Cast& cast() const { return cast_; }

 private:
  /// The hit for the target before.
  struct LastTarget {
    double target;
    Hit hit;
  };

  void search_from(double translation, const Eigen::Vector3d& axis);
  bool find_behind(const LastTarget& last);

  Cast cast_;
  bool reachable_ = true;
  std::optional<LastTarget> last_;
};

}  // namespace sixdof::ray_cast
