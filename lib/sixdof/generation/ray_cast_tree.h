#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/tree.h>
#include <sixdof/geometry/triangle_distance.h>

/// Both meshes' trees in one common frame, for the ray cast. Internal: use distance_generator.h.
///
/// The volume of a subtree is the intersection of a box, a ball and a slab (the points between two parallel planes).
/// The slot Tree::k_width * node + lane stands for the child `lane` of node `node`, and for that child's volume.
namespace sixdof::ray_cast {

/// What a slot refers to: a node, or a leaf.
class CastChild {
 public:
  CastChild() = default;
  static CastChild node(std::uint32_t index) { return CastChild(index); }
  static CastChild leaf(std::uint32_t index) { return CastChild(k_leaf | index); }
  bool is_leaf() const { return (bits_ & k_leaf) != 0; }
  std::uint32_t index() const { return bits_ & ~k_leaf; }  ///< Into nodes or leaves.

 private:
  explicit CastChild(std::uint32_t bits) : bits_(bits) {}
  static constexpr std::uint32_t k_leaf = 1u << 31;
  std::uint32_t bits_ = 0;
};

/// Volumes of up to eight children, [axis][lane]; lanes without a child repeat the first.
struct alignas(64) CastNode {
  float center[3][Tree::k_width];  ///< Boxes.
  float half[3][Tree::k_width];    ///< Boxes: half extents.
  float normal[3][Tree::k_width];  ///< Slabs: a little shorter than unit vectors, as in Tree.
  float ball_center[3][Tree::k_width];
  float ball_radius[Tree::k_width];
  float slab_offset[Tree::k_width];  ///< Slabs: signed distance of the middle plane from the ball's centre.
  float slab_half[Tree::k_width];    ///< Slabs: half the thickness.
  CastChild child[Tree::k_width];
  std::uint32_t child_count;
};

/// The volume of one child by itself, as in CastNode: one cache line.
struct alignas(64) CastVolume {
  float center[3];
  float half[3];
  float normal[3];
  float ball_center[3];
  float ball_radius;
  float slab_offset;
  float slab_half;
  float size;  ///< Square of half the box's diagonal.
};

/// A leaf's corners, [corner][axis][triangle], and its triangles; lanes without a triangle are as in Tree::Leaf.
struct CastLeaf {
  float corner[3][3][Tree::k_leaf_triangles];
  Tree::Child child;
};

/// |normal . p - middle| <= half
struct CastSlab {
  Eigen::Vector3d normal;
  double middle;
  double half;
};

/// Slabs and boxes of a node's children in double precision, [axis][lane], in the mesh's axes: |normal . p - middle|
/// <= half, |p - box_center| <= box_half. Lanes without a child are zero.
struct alignas(64) PreciseVolumes {
  double normal[3][Tree::k_width];  ///< Unit vectors.
  double middle[Tree::k_width];
  double half[Tree::k_width];
  double box_center[3][Tree::k_width];
  double box_half[3][Tree::k_width];
};

/// What does not depend on the rotation. All coordinates are relative to the centre of the mesh's box. Immutable.
class CastMesh {
 public:
  explicit CastMesh(std::shared_ptr<const Tree> tree);

  const Tree& tree() const { return *tree_; }
  std::span<const CastNode> nodes() const { return nodes_; }                            ///< Without boxes.
  std::span<const PreciseVolumes> precise_volumes() const { return precise_volumes_; }  ///< Of each node's children.

 private:
  std::shared_ptr<const Tree> tree_;
  std::vector<CastNode> nodes_;
  std::vector<PreciseVolumes> precise_volumes_;
};

/// A mesh in the common frame: p -> M (p - centre), where M is a rotation or minus the identity. Its boxes are fitted
/// to the transformed triangles, axis-aligned in the common frame. Floats are off by a few roundings of the radius.
class CastTree {
 public:
  explicit CastTree(std::shared_ptr<const CastMesh> mesh);

  /// Sets M and transforms all volumes and leaves.
  void transform(const Eigen::Matrix3d& M);

  const CastMesh& mesh() const { return *mesh_; }
  const Eigen::Matrix3d& matrix() const { return matrix_; }
  std::span<const CastNode> nodes() const { return nodes_; }
  std::span<const CastLeaf> leaves() const { return leaves_; }
  const CastVolume& volume(std::size_t slot) const { return volumes_[slot]; }
  /// The whole tree's: its slab is empty, with the normal 0.
  const CastVolume& root_volume() const { return root_volume_; }
  double radius() const { return mesh_->tree().radius(); }

  CastChild child(std::size_t slot) const { return nodes_[slot / Tree::k_width].child[slot % Tree::k_width]; }

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
  struct Bounds {
    float lower[3];
    float upper[3];
  };
  Bounds transform_leaf(std::uint32_t leaf, const float (&m)[3][3]);

  std::shared_ptr<const CastMesh> mesh_;
  Eigen::Matrix3d matrix_ = Eigen::Matrix3d::Identity();
  std::vector<CastNode> nodes_;
  std::vector<CastVolume> volumes_;
  std::vector<CastLeaf> leaves_;
  std::vector<Bounds> bounds_;  // of each node
  CastVolume root_volume_{};
};

}  // namespace sixdof::ray_cast
