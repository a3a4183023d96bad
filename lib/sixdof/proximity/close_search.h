#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>

/// Branch and bound in double precision, for pairs of volumes whose distances floats cannot tell apart. Internal: for
/// oracle/distance_search.cpp, oracle/candidates.cpp and oracle/ray_cast_ties.cpp, which call it where a float
/// bound is too coarse:
///   - bodies of very different size, where details are smaller than the rounding of the large body's coordinates;
///   - bodies that are far apart, where both are smaller than the rounding of their distance;
///   - layers closer to each other than that rounding;
///   - a leaf with a node that is smaller than the leaf is thick: a volume around four large triangles that are not
///     coplanar is far larger than the triangles. Here they are bounded one by one.
/// Its rounding is that of doubles, relative to the bodies' sizes and to their distance. A bound takes about ten times
/// as long as one of distance_bounds-inl.h.
namespace sixdof::detail {

/// A node, or k_leaf plus the index of a leaf, or one triangle of that leaf.
struct CloseVolume {
  static constexpr std::uint32_t k_leaf = Tree::k_leaf_number;
  static constexpr std::uint32_t k_whole = ~std::uint32_t{0};
  std::uint32_t volume;
  std::uint32_t triangle = k_whole;  ///< In tree order; k_whole for the whole volume.

  static CloseVolume child_of(const Tree::Node& node, std::size_t i) { return {node.number[i]}; }
};

struct ClosePair {
  CloseVolume a;
  CloseVolume b;
  double lower;  ///< Lower bound on the distance; negative where the volumes may overlap.

  bool is_of_triangles() const { return a.triangle != CloseVolume::k_whole && b.triangle != CloseVolume::k_whole; }
};

/// A volume in A's axes, relative to the centre of A's tree: the intersection of a box and a slab; or a triangle.
struct CloseShape {
  bool is_triangle = false;
  double squared_size = 0.0;  ///< Square of a box's diagonal, or of a triangle's longest edge.
  Eigen::Vector3d center;
  Eigen::Matrix3d arms;    ///< Columns: the box's half extents as vectors; the triangle's corners less the centre.
  Eigen::Vector3d normal;  ///< Of the slab or the triangle; at most a unit vector, zero if there is none.
  /// Box: the slab, lower <= normal . (p - center) <= upper; and the arms' projections on its normal.
  double slab_lower = 0.0;
  double slab_upper = 0.0;
  Eigen::Vector3d arms_on_normal;

  /// At least the largest n . (p - center) over the volume.
  double reach(const Eigen::Vector3d& n) const;
};

/// A whole node or leaf in the axes of its own mesh, relative to the centre of its tree.
CloseShape shape_in_own_axes(const Tree& tree, const CloseVolume& v);

/// Lower bounds on distances between volumes of two trees at one pose, or at all that a translation of B passes.
class CloseBounds {
 public:
  /// @param sweep B's translation, in A's frame
  CloseBounds(const Tree& a, const Tree& b, const Pose& X_AB, const Eigen::Vector3d& sweep = Eigen::Vector3d::Zero());

  CloseShape shape_of_a(const CloseVolume& v) const;
  CloseShape shape_of_b(const CloseVolume& v) const;

  /// The largest gap between the projections of two volumes on a few axes, less the rounding of all that it is compared
  /// with: no pair of triangles in the volumes has a smaller triangle_triangle_distance(). Axes are tried until the gap
  /// exceeds `enough`.
  /// @param guess of the direction from A to B at their closest points, of any length
  double lower_bound(const CloseShape& a, const CloseShape& b, const Eigen::Vector3d& guess, double enough) const;

  /// What lower_bound() subtracts for rounding.
  double slack() const { return slack_; }

  /// The same for two triangles (tree order) along one axis, from A to B.
  double gap_along(const Eigen::Vector3d& unit, TrianglePair pair) const;

 private:
  const Tree& a_;
  const Tree& b_;
  Pose X_AB_;
  Eigen::Vector3d shift_;  // from A's centre to B's, in A's frame
  Eigen::Vector3d sweep_;
  double slack_;
};

/// What a search does with the pairs that bounds do not prune.
class CloseVisitor {
 public:
  /// A pair is pruned if its lower bound exceeds this.
  virtual double largest_of_interest() const = 0;
  /// Guess of the direction from A to B at the closest points.
  virtual const Eigen::Vector3d& direction() const = 0;
  /// Whether two volumes, neither a triangle, need not be searched now.
  virtual bool prune_volumes(std::uint32_t a, std::uint32_t b) = 0;
  /// Returns true if the search is over.
  virtual bool visit_triangles(TrianglePair pair) = 0;
  virtual void count_expansion() = 0;

 protected:
  ~CloseVisitor() = default;
};

/// Sets the parts of a node or leaf, the latter's triangles. Returns their number.
std::uint32_t parts_of(const Tree& tree, const CloseVolume& v, std::array<CloseVolume, Tree::k_width>& parts);

/// Visits the pairs of triangles of two volumes whose bounds do not exceed what is of interest: depth first, the pair
/// with the smallest lower bound first. Returns true if a visit did.
/// @param stack scratch
bool search_closely(const Tree& tree_a, const Tree& tree_b, const CloseBounds& bounds, std::uint32_t a, std::uint32_t b,
                    CloseVisitor& visitor, std::vector<ClosePair>& stack);

}  // namespace sixdof::detail
