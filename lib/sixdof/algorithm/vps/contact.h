#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include <sixdof/algorithm/vps/field.h>
#include <sixdof/algorithm/vps/point_tree.h>
#include <sixdof/algorithm/vps/voxelmap.h>

namespace sixdof::vps {

/// Sums over the points in contact. Each of the eight lanes of a leaf has its own sum: in single precision within a
/// batch of k_batch_leaves leaves, in double precision over the batches; lanes are added at the end. So the bits depend
/// neither on the instruction set nor on whether leaves without contact are left out.
struct ContactSums {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< Weight x voxels.
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< About the tree's center; see the functions for its unit.
  double contacts = 0.0;                             ///< Number of points in contact.
  double depth = 0.0;                                ///< Greatest penetration of a point, in voxels.
};

constexpr std::uint32_t k_batch_leaves = 16;

/// The penetration p of a point, in voxels, from the layer v >= 0 of its voxel.
enum class LayerDepth {
  layers,            ///< p = v
  layers_and_local,  ///< p = max(0, n . (voxel centre - point) + v), n the point's inward normal
};

/// Leaves of a point tree, ascending, at a pose.
struct PosedLeaves {
  const PointTree& tree;
  const VoxelTransform& transform;
  std::span<const std::uint32_t> leaves;
};

/// Sums of w p n and of w p (P - C) x n over the points with v >= 0, in the POINTS' frame; torque in weight x voxels x
/// length.
ContactSums sum_layers(const VoxelMap& map, const PosedLeaves& points, LayerDepth depth);

/// Is there a point with v >= 0?
bool touches_layers(const VoxelMap& map, const PosedLeaves& points);

/// Sums of -w f grad f and of (P - C) x (-w f grad f) over the points where the field f is negative, in the VOXELMAP's
/// frame, all in voxels: minus the gradient of the energy sum w f^2 / 2 by translation and rotation of the points.
ContactSums sum_field(const DistanceField& field, const PosedLeaves& points);

/// Is there a point where the field is negative?
bool touches_field(const DistanceField& field, const PosedLeaves& points);

}  // namespace sixdof::vps
