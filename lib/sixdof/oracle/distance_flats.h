#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/tree.h>

/// Flat parts of surfaces, for searches in which thousands of pairs of triangles are equally far. Internal: use
/// distance.h.
namespace sixdof::detail {

/// The flat parts of a tree's surface: decks, walls, the faces of a block. Where two of them face each other, all pairs
/// of their triangles tie up to rounding, and the tree's volumes, which are floats, cannot tell that none of them is
/// closer than the first that was measured. Planes in double precision can.
class Flats {
 public:
  /// A mesh whose largest flat part has fewer triangles counts as having none: its ties are few.
  static constexpr std::uint32_t k_least_triangles = 4;

  /// lower <= normal . (p - center) <= upper for every point p of the part, with the tree's center(); `normal` is of
  /// unit length up to rounding, and the interval is wider than the part by the rounding of such a product.
  struct Plane {
    Eigen::Vector3d normal;
    double lower;
    double upper;
  };

  explicit Flats(const Tree& tree);

  bool empty() const { return planes_.empty(); }

  /// Plane of the flat part that holds a whole node or leaf; null if there is none.
  const Plane* of_node(std::uint32_t node) const { return plane(node_plane_, node); }
  const Plane* of_leaf(std::uint32_t leaf) const { return plane(leaf_plane_, leaf); }

  /// Lowest index into the mesh's triangles() of what a node or leaf holds. Only if not empty().
  std::uint32_t lowest_of_node(std::uint32_t node) const { return node_lowest_[node]; }
  std::uint32_t lowest_of_leaf(std::uint32_t leaf) const { return leaf_lowest_[leaf]; }

  std::size_t bytes() const;

 private:
  static constexpr std::uint32_t k_none = ~std::uint32_t{0};
  const Plane* plane(const std::vector<std::uint32_t>& index, std::uint32_t i) const {
    return index.empty() || index[i] == k_none ? nullptr : &planes_[index[i]];
  }
  void find_planes(const Tree& tree);
  void find_lowest(const Tree& tree);

  std::vector<Plane> planes_;
  std::vector<std::uint32_t> node_plane_;  // per node: index into planes_; these four are empty if planes_ is
  std::vector<std::uint32_t> leaf_plane_;
  std::vector<std::uint32_t> node_lowest_;
  std::vector<std::uint32_t> leaf_lowest_;
};

/// Gap between a part of A and a part of B along the normals of their planes: they are at least so far apart, up to
/// rounding. Minus infinity if the planes are not nearly parallel. `box_a` and `box_b` hold the parts, relative to the
/// trees' centres; R turns B's frame into A's, `shift` leads from A's centre to B's, in A's frame.
double plane_gap(const Flats::Plane& a, const Tree::Volume& box_a, const Flats::Plane& b, const Tree::Volume& box_b,
                 const Eigen::Matrix3d& R, const Eigen::Vector3d& shift);

}  // namespace sixdof::detail
