#include <sixdof/algorithm/vps/surface_voxels.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <Eigen/Geometry>

#include <sixdof/algorithm/vps/triangle_voxels.h>
#include <sixdof/base/parallel.h>
#include <sixdof/geometry/sides.h>

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

constexpr std::int32_t k_infinite = std::numeric_limits<std::int32_t>::max();

/// s.output[i] = min over j of (i - j)^2 + s.values[j], without the j where the value is k_infinite.
void lower_envelope(int n, DistanceTransform::Scratch& s) {
  const auto at = [](std::vector<std::int32_t>& v, int i) -> std::int32_t& { return v[static_cast<std::size_t>(i)]; };
  int top = -1;
  for (int j = 0; j < n; ++j) {
    if (at(s.values, j) == k_infinite) continue;
    std::int32_t from = 0;  // parabola j is the lowest at i >= from
    while (top >= 0) {
      const std::int32_t i = at(s.centers, top);
      // Parabola j lies below parabola i at x > (j^2 - i^2 + values[j] - values[i]) / (2 (j - i)).
      const std::int32_t rise = j * j - i * i + at(s.values, j) - at(s.values, i), run = 2 * (j - i);
      const std::int32_t crossing = rise >= 0 ? rise / run : -((-rise + run - 1) / run);
      if (crossing >= at(s.bounds, top)) {
        from = crossing + 1;
        break;
      }
      --top;
    }
    if (from >= n) continue;
    ++top;
    at(s.centers, top) = j;
    at(s.bounds, top) = from;
  }
  if (top < 0) {
    std::fill_n(s.output.begin(), n, k_infinite);
    return;
  }
  for (int k = 0; k <= top; ++k) {
    const std::int32_t center = at(s.centers, k), value = at(s.values, center);
    const std::int32_t end = k < top ? at(s.bounds, k + 1) : n;
    for (std::int32_t i = at(s.bounds, k); i < end; ++i) at(s.output, i) = (i - center) * (i - center) + value;
  }
}

/// Signed solid angle of a triangle seen from p (van Oosterom and Strackee 1983), positive if p is behind it.
double solid_angle(const Tree::Corners& corners, const Eigen::Vector3d& p) {
  const Eigen::Vector3d a = corners[0] - p, b = corners[1] - p, c = corners[2] - p;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace

WindingNumber::WindingNumber(const Tree& tree) : tree_(&tree) {
  dipoles_.reserve(tree.nodes().size());
  for (const Tree::Node& node : tree.nodes()) {
    const auto triangles = tree.corners().subspan(node.first_triangle, node.triangle_count);
    Dipole& dipole = dipoles_.emplace_back();
    double area = 0.0;
    for (const auto& [a, b, c] : triangles) {
      const Eigen::Vector3d area_vector = 0.5 * (b - a).cross(c - a);
      dipole.area_vector += area_vector;
      dipole.center += area_vector.norm() / 3.0 * (a + b + c);
      area += area_vector.norm();
    }
    dipole.center = area > 0.0 ? Eigen::Vector3d(dipole.center / area) : triangles.front()[0];
    for (const Tree::Corners& corners : triangles) {
      for (const Eigen::Vector3d& corner : corners) {
        dipole.radius = std::max(dipole.radius, (corner - dipole.center).norm());
      }
    }
  }
}

double WindingNumber::at(const Eigen::Vector3d& p) const {
  constexpr std::size_t k_max_depth = 64;  // of the tree
  double angle = 0.0;
  std::array<std::uint32_t, k_max_depth * Tree::k_width> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t index = stack[--size];
    const Dipole& dipole = dipoles_[index];
    const Eigen::Vector3d offset = dipole.center - p;
    const double distance = offset.norm();
    if (distance > k_far_ratio * dipole.radius) {
      angle += dipole.area_vector.dot(offset) / (distance * distance * distance);
      continue;
    }
    const Tree::Node& node = tree_->nodes()[index];
    for (std::size_t i = 0; i < node.child_count; ++i) {
      const Tree::Child child = node.child[i];
      if (!child.is_leaf()) {
        stack[size++] = child.node();
        continue;
      }
      for (const Tree::Corners& corners : tree_->corners().subspan(child.first(), child.count())) {
        angle += solid_angle(corners, p);
      }
    }
  }
  return angle / (4.0 * std::numbers::pi);
}

