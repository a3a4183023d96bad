#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/tree.h>
#include <sixdof/proximity/close_search.h>

namespace sixdof::detail {

/// The subtrees of a tree whose triangles lie in one plane up to rounding: faces of a block, decks, walls. Internal:
/// use distance.h.
///
/// Where two such patches face each other, all pairs of their triangles, often thousands, have the same distance up to
/// rounding. The tree's volumes are floats and too coarse to prune them; planes in double precision can.
class CoplanarPatches {
 public:
  /// lower <= normal . (p - center) <= upper for every point p of the patch, with the tree's center(). The normal is of
  /// unit length up to rounding; the interval includes the rounding of the product.
  struct Plane {
    Eigen::Vector3d normal;
    double lower;
    double upper;
  };

  /// @param always counts as having patches even if the largest has fewer than four triangles. Of a mesh that deforms:
  /// which patches are found depends on the partition of its triangles, which differs between a tree that was refitted
  /// and one that was built, and ties must not.
  explicit CoplanarPatches(const Tree& tree, bool always = false);

  bool empty() const { return node_plane_.empty(); }

  /// Plane of the patch that contains all of a node or leaf (CloseVolume::volume); null if there is none.
  const Plane* of(std::uint32_t volume) const {
    return is_leaf(volume) ? plane(leaf_plane_, volume - CloseVolume::k_leaf) : plane(node_plane_, volume);
  }

  /// Smallest index into Mesh::triangles() of the triangles of a node or leaf. Only if not empty().
  std::uint32_t smallest_index(std::uint32_t volume) const {
    return is_leaf(volume) ? leaf_smallest_index_[volume - CloseVolume::k_leaf] : node_smallest_index_[volume];
  }

  std::size_t bytes() const;

 private:
  static constexpr std::uint32_t k_none = ~std::uint32_t{0};
  static bool is_leaf(std::uint32_t volume) { return (volume & CloseVolume::k_leaf) != 0; }
  const Plane* plane(const std::vector<std::uint32_t>& index, std::uint32_t i) const {
    return index.empty() || index[i] == k_none ? nullptr : &planes_[index[i]];
  }
  void find_planes(const Tree& tree, bool always);
  void find_smallest_indices(const Tree& tree);

  std::vector<Plane> planes_;
  std::vector<std::uint32_t> node_plane_;  // per node: index into planes_; these four are empty if planes_ is
  std::vector<std::uint32_t> leaf_plane_;
  std::vector<std::uint32_t> node_smallest_index_;
  std::vector<std::uint32_t> leaf_smallest_index_;
};

/// A lower bound, up to rounding, on the distance of a patch of A and a patch of B: their gap along the planes'
/// normals. Minus infinity if the planes are not nearly parallel.
/// @param box_a, box_b contain the patches, relative to the trees' centres
/// @param R rotates B's frame to A's
/// @param shift from A's centre to B's, in A's frame
double plane_gap(const CoplanarPatches::Plane& a, const Tree::Volume& box_a, const CoplanarPatches::Plane& b,
                 const Tree::Volume& box_b, const Eigen::Matrix3d& R, const Eigen::Vector3d& shift);

}  // namespace sixdof::detail
