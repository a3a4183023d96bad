#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include <sixdof/generation/ray_cast_tree.h>
#include <sixdof/geometry/triangle_distance.h>

/// Ties of whole subtrees, told in double precision. Internal: use ray_cast.h.
namespace sixdof::ray_cast {

/// How high the differences b - a of two triangles lie along an axis, at least.
/// @param mirrored A's corners, mirrored
/// @param b B's corners where it stands
double lowest_difference(const TriangleCorners& mirrored, const TriangleCorners& b, const Eigen::Vector3d& axis);

/// The axis between the closest points of two triangles that are nearly in touch, without the rounding of the points.
/// At a distance d the difference of two points of size L is off by an angle of 1e-16 L / d, so that ties along it are
/// not seen. Normals and directions across two edges have no such error.
/// @param axis unit vector between the points
/// @param room the triangles may be apart by this much less along the new axis
/// @return the normal or direction across two edges beside `axis` along which they are farthest apart; `axis` if there
/// is none
Eigen::Vector3d sharp_axis(const TriangleCorners& mirrored, const TriangleCorners& b, const Eigen::Vector3d& axis,
                           double room);

/// The normal of a face that lies over another. Where coordinates were rounded, a face's triangles are turned by their
/// roughness over their size, and so are the axes between them, each by something else: along none of them are
/// triangles apart that lie farther off. Along the mean normal of the largest flat patch that was met they are, up to
/// the roughness itself, and it stays the same while directions and targets change, so that heights along it are known.
class CastFace {
 public:
  void clear() { size_ = 0.0f; }

  /// Takes a patch's normal, unless it is off `axis`.
  /// @param normal unit vector, of either side
  /// @param size of the patch, CastVolume::size
  /// @param axis unit vector from A to B along which they were found to be apart
  void note(const Eigen::Vector3d& normal, float size, const Eigen::Vector3d& axis, const Eigen::Vector3d& direction);

  /// Whether there is a face, and `axis` stands on it, whose normal does not point against the direction.
  bool faces(const Eigen::Vector3d& axis, const Eigen::Vector3d& direction) const;

  const Eigen::Vector3d& normal() const { return normal_; }  ///< Unit vector.
  float size() const { return size_; }                       ///< Of the patch; 0 if there is none.

 private:
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero();
  float size_ = 0.0f;
};

/// Heights of subtrees along one axis, found by branch and bound.
class CastSupports {
 public:
  explicit CastSupports(const CastTree& tree);

  /// Forgets all heights.
  /// @param axis unit vector in the common frame
  void set_axis(const Eigen::Vector3d& axis);

  static constexpr double k_unknown = -std::numeric_limits<double>::infinity();

  /// How low the triangles of a child lie along the axis: the least axis . p, or less by at most a few roundings of the
  /// tree's radius (k_height_room, k_height_rounding), or by more where credit ran out.
  /// @param node_and_lane of the child, Tree::k_width * node + lane
  /// @param credit triangles and volumes that may be looked at; those that were are taken off it
  /// @return k_unknown if there is too little credit to begin
  double lowest(std::size_t node_and_lane, std::uint64_t& credit);

  std::uint64_t looked_at() const { return looked_at_; }  ///< Triangles and volumes, so far.

 private:
  /// Of axis . p over a subtree.
  struct Found {
    double low = -k_unknown;    ///< Not above any of what was not looked at.
    double least = -k_unknown;  ///< The least of what was.
  };
  struct Limits {
    double least;        ///< What was found elsewhere: what is not lower need not be looked at.
    std::uint64_t most;  ///< looked_at_ at which bounds have to do.
  };
  struct Height {
    double value;
    std::uint64_t round;
  };

  CastChild child(std::size_t node_and_lane) const {
    return tree_->nodes()[node_and_lane / Tree::k_width].child[node_and_lane % Tree::k_width];
  }
  /// @param low for each child, surely not above any axis . p of its triangles
  void bound_children(const CastPatches& patches, double* low) const;
  Found look_into(CastChild child, Limits limits);

  const CastTree* tree_;
  double room_;                                     // k_height_room of the radius
  double rounding_;                                 // k_height_rounding of it
  Eigen::Vector3d axis_ = Eigen::Vector3d::Zero();  // in the mesh's frame
  std::vector<Height> heights_;                     // of each child of each node; empty until needed
  std::uint64_t round_ = 0;                         // heights of other rounds are of other axes
  std::uint64_t looked_at_ = 0;
};

/// How low the differences of two subtrees lie along an axis along which pairs of their triangles were found to be
/// apart. Where faces lie over each other, edges along edges or corners beside corners, thousands of pairs of volumes
/// are as far apart as the target asks. Bounds in floats cannot say whether they are a little nearer; in double precision
/// they are not, and the pair found already stands for all. The same helps where a few large triangles face thousands
/// of small ones, and wherever volumes reach below their triangles.
///
/// Heights are paid for by tries: they take at most a multiple of the time of what was left open.
class CastTies {
 public:
  CastTies(const CastTree& a, const CastTree& b) : a_(a), b_(b) {}

  /// After a tree was turned: nothing is known, nothing is paid for.
  void clear() {
    known_ = false;
    credit_ = 0;
  }

  /// How low the differences b - a of two children, given as Tree::k_width * node + lane, lie along `axis` (unit
  /// vector), as CastSupports::lowest(); k_unknown if it would take too long to find out.
  /// @param pay triangles and volumes that this try adds to those that may be looked at
  double lowest(std::size_t child_a, std::size_t child_b, const Eigen::Vector3d& axis, std::uint64_t pay);

  std::uint64_t supports() const { return a_.looked_at() + b_.looked_at(); }

 private:
  CastSupports a_, b_;
  Eigen::Vector3d axis_ = Eigen::Vector3d::Zero();
  bool known_ = false;
  std::uint64_t credit_ = 0;  // triangles and volumes that may be looked at
};

}  // namespace sixdof::ray_cast
