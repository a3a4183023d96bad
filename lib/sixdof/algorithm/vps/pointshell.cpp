#include <sixdof/algorithm/vps/pointshell.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include <sixdof/algorithm/preparation.h>
#include <sixdof/algorithm/vps/grid.h>
#include <sixdof/algorithm/vps/triangle_voxels.h>
#include <sixdof/base/parallel.h>
#include <sixdof/geometry/closest_point.h>

namespace sixdof::vps {
namespace {

/// Smallest distance of two points with similar normals, in spacings. Below 1, so that on an axis-aligned face all
/// voxels keep their point; on a slanted face it leaves about one point per spacing^2, too.
constexpr double k_thinning = 0.75;
/// Longest edge of a piece, in spacings: about 14 pieces per cell.
constexpr double k_piece = 0.5;
/// Rounds of moving points to the middle of their cells; more hardly change the areas.
constexpr int k_relaxations = 2;
constexpr std::uint32_t k_none = std::numeric_limits<std::uint32_t>::max();

struct Point {
  Eigen::Vector3d position;
  Eigen::Vector3d outward;
};

/// Points sorted into the voxels of a grid, to find neighbours. Each row of voxels along x has a list sorted by x.
class PointCells {
 public:
  PointCells(const VoxelGrid& grid, const std::vector<Point>& points) : grid_(grid), n_(grid.voxels()) {
    std::vector<Eigen::Array3i> cells;
    cells.reserve(points.size());
    first_.assign(grid_.row(0, n_.z()) + 1, 0);
    for (const Point& point : points) {
      cells.push_back(cell_of(point.position));
      ++first_[grid_.row(cells.back().y(), cells.back().z()) + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    entries_.resize(points.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      entries_[next[grid_.row(cells[i].y(), cells[i].z())]++] = {cells[i].x(), i};
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
        const std::size_t row = grid_.row(y, z);
        const auto end = entries_.begin() + first_[row + 1];
        auto entry = std::lower_bound(entries_.begin() + first_[row], end, std::pair{low.x(), std::uint32_t{0}});
        for (; entry != end && entry->first <= high.x(); ++entry) callback(entry->second);
      }
    }
  }

 private:
  Eigen::Array3i cell_of(const Eigen::Vector3d& point) const {
    return grid_.coordinates(point).array().floor().cast<int>().max(0).min(n_ - 1);
  }

  VoxelGrid grid_;
  Eigen::Array3i n_;
  std::vector<std::uint32_t> first_;
  std::vector<std::pair<int, std::uint32_t>> entries_;  ///< x of the voxel, index of the point
};

/// A part of a triangle that is small enough to belong to one cell as a whole.
struct Piece {
  Eigen::Vector3d middle;
  double area;
  std::uint32_t triangle;
};

class ShellBuilder {
 public:
  ShellBuilder(const Mesh& mesh, double spacing)
      : mesh_(mesh), spacing_(spacing), grid_(VoxelGrid::around(mesh.box(), spacing, 1)) {
    for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
      const auto [a, b, c] = corners(t);
      const Eigen::Vector3d twice = (b - a).cross(c - a);
      const double norm = twice.norm();
      outward_.push_back(norm > 0.0 ? Eigen::Vector3d(twice / norm) : Eigen::Vector3d::Zero());
    }
  }

  PointShell build() {
    cut_pieces();
    thin_out(project_voxels());
    assign();
    for (int round = 0; round < k_relaxations; ++round) {
      relax();
      assign();
    }
    return finish();
  }

 private:
  std::array<Eigen::Vector3d, 3> corners(std::uint32_t t) const {
    const Triangle& v = mesh_.triangles()[t];
    return {mesh_.vertices()[v[0]], mesh_.vertices()[v[1]], mesh_.vertices()[v[2]]};
  }

  /// 0 .. 5: the axis, and its direction, that a normal is nearest to.
  static int facing(const Eigen::Vector3d& normal) {
    int axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    return 2 * axis + (normal[axis] < 0.0 ? 1 : 0);
  }

  void cut_pieces() {
    for (std::uint32_t t = 0; t < mesh_.triangles().size(); ++t) {
      if (outward_[t].isZero()) continue;
      const auto [a, b, c] = corners(t);
      cut({a, b, c}, 0.5 * (b - a).cross(c - a).norm(), t);
    }
  }

