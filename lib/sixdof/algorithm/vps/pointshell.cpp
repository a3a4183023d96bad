#include <sixdof/algorithm/vps/pointshell.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <sixdof/algorithm/require_solid.h>
#include <sixdof/algorithm/vps/grid.h>
#include <sixdof/algorithm/vps/point_cells.h>
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

/// A part of a triangle that is small enough to belong to one cell as a whole.
struct Piece {
  Eigen::Vector3d middle;
  double area;
  std::uint32_t triangle;
};

struct Point {
  Eigen::Vector3d position;
  Eigen::Vector3d outward;
};

class ShellBuilder {
 public:
  ShellBuilder(const Mesh& mesh, double spacing)
      : mesh_(mesh), spacing_(spacing), grid_(VoxelGrid::around(mesh.box(), spacing, 1)) {
    for (const Triangle& t : mesh.triangles()) {
      const Eigen::Vector3d &a = mesh.vertices()[t[0]], &b = mesh.vertices()[t[1]], &c = mesh.vertices()[t[2]];
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
      cut(a, b, c, 0.5 * (b - a).cross(c - a).norm(), t);
    }
  }

  /// Halves the longest edge until it is short: slivers are cut along their length only.
  void cut(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, double area, std::uint32_t t) {
    const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
    // Of edges that differ by rounding only the first is halved, so that rotated or translated meshes are cut alike.
    constexpr double k_longer = 1.0 + 1e-9;
    double longest = ab;
    if (bc > k_longer * longest) longest = bc;
    if (ca > k_longer * longest) longest = ca;
    if (longest <= k_piece * k_piece * spacing_ * spacing_) {
      pieces_.push_back({(a + b + c) / 3.0, area, t});
    } else if (longest == ab) {
      const Eigen::Vector3d m = 0.5 * (a + b);
      cut(a, m, c, 0.5 * area, t);
      cut(m, b, c, 0.5 * area, t);
    } else if (longest == bc) {
      const Eigen::Vector3d m = 0.5 * (b + c);
      cut(a, b, m, 0.5 * area, t);
      cut(a, m, c, 0.5 * area, t);
    } else {
      const Eigen::Vector3d m = 0.5 * (c + a);
      cut(a, b, m, 0.5 * area, t);
      cut(m, b, c, 0.5 * area, t);
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
    std::vector<Eigen::Vector3d> positions;
    positions.reserve(candidates.size());
    for (const Point& candidate : candidates) positions.push_back(candidate.position);
    const PointCells cells(grid_, positions);
    const double min_squared = k_thinning * k_thinning * spacing_ * spacing_;
    std::vector<bool> kept(candidates.size(), false);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      bool free = true;
      cells.for_each_near(positions[i], 1, [&](std::uint32_t j) {
        free = free && !(kept[j] && (positions[j] - positions[i]).squaredNorm() < min_squared &&
                         candidates[j].outward.dot(candidates[i].outward) > PointShell::k_same_side);
      });
      if (!free) continue;
      kept[i] = true;
      points_.push_back(candidates[i]);
    }
  }

  /// Assigns every piece to the nearest point with a similar normal; adds a point where there is none within two
  /// spacings.
  void assign() {
    owner_.assign(pieces_.size(), k_none);
    for (bool complete = false; !complete;) {
      std::vector<Eigen::Vector3d> positions;
      positions.reserve(points_.size());
      for (const Point& point : points_) positions.push_back(point.position);
      const PointCells cells(grid_, positions);
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

  /// Moves every point to the point of its cell's triangles that is nearest to the cell's centroid; drops points
  /// without a cell.
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
