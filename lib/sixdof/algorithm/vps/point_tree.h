#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/algorithm/vps/pointshell.h>
#include <sixdof/algorithm/vps/voxelmap.h>
#include <sixdof/geometry/pose.h>

namespace sixdof::vps {

/// Maps a point p of a PointTree (relative to its center()) to voxel coordinates: p -> scaled p + center.
struct VoxelTransform {
  Eigen::Matrix3f rotation;  ///< From the points' frame to the voxelmap's.
  Eigen::Matrix3f scaled;    ///< `rotation` over the voxel size.
  Eigen::Vector3f center;    ///< Voxel coordinates of PointTree::center().

  /// @param X pose of the points' body in the frame of the voxelmap's body
  static VoxelTransform of(const Pose& X, const Eigen::Vector3d& center, const VoxelGrid& grid);
};

/// A pointshell as a tree of bounding spheres, eight points per leaf. All leaves have the same depth.
class PointTree {
 public:
  static constexpr std::size_t k_leaf_points = 8;
  static constexpr std::size_t k_rows = 7;   ///< x, y, z, weight, normal x, y, z: 8 floats each.
  static constexpr std::size_t k_width = 8;  ///< Children per node, at most.

  /// @param center points are stored relative to it; the reference point of torques
  /// @param by_area whether a point's weight is its area; otherwise it is 1
  PointTree(const PointShell& shell, const Eigen::Vector3d& center, bool by_area);

  const Eigen::Vector3d& center() const { return center_; }
  std::size_t points() const { return points_; }
  std::uint32_t leaves() const { return leaves_; }
  std::size_t nodes() const { return nodes_.size(); }
  /// k_rows * k_leaf_points floats per leaf; the last leaf is filled up with copies of its last point of weight 0.
  const float* blocks() const { return blocks_.data(); }
  std::size_t bytes() const {
    return nodes_.size() * (sizeof(Node) + sizeof(first_child_[0])) + blocks_.size() * sizeof(float);
  }

  /// Memory that culling reuses.
  struct Scratch {
    std::vector<std::uint32_t> current, next;
  };

  /// Finds the leaves, in ascending order, that may hold a point in a voxel with v >= 0, or within `reach` (in voxels)
  /// of one. The other leaves hold none. Valid until the scratch is used again.
  std::span<const std::uint32_t> cull(const VoxelMap& map, const VoxelTransform& transform, double reach,
                                      Scratch& scratch) const;

  /// Finds the same leaves in any order, in parts, until accept(leaves) returns true. @return whether it did
  using LeafTest = std::function<bool(std::span<const std::uint32_t>)>;
  bool any_leaves(const VoxelMap& map, const VoxelTransform& transform, double reach, Scratch& scratch,
                  const LeafTest& accept) const;

  /// Bounding spheres of the points of up to eight children: rows x, y, z (centres, relative to center()) and radius.
  /// Children fill the first lanes; the other lanes have radius -infinity.
  struct alignas(64) Node {
    float sphere[4][k_width];
  };

 private:
  Eigen::Vector3d center_;
  std::size_t points_;
  std::uint32_t leaves_ = 0;
  std::vector<Node> nodes_;                 ///< Level by level from the root; the children of a node are consecutive.
  std::vector<std::uint32_t> first_child_;  ///< Per node: a node, or a leaf on the last level.
  std::uint32_t last_level_ = 0;            ///< First node of the last level.
  std::vector<float> blocks_;
};

}  // namespace sixdof::vps
