#include <sixdof/algorithm/vps/surface_voxels.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <numeric>

#include <sixdof/algorithm/vps/triangle_voxels.h>
#include <sixdof/algorithm/vps/winding_number.h>
#include <sixdof/base/parallel.h>

namespace sixdof::vps {
namespace {

constexpr std::size_t k_word = 64;

/// First voxel x >= from of the row whose bit equals `wanted`, or `end`.
int find_bit(std::span<const std::uint64_t> row, int from, int end, bool wanted) {
  while (from < end) {
    const auto x = static_cast<std::size_t>(from);
    std::uint64_t word = wanted ? row[x / k_word] : ~row[x / k_word];
    word >>= x % k_word;
    if (word != 0) return std::min(end, from + std::countr_zero(word));
    from = static_cast<int>((x / k_word + 1) * k_word);
  }
  return end;
}

/// Union-find over runs. The smaller index becomes the root, so that roots do not depend on the order of unions.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::uint32_t i, std::uint32_t j) {
    i = root(i);
    j = root(j);
    if (i < j) {
      parent_[j] = i;
    } else {
      parent_[i] = j;
    }
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace

SurfaceVoxels::SurfaceVoxels(const Mesh& mesh, const VoxelGrid& grid)
    : grid_(grid), words_per_row_((static_cast<std::size_t>(grid.voxels().x()) + k_word - 1) / k_word) {
  bits_.assign(row_index(0, grid_.voxels().z()) * words_per_row_, 0);
  const auto mark = [this](int x, int y, int z) {
    const auto column = static_cast<std::size_t>(x);
    std::uint64_t& word = bits_[row_index(y, z) * words_per_row_ + column / k_word];
    std::atomic_ref(word).fetch_or(std::uint64_t{1} << (column % k_word), std::memory_order_relaxed);
  };
  parallel::for_each(mesh.triangles().size(), [&](std::size_t t) {
    std::array<Eigen::Vector3d, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) corners[c] = grid_.coordinates(mesh.vertices()[mesh.triangles()[t][c]]);
    for_each_touched_voxel(SeparatingAxes(corners), true, mark);
  });
}

std::size_t SurfaceVoxels::count() const {
  std::size_t n = 0;
  for (const std::uint64_t word : bits_) n += static_cast<std::size_t>(std::popcount(word));
  return n;
}

FreeRuns::FreeRuns(const SurfaceVoxels& surface, const WindingNumber& winding)
    : rows_per_slice_(static_cast<std::size_t>(surface.grid().voxels().y())) {
  const Eigen::Array3i n = surface.grid().voxels();
  const std::size_t rows = rows_per_slice_ * static_cast<std::size_t>(n.z());
  const auto row_of = [&](std::size_t r) {
    return surface.row(static_cast<int>(r % rows_per_slice_), static_cast<int>(r / rows_per_slice_));
  };

  // The runs of every row: first count them, then write them.
  const auto for_each_run = [&](std::size_t r, const auto& callback) {
    for (int x = find_bit(row_of(r), 0, n.x(), false); x < n.x();) {
      const int end = find_bit(row_of(r), x, n.x(), true);
      callback(x, end);
      x = find_bit(row_of(r), end, n.x(), false);
    }
  };
  first_.assign(rows + 1, 0);
  parallel::for_each(rows, [&](std::size_t r) { for_each_run(r, [&](int, int) { ++first_[r + 1]; }); });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  runs_.resize(first_.back());
  parallel::for_each(rows, [&](std::size_t r) {
    std::size_t i = first_[r];
    for_each_run(r, [&](int begin, int end) { runs_[i++] = {begin, end, false}; });
  });

  // Connect runs of neighbouring rows that share a face of a voxel.
  DisjointSets sets(runs_.size());
  const auto join = [&](std::size_t r, std::size_t s) {
    for (std::size_t i = first_[r], j = first_[s]; i < first_[r + 1] && j < first_[s + 1];) {
      if (runs_[i].begin < runs_[j].end && runs_[j].begin < runs_[i].end) {
        sets.unite(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
      }
      ++(runs_[i].end < runs_[j].end ? i : j);
    }
  };
  for (std::size_t r = 0; r < rows; ++r) {
    if (r % rows_per_slice_ != 0) join(r, r - 1);
    if (r >= rows_per_slice_) join(r, r - rows_per_slice_);
  }

  // The winding number is taken at the middle of a region's longest run, which is far from the surface.
  struct Region {
    std::size_t row = 0, run = 0;
    int length = 0;
    bool inside = false;
  };
  std::vector<Region> regions;
  std::vector<std::uint32_t> region_of(runs_.size());
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t i = first_[r]; i < first_[r + 1]; ++i) {
      const std::uint32_t root = sets.root(static_cast<std::uint32_t>(i));
      if (root == i) {
        region_of[i] = static_cast<std::uint32_t>(regions.size());
        regions.emplace_back();
      }
      region_of[i] = region_of[root];
      Region& region = regions[region_of[i]];
      if (const int length = runs_[i].end - runs_[i].begin; length > region.length) {
        region = {.row = r, .run = i, .length = length};
      }
    }
  }
  // Region 0 has the first run, which is on the grid's border: the outside.
  parallel::for_each(regions.size(), [&](std::size_t k) {
    if (k == 0) return;
    Region& region = regions[k];
    const int x = (runs_[region.run].begin + runs_[region.run].end) / 2;
    const auto y = static_cast<int>(region.row % rows_per_slice_), z = static_cast<int>(region.row / rows_per_slice_);
    region.inside = winding.at(surface.grid().center(x, y, z)) > 0.5;
  });
  for (std::size_t i = 0; i < runs_.size(); ++i) runs_[i].inside = regions[region_of[i]].inside;
}

}  // namespace sixdof::vps