SurfaceVoxels::SurfaceVoxels(const Mesh& mesh, const VoxelGrid& grid)
    : grid_(grid), words_per_row_((static_cast<std::size_t>(grid.voxels().x()) + k_word - 1) / k_word) {
  bits_.assign(grid_.row(0, grid_.voxels().z()) * words_per_row_, 0);
  const auto mark = [this](int x, int y, int z) {
    const auto column = static_cast<std::size_t>(x);
    std::uint64_t& word = bits_[grid_.row(y, z) * words_per_row_ + column / k_word];
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
  UnionFind sets(runs_.size());
  const auto join = [&](std::size_t r, std::size_t s) {
    for (std::size_t i = first_[r], j = first_[s]; i < first_[r + 1] && j < first_[s + 1];) {
      if (runs_[i].begin < runs_[j].end && runs_[j].begin < runs_[i].end) {
        // The smaller index becomes the root: roots do not depend on the order of the joins.
        const auto [low, high] =
            std::minmax({sets.find(static_cast<std::uint32_t>(i)), sets.find(static_cast<std::uint32_t>(j))});
        sets.join(high, low);
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
      const std::uint32_t root = sets.find(static_cast<std::uint32_t>(i));
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

DistanceTransform::DistanceTransform(const SurfaceVoxels& surface) : n_(surface.grid().voxels()) {
  const auto nx = static_cast<std::size_t>(n_.x()), ny = static_cast<std::size_t>(n_.y());
  along_z_.resize(nx * ny * static_cast<std::size_t>(n_.z()));
  parallel::for_each(ny, [&](std::size_t row) {
    const auto y = static_cast<int>(row);
    const auto line = [&](int z) { return along_z_.data() + (static_cast<std::size_t>(z) * ny + row) * nx; };
    const auto sweep = [&](int z, const std::uint16_t* previous) {
      std::uint16_t* const here = line(z);
      for (std::size_t x = 0; x < nx; ++x) {
        const auto next = static_cast<std::uint16_t>(previous[x] == k_none ? k_none : previous[x] + 1);
        here[x] = std::min(here[x], next);
      }
    };
    for (int z = 0; z < n_.z(); ++z) {
      const std::span<const std::uint64_t> bits = surface.row(y, z);
      std::uint16_t* const here = line(z);
      for (std::size_t x = 0; x < nx; ++x) here[x] = (bits[x / 64] >> (x % 64) & 1u) != 0 ? 0 : k_none;
      if (z > 0) sweep(z, line(z - 1));
    }
    for (int z = n_.z() - 2; z >= 0; --z) sweep(z, line(z + 1));
  });
}

void DistanceTransform::slice(int z, Scratch& scratch, std::vector<std::int32_t>& squared) const {
  const auto nx = static_cast<std::size_t>(n_.x()), ny = static_cast<std::size_t>(n_.y());
  const std::size_t longest = std::max(nx, ny);
  for (auto* buffer : {&scratch.values, &scratch.centers, &scratch.bounds, &scratch.output}) buffer->resize(longest);
  squared.resize(nx * ny);
  const std::uint16_t* const g = along_z_.data() + static_cast<std::size_t>(z) * nx * ny;
  for (std::size_t x = 0; x < nx; ++x) {
    for (std::size_t y = 0; y < ny; ++y) {
      const std::int32_t distance = g[y * nx + x];
      scratch.values[y] = distance == k_none ? k_infinite : distance * distance;
    }
    lower_envelope(n_.y(), scratch);
    for (std::size_t y = 0; y < ny; ++y) squared[y * nx + x] = scratch.output[y];
  }
  for (std::size_t y = 0; y < ny; ++y) {
    const auto row = squared.begin() + static_cast<std::ptrdiff_t>(y * nx);
    std::copy_n(row, nx, scratch.values.begin());
    lower_envelope(n_.x(), scratch);
    std::copy_n(scratch.output.begin(), nx, row);
  }
}

}  // namespace sixdof::vps