  /// Halves the longest edge until it is short: slivers are cut along their length only.
  void cut(const std::array<Eigen::Vector3d, 3>& corners, double area, std::uint32_t t) {
    constexpr std::size_t k_edges[3][2] = {{0, 1}, {1, 2}, {0, 2}};
    // Of edges that differ by rounding only the first is halved, so that rotated or translated meshes are cut alike.
    constexpr double k_longer = 1.0 + 1e-9;
    double longest = 0.0;
    std::size_t from = 0, to = 0;
    for (const auto& [i, j] : k_edges) {
      const double squared = (corners[j] - corners[i]).squaredNorm();
      if (squared <= k_longer * longest) continue;
      longest = squared;
      from = i;
      to = j;
    }
    if (longest <= k_piece * k_piece * spacing_ * spacing_) {
      pieces_.push_back({(corners[0] + corners[1] + corners[2]) / 3.0, area, t});
      return;
    }
    const Eigen::Vector3d middle = 0.5 * (corners[from] + corners[to]);
    for (const std::size_t replaced : {to, from}) {
      std::array<Eigen::Vector3d, 3> half = corners;
      half[replaced] = middle;
      cut(half, 0.5 * area, t);
    }
  }

  /// For every surface voxel and every direction (see facing()) of its triangles, the point of these triangles that is
  /// closest to the voxel's centre; in the order of the voxels.
  std::vector<Point> project_voxels() const {
    struct Touch {
      std::uint64_t voxel;
      std::uint32_t triangle;
      auto operator<=>(const Touch&) const = default;
    };
    parallel::PerThread<std::vector<Touch>> found;
    const Eigen::Array<std::uint64_t, 3, 1> n = grid_.voxels().cast<std::uint64_t>();
    parallel::for_each(mesh_.triangles().size(), [&](std::size_t i) {
      const auto t = static_cast<std::uint32_t>(i);
      if (outward_[t].isZero()) return;
      std::array<Eigen::Vector3d, 3> in_voxels = corners(t);
      for (Eigen::Vector3d& corner : in_voxels) corner = grid_.coordinates(corner);
      std::vector<Touch>& mine = found.local();
      for_each_touched_voxel(SeparatingAxes(in_voxels), false, [&](int x, int y, int z) {
        const auto row = static_cast<std::uint64_t>(z) * n.y() + static_cast<std::uint64_t>(y);
        mine.push_back({row * n.x() + static_cast<std::uint64_t>(x), t});
      });
    });
    std::vector<Touch> touches;
    for (const std::vector<Touch>& part : found) touches.insert(touches.end(), part.begin(), part.end());
    parallel::sort(touches);

    std::vector<Point> candidates;
    for (std::size_t i = 0; i < touches.size();) {
      const std::uint64_t voxel = touches[i].voxel;
      const Eigen::Vector3d center =
          grid_.center(static_cast<int>(voxel % n.x()), static_cast<int>(voxel / n.x() % n.y()),
                       static_cast<int>(voxel / n.x() / n.y()));
      std::array<double, 6> nearest;
      nearest.fill(std::numeric_limits<double>::infinity());
      std::array<Point, 6> best;
      for (; i < touches.size() && touches[i].voxel == voxel; ++i) {
        const std::uint32_t t = touches[i].triangle;
        const Eigen::Vector3d point = closest_point_on_triangle(center, corners(t));
        const auto side = static_cast<std::size_t>(facing(outward_[t]));
        if (const double distance = (point - center).squaredNorm(); distance < nearest[side]) {
          nearest[side] = distance;
          best[side] = {point, outward_[t]};
        }
      }
      for (std::size_t side = 0; side < 6; ++side) {
        if (nearest[side] < std::numeric_limits<double>::infinity()) candidates.push_back(best[side]);
      }
    }
    return candidates;
  }

  /// Keeps the candidates, in their order, that are not too near to a kept one with a similar normal.
  void thin_out(const std::vector<Point>& candidates) {
    const PointCells cells(grid_, candidates);
    const double min_squared = k_thinning * k_thinning * spacing_ * spacing_;
    std::vector<bool> kept(candidates.size(), false);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      bool free = true;
      cells.for_each_near(candidates[i].position, 1, [&](std::uint32_t j) {
        free = free && !(kept[j] && (candidates[j].position - candidates[i].position).squaredNorm() < min_squared &&
                         candidates[j].outward.dot(candidates[i].outward) > PointShell::k_same_side);
      });
      if (!free) continue;
      kept[i] = true;
      points_.push_back(candidates[i]);
    }
  }

