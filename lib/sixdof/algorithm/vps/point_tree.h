#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
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

/// A pointshell in leaves of eight points, which are computed at once, under a tree of spheres with eight children a
/// node, which are told apart at once too. All leaves are equally deep.
class PointTree {
 public:
  static constexpr std::size_t k_leaf_points = 8;
  static constexpr std::size_t k_rows = 7;  ///< x, y, z, weight, normal x, y, z: 8 floats each.

  /// @param center points are kept relative to it; the reference point of torques
  /// @param by_area weights are areas; otherwise 1
  PointTree(const PointShell& shell, const Eigen::Vector3d& center, bool by_area);

  const Eigen::Vector3d& center() const { return center_; }
  std::size_t points() const { return points_; }
  std::uint32_t leaves() const { return leaves_; }
  std::size_t nodes() const { return nodes_.size(); }
  /// Blocks of k_rows * k_leaf_points floats, one per leaf. Missing points of the last leaf repeat its last point with
  /// weight 0.
  const float* blocks() const { return blocks_.data(); }
  std::size_t bytes() const {
    return nodes_.size() * (sizeof(Node) + sizeof(first_[0])) + blocks_.size() * sizeof(float);
  }

  /// Memory that culling reuses from query to query.
  struct Scratch {
    std::vector<std::uint32_t> here, below;
  };

  /// The leaves, ascending, that may hold a point in a voxel with v >= 0, or within `reach` (in voxels) of one; all
  /// others surely hold none. Valid until the scratch is used again.
  std::span<const std::uint32_t> cull(const VoxelMap& map, const Placement& placement, double reach,
                                      Scratch& scratch) const;

  /// The same in any order and in parts, until visit(leaves) returns true; says whether it did.
  using Visit = std::function<bool(std::span<const std::uint32_t>)>;
  bool any_leaves(const VoxelMap& map, const Placement& placement, double reach, Scratch& scratch,
                  const Visit& visit) const;

  static constexpr std::size_t k_width = 8;  ///< Children per node, at most.

  /// Spheres around the points of up to eight children: rows x, y, z (centres, relative to center()) and radius (of the
  /// points only). Children fill the lanes from the first on; in the others the radius is -infinity.
  struct alignas(64) Node {
    float sphere[4][k_width];
  };

 private:
  struct Range {
    std::size_t begin, end;  ///< Points.
    std::size_t leaves() const { return (end - begin + k_leaf_points - 1) / k_leaf_points; }
  };
  /// Sorts the points of a range into parts of whole leaves and nearly equal number, so that only the last leaf is not
  /// full, and appends them.
  static void split(const PointShell& shell, std::vector<std::uint32_t>& order, Range range, std::size_t parts,
                    std::vector<Range>& out);
  Node enclose(const PointShell& shell, const std::vector<std::uint32_t>& order, std::span<const Range> children) const;

  Eigen::Vector3d center_;
  std::size_t points_;
  std::uint32_t leaves_ = 0;
  std::vector<Node> nodes_;           ///< Level by level from the root; a node's children are neighbours.
  std::vector<std::uint32_t> first_;  ///< Per node: its first child, a node, or a leaf on the last level.
  std::uint32_t last_level_ = 0;      ///< First node of the last level.
  std::vector<float> blocks_;
};

}  // namespace sixdof::vps
