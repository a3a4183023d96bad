#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include <sixdof/algorithm/vps/grid.h>

namespace sixdof::vps {

/// Points sorted into the voxels of a grid, to find neighbours. Each row of voxels along x has a list sorted by x.
class PointCells {
 public:
  PointCells(const VoxelGrid& grid, std::span<const Eigen::Vector3d> points) : grid_(grid), n_(grid.voxels()) {
    std::vector<Eigen::Array3i> cells;
    cells.reserve(points.size());
    first_.assign(row(0, n_.z()) + 1, 0);
    for (const Eigen::Vector3d& point : points) {
      cells.push_back(cell_of(point));
      ++first_[row(cells.back().y(), cells.back().z()) + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    entries_.resize(points.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      entries_[next[row(cells[i].y(), cells[i].z())]++] = {cells[i].x(), i};
    }
    for (std::size_t r = 0; r + 1 < first_.size(); ++r) {
      std::sort(entries_.begin() + first_[r], entries_.begin() + first_[r + 1]);
    }
  }

  /// Calls callback(index) for every point whose voxel is at most `reach` voxels away from that of `point` along each
  /// axis. All points nearer than reach * voxel size are among them.
  template <class Callback>
  void for_each_near(const Eigen::Vector3d& point, int reach, const Callback& callback) const {
    const Eigen::Array3i cell = cell_of(point);
    const Eigen::Array3i low = (cell - reach).max(0), high = (cell + reach).min(n_ - 1);
    for (int z = low.z(); z <= high.z(); ++z) {
      for (int y = low.y(); y <= high.y(); ++y) {
        const auto end = entries_.begin() + first_[row(y, z) + 1];
        auto entry = std::lower_bound(entries_.begin() + first_[row(y, z)], end, std::pair{low.x(), std::uint32_t{0}});
        for (; entry != end && entry->first <= high.x(); ++entry) callback(entry->second);
      }
    }
  }

 private:
  Eigen::Array3i cell_of(const Eigen::Vector3d& point) const {
    return grid_.coordinates(point).array().floor().cast<int>().max(0).min(n_ - 1);
  }
  std::size_t row(int y, int z) const {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(n_.y()) + static_cast<std::size_t>(y);
  }

  VoxelGrid grid_;
  Eigen::Array3i n_;
  std::vector<std::uint32_t> first_;
  std::vector<std::pair<int, std::uint32_t>> entries_;  ///< x of the voxel, index of the point
};

}  // namespace sixdof::vps
