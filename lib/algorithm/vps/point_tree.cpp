#include <sixdof/algorithm/vps/point_tree.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sixdof::vps {
namespace {

/// Slack for the rounding of single-precision voxel coordinates, in voxels: coordinates below 2^12 round to 2^-12.
constexpr float k_rounding = 1e-3f;
constexpr float k_half_diagonal = 0.8660254f;  // of a voxel

}  // namespace

Placement Placement::of(const Pose& X, const Eigen::Vector3d& center, const VoxelGrid& grid) {
  return {.rotation = X.R.cast<float>(),
          .scaled = (X.R / grid.size).cast<float>(),
          .center = grid.coordinates(X * center).cast<float>()};
}

PointTree::PointTree(const PointShell& shell, const Eigen::Vector3d& center, bool by_area)
    : center_(center), points_(shell.points.size()) {
  std::vector<std::uint32_t> order(points_);
  std::iota(order.begin(), order.end(), 0u);
  build(shell, order, 0, points_);
  leaves_ = static_cast<std::uint32_t>((points_ + k_leaf_points - 1) / k_leaf_points);
  blocks_.resize(leaves_ * k_leaf_blocks * k_rows * k_block);
  for (std::size_t i = 0; i < leaves_ * k_leaf_points; ++i) {
    const std::uint32_t p = order[std::min(i, points_ - 1)];
    const Eigen::Vector3f position = (shell.points[p] - center_).cast<float>(), normal = shell.normals[p].cast<float>();
    const float weight = i >= points_ ? 0.0f : by_area ? static_cast<float>(shell.areas[p]) : 1.0f;
    float* const lane = blocks_.data() + i / k_block * k_rows * k_block + i % k_block;
    const float row[k_rows] = {position.x(), position.y(), position.z(), weight, normal.x(), normal.y(), normal.z()};
    for (std::size_t r = 0; r < k_rows; ++r) lane[r * k_block] = row[r];
  }
}

void PointTree::build(const PointShell& shell, std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end) {
  const std::size_t here = nodes_.size();
  nodes_.emplace_back();
  Eigen::AlignedBox3d box;
  for (std::size_t i = begin; i < end; ++i) box.extend(shell.points[order[i]]);
  Node node;
  const Eigen::Vector3f middle_of_box = (box.center() - center_).cast<float>();
  node.x = middle_of_box.x();
  node.y = middle_of_box.y();
  node.z = middle_of_box.z();
  double radius = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    radius = std::max(radius, (shell.points[order[i]] - box.center()).norm());
  }
  node.radius = static_cast<float>(radius);
  const std::size_t leaves = (end - begin + k_leaf_points - 1) / k_leaf_points;
  node.first_leaf = static_cast<std::uint32_t>(begin / k_leaf_points);
  node.end_leaf = static_cast<std::uint32_t>(begin / k_leaf_points + leaves);
  if (leaves > 1) {
    // Halves of whole leaves, so that only the last leaf is not full.
    const std::size_t middle = begin + (leaves + 1) / 2 * k_leaf_points;
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t i, std::uint32_t j) {
      const double a = shell.points[i][axis], b = shell.points[j][axis];
      return a != b ? a < b : i < j;
    });
    build(shell, order, begin, middle);
    build(shell, order, middle, end);
  }
  node.skip = static_cast<std::uint32_t>(nodes_.size());
  nodes_[here] = node;
}

PointTree::Culling::Culling(const VoxelMap& map, const Placement& placement, double reach)
    : map_(map),
      placement_(placement),
      per_size_(static_cast<float>(1.0 / map.grid.size)),
      slack_(k_rounding + static_cast<float>(reach)),
      end_(map.grid.voxels().cast<float>()) {}

PointTree::Side PointTree::Culling::side(const Node& node) const {
  const Eigen::Matrix3f& m = placement_.scaled;
  const float q[3] = {m(0, 0) * node.x + m(0, 1) * node.y + m(0, 2) * node.z + placement_.center.x(),
                      m(1, 0) * node.x + m(1, 1) * node.y + m(1, 2) * node.z + placement_.center.y(),
                      m(2, 0) * node.x + m(2, 1) * node.y + m(2, 2) * node.z + placement_.center.z()};
  // A centre beyond the grid is moved to its border; the way there counts as one leg of a right angle, since all of the
  // surface lies on the other side of that border.
  float beyond = 0.0f;
  int voxel[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float moved = std::min(std::max(q[axis], 0.0f), end_[axis]);
    beyond += (q[axis] - moved) * (q[axis] - moved);
    voxel[axis] = std::min(static_cast<int>(moved), static_cast<int>(end_[axis]) - 1);
  }
  const float radius = node.radius * per_size_ + slack_;
  const float left = radius * radius - beyond;
  if (!(left >= 0.0f)) return Side::outside;
  // A straight way from the node's centre to a voxel with v >= 0 first enters such a voxel where it is a surface voxel:
  // half a diagonal from that voxel's centre at most. The node's centre is within half a diagonal of its own voxel's.
  const float distance = map_.outside_distance(voxel[0], voxel[1], voxel[2]);
  const float out = distance - 2.0f * k_half_diagonal;
  if (out > 0.0f && out * out > left) return Side::outside;
  // Inside, |v| is rounded the other way; no way as short leads out of voxels with v >= 0.
  const float in = -distance - 1.0f - 2.0f * k_half_diagonal;
  return in > radius ? Side::inside : Side::both;
}

void PointTree::cull(const VoxelMap& map, const Placement& placement, double reach,
                     std::vector<std::uint32_t>& leaves) const {
  leaves.clear();
  any_leaves(map, placement, reach, [&](std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t leaf = first; leaf < end; ++leaf) leaves.push_back(leaf);
    return false;
  });
}

}  // namespace sixdof::vps