  /// Assigns every piece to the nearest point with a similar normal within two spacings; adds a point where there is
  /// none.
  void assign() {
    owner_.assign(pieces_.size(), k_none);
    for (bool complete = false; !complete;) {
      const PointCells cells(grid_, points_);
      parallel::for_each(pieces_.size(), [&](std::size_t i) { owner_[i] = nearest(cells, pieces_[i]); });
      complete = true;
      const std::size_t before = points_.size();
      for (std::size_t i = 0; i < pieces_.size(); ++i) {
        if (owner_[i] != k_none) continue;
        complete = false;
        const Eigen::Vector3d& outward = outward_[pieces_[i].triangle];
        const auto serves = [&](const Point& point) {
          return (point.position - pieces_[i].middle).norm() < spacing_ &&
                 point.outward.dot(outward) > PointShell::k_same_side;
        };
        if (std::none_of(points_.begin() + static_cast<std::ptrdiff_t>(before), points_.end(), serves)) {
          points_.push_back({pieces_[i].middle, outward});
        }
      }
    }
  }

  std::uint32_t nearest(const PointCells& cells, const Piece& piece) const {
    std::uint32_t best = k_none;
    double smallest = std::numeric_limits<double>::infinity();
    for (const int reach : {1, 2}) {
      cells.for_each_near(piece.middle, reach, [&](std::uint32_t j) {
        const double distance = (points_[j].position - piece.middle).squaredNorm();
        if (points_[j].outward.dot(outward_[piece.triangle]) <= PointShell::k_same_side) return;
        if (distance < smallest || (distance == smallest && j < best)) {
          smallest = distance;
          best = j;
        }
      });
      // All points nearer than `reach` spacings have been tested.
      if (smallest <= reach * reach * spacing_ * spacing_) break;
    }
    return best;
  }

  struct Cell {
    double area = 0.0;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();       ///< Integral of position over the area.
    Eigen::Vector3d area_vector = Eigen::Vector3d::Zero();  ///< Integral of the outward normal.
  };

  std::vector<Cell> measure() const {
    std::vector<Cell> cells(points_.size());
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      Cell& cell = cells[owner_[i]];
      cell.area += pieces_[i].area;
      cell.moment += pieces_[i].area * pieces_[i].middle;
      cell.area_vector += pieces_[i].area * outward_[pieces_[i].triangle];
    }
    return cells;
  }

  /// Moves every point to the triangle of its cell nearest to the cell's centroid; drops points without a cell.
  void relax() {
    const std::vector<Cell> cells = measure();
    std::vector<double> smallest(points_.size(), std::numeric_limits<double>::infinity());
    std::vector<std::uint32_t> triangle(points_.size(), k_none);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const std::uint32_t j = owner_[i];
      const double distance = (cells[j].moment / cells[j].area - pieces_[i].middle).squaredNorm();
      if (distance < smallest[j]) {
        smallest[j] = distance;
        triangle[j] = pieces_[i].triangle;
      }
    }
    std::vector<Point> moved;
    for (std::size_t j = 0; j < points_.size(); ++j) {
      if (triangle[j] == k_none) continue;
      moved.push_back({closest_point_on_triangle(cells[j].moment / cells[j].area, corners(triangle[j])),
                       direction(cells[j], points_[j])});
    }
    points_ = std::move(moved);
  }

  static Eigen::Vector3d direction(const Cell& cell, const Point& point) {
    const double norm = cell.area_vector.norm();
    return norm > 0.0 ? Eigen::Vector3d(cell.area_vector / norm) : point.outward;
  }

  PointShell finish() const {
    const std::vector<Cell> cells = measure();
    PointShell shell;
    for (std::size_t j = 0; j < points_.size(); ++j) {
      if (!(cells[j].area > 0.0)) continue;
      shell.points.push_back(points_[j].position);
      shell.normals.push_back(-direction(cells[j], points_[j]));
      shell.areas.push_back(cells[j].area);
    }
    return shell;
  }

  const Mesh& mesh_;
  double spacing_;
  VoxelGrid grid_;
  std::vector<Eigen::Vector3d> outward_;  ///< Unit normal per triangle, zero where the area is zero.
  std::vector<Piece> pieces_;
  std::vector<std::uint32_t> owner_;  ///< Point per piece.
  std::vector<Point> points_;
};

}  // namespace

PointShell PointShell::build(const Mesh& mesh, double spacing) {
  require_solid(mesh, "a pointshell");
  return ShellBuilder(mesh, spacing).build();
}

}  // namespace sixdof::vps
