#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <sixdof/algorithm/vps/pointshell.h>
#include <sixdof/algorithm/vps/voxelmap.h>
#include <sixdof/geometry/pose.h>

namespace sixdof::vps {

/// Where a body's points stand in a voxelmap: maps a point (relative to PointTree::center) to voxel coordinates.
struct Placement {
  Eigen::Matrix3f rotation;  ///< From the points' frame to the voxelmap's.
  Eigen::Matrix3f scaled;    ///< The same over the voxel size.
  Eigen::Vector3f center;    ///< Voxel coordinates of PointTree::center.

  /// @param X pose of the points' body in the frame of the voxelmap's body
  static Placement of(const Pose& X, const Eigen::Vector3d& center, const VoxelGrid& grid);
};

/// A pointshell in leaves of 32 points, four blocks of 8 that are computed at once, under a tree of spheres with eight
/// children a node, which are told apart at once too.
class PointTree {
 public:
  static constexpr std::size_t k_block = 8;
  static constexpr std::size_t k_rows = 7;  ///< x, y, z, weight, normal x, y, z: 8 floats each.
  static constexpr std::size_t k_leaf_blocks = 4;
  static constexpr std::size_t k_leaf_points = k_leaf_blocks * k_block;

  /// @param center points are kept relative to it; the reference point of torques
  /// @param by_area weights are areas; otherwise 1
  PointTree(const PointShell& shell, const Eigen::Vector3d& center, bool by_area);

  const Eigen::Vector3d& center() const { return center_; }
  std::size_t points() const { return points_; }
  std::uint32_t leaves() const { return leaves_; }
  std::size_t nodes() const { return nodes_.size(); }
  /// Blocks of k_rows * k_block floats, k_leaf_blocks per leaf. Missing points of the last leaf repeat its last point
  /// with weight 0.
  const float* blocks() const { return blocks_.data(); }
  std::size_t bytes() const { return nodes_.size() * sizeof(Node) + blocks_.size() * sizeof(float); }

  /// Writes the leaves, ascending, that may hold a point in a voxel with v >= 0, or within `reach` (in voxels) of one;
  /// all others surely hold none. A node is left out whose centre is further outside than its radius, and a node is
  /// taken whole whose centre is further inside.
  void cull(const VoxelMap& map, const Placement& placement, double reach, std::vector<std::uint32_t>& leaves) const;

  /// The same in ascending order until visit(first leaf, end leaf) returns true; says whether one did.
  template <class Visit>
  bool any_leaves(const VoxelMap& map, const Placement& placement, double reach, const Visit& visit) const {
    std::array<Child, k_stack> stack;
    std::size_t size = 0;
    stack[size++] = {.node = 0};
    while (size > 0) {
      const Child next = stack[--size];
      if (next.node == k_no_node) {
        if (visit(next.first_leaf, next.end_leaf)) return true;
        continue;
      }
      const Node& node = nodes_[next.node];
      const Sides sides = sides_of(node, map, placement, reach);
      for (std::uint32_t i = node.children; i-- > 0;) {  // the last one pushed is the next one popped
        if ((sides.outside >> i & 1u) != 0) continue;
        Child& child = stack[size++];
        child = node.child[i];
        if ((sides.inside >> i & 1u) != 0) child.node = k_no_node;
      }
    }
    return false;
  }

 private:
  static constexpr std::uint32_t k_no_node = UINT32_MAX;
  static constexpr std::size_t k_width = 8;       ///< Children per node, at most.
  static constexpr std::size_t k_stack = 16 * 8;  ///< Eight per level: 8^11 leaves of 32 points pass 32 bits.

  struct Child {
    std::uint32_t node = k_no_node;              ///< k_no_node: a leaf, or to be taken whole.
    std::uint32_t first_leaf = 0, end_leaf = 0;  ///< Below this child.
  };

  /// Spheres around the points of up to eight children; those that exist fill the first lanes, the others repeat the
  /// last one.
  struct alignas(32) Node {
    float sphere[4][k_width];  ///< Rows x, y, z (centres, relative to center_) and radius (of the points only).
    Child child[k_width];
    std::uint32_t children = 0;
  };

  /// One bit per child.
  struct Sides {
    unsigned outside = 0;  ///< No point can be in contact.
    unsigned inside = 0;   ///< All points surely are.
  };

  static Sides sides_of(const Node& node, const VoxelMap& map, const Placement& placement, double reach);

  struct Range {
    std::size_t begin, end;
    std::size_t leaves() const { return (end - begin + k_leaf_points - 1) / k_leaf_points; }
  };
  /// Sorts the points of a range into two halves of whole leaves, so that only the last leaf is not full.
  static std::pair<Range, Range> split(const PointShell& shell, std::vector<std::uint32_t>& order, Range range);
  std::uint32_t build(const PointShell& shell, std::vector<std::uint32_t>& order, Range range);

  Eigen::Vector3d center_;
  std::size_t points_;
  std::uint32_t leaves_ = 0;
  std::vector<Node> nodes_;
  std::vector<float> blocks_;
};

}  // namespace sixdof::vps
