#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/tree.h>
#include <sixdof/geometry/triangle_distance.h>

/// Trees turned into one common frame, for the ray cast. Internal: use ray_cast.h.
namespace sixdof::ray_cast {

/// A child of a CastNode: a node, or a leaf.
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

/// Volumes of up to eight children, [axis][child]; lanes without a child repeat the first.
struct alignas(64) CastNode {
  float center[3][Tree::k_width];  ///< Boxes.
  float half[3][Tree::k_width];    ///< Boxes: half extents.
  float normal[3][Tree::k_width];  ///< Slabs: a little shorter than unit vectors, as in Tree.
  float ball_center[3][Tree::k_width];
  float ball_radius[Tree::k_width];
  float slab_offset[Tree::k_width];  ///< Slabs: height of the middle above the ball's centre, along the normal.
  float slab_half[Tree::k_width];    ///< Slabs: half the thickness.
  CastChild child[Tree::k_width];
  std::uint32_t child_count;
};

/// The volumes of one child by themselves, as in CastNode: one cache line.
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

/// Corners of a leaf's triangles, [corner][axis][triangle]; places without a triangle repeat the first.
struct CastLeaf {
  float corner[3][3][Tree::k_leaf_triangles];
};

/// A slab in double precision: |normal . p - middle| <= half.
struct CastSlab {
  Eigen::Vector3d normal;
  double middle = 0.0;
  double half = 0.0;
};

/// Slabs and boxes of a node's children in double precision, [axis][child], in the mesh's axes: |normal . p - middle|
/// <= half, |p - box_center| <= box_half. Lanes without a child are zero.
struct alignas(64) CastPatches {
  double normal[3][Tree::k_width];  ///< Unit vectors.
  double middle[Tree::k_width];
  double half[Tree::k_width];
  double box_center[3][Tree::k_width];
  double box_half[3][Tree::k_width];

  CastSlab slab(std::size_t lane) const {
    return {{normal[0][lane], normal[1][lane], normal[2][lane]}, middle[lane], half[lane]};
  }
};

/// What does not depend on the rotation. All coordinates are relative to the centre of the mesh's box. Immutable.
class CastMesh {
 public:
  explicit CastMesh(std::shared_ptr<const Tree> tree);

  const Tree& tree() const { return *tree_; }
  std::span<const CastNode> nodes() const { return nodes_; }  ///< Without boxes.
  std::span<const CastLeaf> leaves() const { return leaves_; }
  std::span<const Tree::Child> leaf_children() const { return leaf_children_; }  ///< Of each leaf, in the tree.
  std::span<const CastPatches> patches() const { return patches_; }              ///< Of each node.

 private:
  std::shared_ptr<const Tree> tree_;
  std::vector<CastNode> nodes_;
  std::vector<CastLeaf> leaves_;
  std::vector<Tree::Child> leaf_children_;
  std::vector<CastPatches> patches_;
};

/// A mesh seen from another frame: p -> M (p - centre), where M is a rotation or minus the identity. Its boxes are
/// fitted anew to the triangles, axis-aligned in the new frame.
///
/// Floats are off by a few roundings of the tree's radius; whoever tests with them allows for it.
class CastTree {
 public:
  explicit CastTree(std::shared_ptr<const CastMesh> mesh);

  /// Takes 20 ns per triangle.
  void turn(const Eigen::Matrix3d& M);

  const CastMesh& mesh() const { return *mesh_; }
  const Eigen::Matrix3d& matrix() const { return matrix_; }
  std::span<const CastNode> nodes() const { return nodes_; }
  std::span<const CastLeaf> leaves() const { return leaves_; }
  /// Of child `lane` of node `node`: at [Tree::k_width * node + lane].
  const CastVolume& volume(std::size_t node_and_lane) const { return volumes_[node_and_lane]; }
  /// The whole tree's: no slab.
  const CastVolume& root_volume() const { return root_volume_; }
  double radius() const { return mesh_->tree().radius(); }

  /// Triangle `t` in tree order, in double precision.
  TriangleCorners triangle(std::uint32_t t) const;

  /// The slab of a child in double precision.
  CastSlab slab(std::size_t node_and_lane) const {
    const CastSlab s = mesh_->patches()[node_and_lane / Tree::k_width].slab(node_and_lane % Tree::k_width);
    return {matrix_ * s.normal, s.middle, s.half};
  }

 private:
  struct Bounds {
    float lower[3];
    float upper[3];
  };
  Bounds turn_leaf(std::uint32_t leaf, const float (&m)[3][3]);

  std::shared_ptr<const CastMesh> mesh_;
  Eigen::Matrix3d matrix_ = Eigen::Matrix3d::Identity();
  std::vector<CastNode> nodes_;
  std::vector<CastVolume> volumes_;
  std::vector<CastLeaf> leaves_;
  std::vector<Bounds> bounds_;  // of each node
  CastVolume root_volume_{};
};

}  // namespace sixdof::ray_cast
