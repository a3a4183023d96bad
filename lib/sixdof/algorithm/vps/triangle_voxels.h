#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>

#include <sixdof/base/parallel.h>

namespace sixdof::vps {

/// A triangle, in voxel coordinates, prepared for the separating-axis test against axis-aligned boxes: 3 box axes, the
/// triangle's normal and 9 cross products of edges (Akenine-Moeller, Fast 3D triangle-box overlap testing, 2001).
/// Contact counts as overlap. A triangle of zero area is tested as the segment or point that it is.
class SeparatingAxes {
 public:
  /// Margin added to every box, in voxels, so that rounding never hides a contact: far above the rounding of the test
  /// (1e-12 for coordinates below 2^12 voxels).
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
    const Eigen::Vector3d enlarged = half.array() + k_touch;
    for (const Axis& axis : axes_) {
      const double middle = axis.direction.dot(center), reach = axis.magnitude.dot(enlarged);
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

/// Inclusive.
struct VoxelRange {
  Eigen::Array3i low, high;
  Eigen::Array3i extent() const { return high - low + 1; }
  double count() const { return extent().cast<double>().prod(); }
};

namespace detail {

/// Ranges of at least this many voxels are halved in parallel, since one triangle may span the whole grid.
constexpr double k_parallel_range = 32.0 * 32.0 * 32.0;
/// Ranges of up to this many voxels are tested voxel by voxel; halving them would cost more tests than it saves.
constexpr double k_direct_range = 4.0;

template <class Callback>
void test_range(const SeparatingAxes& triangle, const VoxelRange& range, bool parallel, const Callback& callback) {
  const double count = range.count();
  if (count <= k_direct_range) {
    for (int z = range.low.z(); z <= range.high.z(); ++z) {
      for (int y = range.low.y(); y <= range.high.y(); ++y) {
        for (int x = range.low.x(); x <= range.high.x(); ++x) {
          if (triangle.overlaps({x + 0.5, y + 0.5, z + 0.5}, Eigen::Vector3d::Constant(0.5))) callback(x, y, z);
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
    parallel::invoke([&] { test_range(triangle, first, parallel, callback); },
                     [&] { test_range(triangle, second, parallel, callback); });
  } else {
    test_range(triangle, first, parallel, callback);
    test_range(triangle, second, parallel, callback);
  }
}

}  // namespace detail

/// Calls callback(x, y, z) once for every voxel that the triangle touches, voxel boundaries included; with `parallel`,
/// for large triangles on several threads at once, in no fixed order.
/// @param triangle in voxel coordinates, inside the grid
template <class Callback>
void for_each_touched_voxel(const SeparatingAxes& triangle, bool parallel, const Callback& callback) {
  VoxelRange range;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = triangle.corners()[0][axis], b = triangle.corners()[1][axis], c = triangle.corners()[2][axis];
    // A corner on a voxel's face touches the voxels on both sides.
    range.low[axis] = static_cast<int>(std::floor(std::min({a, b, c}) - SeparatingAxes::k_touch));
    range.high[axis] = static_cast<int>(std::floor(std::max({a, b, c}) + SeparatingAxes::k_touch));
  }
  detail::test_range(triangle, range, parallel, callback);
}

}  // namespace sixdof::vps
