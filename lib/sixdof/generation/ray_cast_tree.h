#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <sixdof/geometry/tree.h>
#include <sixdof/geometry/triangle_distance.h>

/// A mesh as the ray cast takes it: a tree with volumes in double precision, too. Internal: use distance_generator.h.
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

/// Coordinates are relative to the centre of the mesh's box. Immutable.
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

}  // namespace sixdof::ray_cast
