#pragma once

#include <cstdint>
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

/// A pointshell in leaves of 32 points, four blocks of 8 that are computed at once, under a binary tree of spheres.
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
    const Culling culling(map, placement, reach);
    for (std::size_t n = 0; n < nodes_.size();) {
      const Node& node = nodes_[n];
      const Side side = culling.side(node);
      if (side == Side::outside) {
        n = node.skip;
      } else if (side == Side::inside || node.end_leaf - node.first_leaf == 1) {
        if (visit(node.first_leaf, node.end_leaf)) return true;
        n = node.skip;
      } else {
        ++n;
      }
    }
    return false;
  }

 private:
  struct Node {
    float x, y, z;                       ///< Centre, relative to center_.
    float radius;                        ///< Of the points only.
    std::uint32_t skip;                  ///< Next node in preorder that is not below this one.
    std::uint32_t first_leaf, end_leaf;  ///< Below this node.
  };

  enum class Side {
    outside,  ///< No point can be in contact.
    inside,   ///< All points surely are.
    both
  };

  /// Tells nodes' sides, for one query.
  class Culling {
   public:
    Culling(const VoxelMap& map, const Placement& placement, double reach);
    Side side(const Node& node) const;

   private:
    const VoxelMap& map_;
    const Placement& placement_;
    float per_size_, slack_;
    Eigen::Array3f end_;
  };

  void build(const PointShell& shell, std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end);

  Eigen::Vector3d center_;
  std::size_t points_;
  std::uint32_t leaves_ = 0;
  std::vector<Node> nodes_;
  std::vector<float> blocks_;
};

}  // namespace sixdof::vps
