#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/tree.h>
#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/oracle/seed_corners.h>

/// Both meshes as the ray cast takes them: trees with volumes in double precision, and a common frame. Internal: use
/// distance_generator.h.
///
/// The slot Tree::k_width * node + lane stands for the child `lane` of node `node`, and for that child's volume.
namespace sixdof::ray_cast {

/// What a slot refers to: a node, or a leaf.
class CastChild {
 public:
  CastChild() = default;
  static constexpr CastChild node(std::uint32_t index) { return CastChild(index); }
  static constexpr CastChild leaf(std::uint32_t index) { return CastChild(k_leaf | index); }
  bool is_leaf() const { return (bits_ & k_leaf) != 0; }
  std::uint32_t index() const { return bits_ & ~k_leaf; }  ///< Into nodes or leaves.

 private:
  explicit constexpr CastChild(std::uint32_t bits) : bits_(bits) {}
  static constexpr std::uint32_t k_leaf = 1u << 31;
  std::uint32_t bits_ = 0;
};

inline CastChild child_of(const Tree::Node& node, std::size_t lane) {
  const Tree::Child child = node.child[lane];
  return child.is_leaf() ? CastChild::leaf(node.leaf[lane]) : CastChild::node(child.node());
}

/// The volume of a child of a tree.
struct CastVolume {
  /// Slot of the whole tree.
  static constexpr std::uint32_t k_root = 0xffffffffu;

  std::uint32_t slot;
  CastChild child;
};

/// |normal . p - middle| <= half
struct CastSlab {
  Eigen::Vector3d normal;
  double middle;
  double half;
};

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

/// What does not depend on the rotation. Coordinates are relative to the centre of the mesh's box. Immutable.
class CastMesh {
 public:
  explicit CastMesh(std::shared_ptr<const Tree> tree);

  const Tree& tree() const { return *tree_; }
  const detail::SeedCorners& seeds() const { return seeds_; }
  std::span<const PreciseVolumes> precise_volumes() const { return precise_volumes_; }  ///< Of each node's children.

 private:
  std::shared_ptr<const Tree> tree_;
  detail::SeedCorners seeds_;
  std::vector<PreciseVolumes> precise_volumes_;
};

/// A mesh in the common frame: p -> M (p - centre), where M is a rotation or minus the identity.
class CastTree {
 public:
  explicit CastTree(std::shared_ptr<const CastMesh> mesh) : mesh_(std::move(mesh)) {}

  /// Sets M.
  void transform(const Eigen::Matrix3d& M) { matrix_ = M; }

  const CastMesh& mesh() const { return *mesh_; }
  const Eigen::Matrix3d& matrix() const { return matrix_; }
  std::span<const Tree::Node> nodes() const { return mesh_->tree().nodes(); }
  std::span<const Tree::Leaf> leaves() const { return mesh_->tree().leaves(); }
  double radius() const { return mesh_->tree().radius(); }

  /// In the tree's frame.
  const Tree::Volume& volume(CastChild child) const {
    return child.is_leaf() ? leaves()[child.index()].volume : nodes()[child.index()].volume;
  }

  /// The slab of a child in double precision, in the common frame.
  CastSlab slab(std::size_t slot) const {
    const PreciseVolumes& v = mesh_->precise_volumes()[slot / Tree::k_width];
    const std::size_t lane = slot % Tree::k_width;
    return {matrix_ * Eigen::Vector3d(v.normal[0][lane], v.normal[1][lane], v.normal[2][lane]), v.middle[lane],
            v.half[lane]};
  }

  /// Triangle `t` in tree order, in double precision.
  TriangleCorners triangle(std::uint32_t t) const;

 private:
  std::shared_ptr<const CastMesh> mesh_;
  Eigen::Matrix3d matrix_ = Eigen::Matrix3d::Identity();
};

}  // namespace sixdof::ray_cast
