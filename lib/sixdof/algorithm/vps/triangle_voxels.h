#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>

#include <sixdof/base/parallel.h>

namespace sixdof::vps {

/// A triangle, in voxel coordinates, prepared for the separating-axis test against axis-aligned boxes: 3 box axes, the
/// triangle's normal and 9 products of edges (Akenine-Moeller, Fast 3D triangle-box overlap testing, 2001). Sets that
/// touch count as overlapping. A triangle of zero area is tested as the segment or point that it is.
class SeparatingAxes {
 public:
  /// Widening of every box, in voxels: far above the rounding of a separating-axis test (coordinates below 2^12 voxels:
  /// 1e-12), far below anything geometric. Contact decided by rounding counts as contact.
  static constexpr double k_touch = 1e-9;

  explicit SeparatingAxes(const std::array<Eigen::Vector3d, 3>& corners) : corners_(corners) {
    const std::array<Eigen::Vector3d, 3> edges{corners[1] - corners[0], corners[2] - corners[1],
                                               corners[0] - corners[2]};
    std::size_t n = 0;
    for (int axis = 0; axis < 3; ++axis) set(n++, Eigen::Vector3d::Unit(axis));
    set(n++, edges[0].cross(edges[1]));
    for (int axis = 0; axis < 3; ++axis) {
      for (const Eigen::Vector3d& edge : edges) set(n++, Eigen::Vector3d::Unit(axis).cross(edge));
    }
  }

  bool overlaps(const Eigen::Vector3d& center, const Eigen::Vector3d& half) const {
    const Eigen::Vector3d widened = half.array() + k_touch;
    for (const Axis& axis : axes_) {
      const double middle = axis.direction.dot(center), reach = axis.magnitude.dot(widened);
      if (middle + reach < axis.low || middle - reach > axis.high) return false;
    }
    return true;
  }

  const std::array<Eigen::Vector3d, 3>& corners() const { return corners_; }

 private:
  struct Axis {
    Eigen::Vector3d direction, magnitude;
    double low, high;
  };

  void set(std::size_t i, const Eigen::Vector3d& direction) {
    const double a = direction.dot(corners_[0]), b = direction.dot(corners_[1]), c = direction.dot(corners_[2]);
    axes_[i] = {direction, direction.cwiseAbs(), std::min({a, b, c}), std::max({a, b, c})};
  }

  std::array<Eigen::Vector3d, 3> corners_;
  std::array<Axis, 13> axes_;
};

/// An inclusive range of voxels.
struct VoxelRange {
  Eigen::Array3i low, high;
  Eigen::Array3i extent() const { return high - low + 1; }
  double count() const { return extent().cast<double>().prod(); }
};

namespace detail {

/// Ranges at least this big are halved on two threads: a triangle that spans the grid must not hold up the others.
constexpr double k_parallel_range = 32.0 * 32.0 * 32.0;
/// Ranges up to this size are tested voxel by voxel; halving would cost more tests than it saves.
constexpr double k_direct_range = 4.0;

template <class Visit>
void visit_range(const SeparatingAxes& triangle, const VoxelRange& range, bool parallel, const Visit& visit) {
  const double count = range.count();
  if (count <= k_direct_range) {
    for (int z = range.low.z(); z <= range.high.z(); ++z) {
      for (int y = range.low.y(); y <= range.high.y(); ++y) {
        for (int x = range.low.x(); x <= range.high.x(); ++x) {
          if (triangle.overlaps({x + 0.5, y + 0.5, z + 0.5}, Eigen::Vector3d::Constant(0.5))) visit(x, y, z);
        }
      }
    }
    return;
  }
  const Eigen::Vector3d half = 0.5 * range.extent().cast<double>();
  if (!triangle.overlaps(range.low.cast<double>().matrix() + half, half)) return;
  int axis = 0;
  range.extent().maxCoeff(&axis);
  VoxelRange first = range, second = range;
  first.high[axis] = range.low[axis] + range.extent()[axis] / 2 - 1;
  second.low[axis] = first.high[axis] + 1;
  if (parallel && count >= k_parallel_range) {
    parallel::invoke([&] { visit_range(triangle, first, parallel, visit); },
                     [&] { visit_range(triangle, second, parallel, visit); });
  } else {
    visit_range(triangle, first, parallel, visit);
    visit_range(triangle, second, parallel, visit);
  }
}

}  // namespace detail

/// Calls visit(x, y, z) once for every voxel that the triangle touches, voxel boundaries included, at a cost that grows
/// with the number of these voxels rather than with the triangle's box. With `parallel`, big triangles are visited from
/// several threads at once, in no particular order.
/// @param triangle in voxel coordinates, inside the grid
template <class Visit>
void for_each_touched_voxel(const SeparatingAxes& triangle, bool parallel, const Visit& visit) {
  VoxelRange range;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = triangle.corners()[0][axis], b = triangle.corners()[1][axis], c = triangle.corners()[2][axis];
    // A corner on a voxel's face touches the voxels on both sides.
    range.low[axis] = static_cast<int>(std::floor(std::min({a, b, c}) - SeparatingAxes::k_touch));
    range.high[axis] = static_cast<int>(std::floor(std::max({a, b, c}) + SeparatingAxes::k_touch));
  }
  detail::visit_range(triangle, range, parallel, visit);
}

}  // namespace sixdof::vps
