#include <sixdof/repair/steps.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>

namespace sixdof::repairing {
namespace {

using Loop = std::vector<std::uint32_t>;  ///< Vertices; triangles to fill it are counter-clockwise as the loop is.

/// Directed edges that the missing triangles would have, by their start.
class OpenEdges {
 public:
  OpenEdges(const RawMesh& surface, const std::vector<Side>& border) : surface_(surface) {
    for (const Side& side : border) {
      next_[end_of(side)].push_back(start_of(side));
      for (const std::uint32_t v : {side.low, side.high}) {
        normals_.try_emplace(v, Eigen::Vector3d::Zero()).first->second +=
            surface.normal(surface.triangles[side.triangle()]).normalized();
      }
    }
  }

  /// Takes loops out of the edges. Edges that are in none (where triangles disagree) are left out.
  std::vector<Loop> loops() {
    std::vector<Loop> found;
    std::vector<std::uint8_t> on_path(surface_.vertices.size(), 0);
    while (!next_.empty()) {
      Loop path{next_.begin()->first};
      on_path[path[0]] = 1;
      while (!path.empty()) {
        const std::optional<std::uint32_t> v = take_next(path);
        if (!v) {
          on_path[path.back()] = 0;
          path.pop_back();
        } else if (on_path[*v] == 0) {
          on_path[*v] = 1;
          path.push_back(*v);
        } else {
          Loop& loop = found.emplace_back();
          for (; path.back() != *v; path.pop_back()) {
            on_path[path.back()] = 0;
            loop.push_back(path.back());
          }
          loop.push_back(*v);
          std::reverse(loop.begin(), loop.end());
        }
      }
    }
    return found;
  }

 private:
  /// Removes and gives an edge from the end of the path: where holes touch in a vertex, the one that turns least away
  /// from the hole's inside, which lies to the left.
  std::optional<std::uint32_t> take_next(const Loop& path) {
    const auto edges = next_.find(path.back());
    if (edges == next_.end()) return std::nullopt;
    std::vector<std::uint32_t>& ends = edges->second;
    auto best = ends.begin();
    if (ends.size() > 1 && path.size() > 1) {
      best = std::min_element(ends.begin(), ends.end(), [&](std::uint32_t a, std::uint32_t b) {
        return inner_angle(path, a) < inner_angle(path, b);
      });
    }
    const std::uint32_t v = *best;
    ends.erase(best);
    if (ends.empty()) next_.erase(edges);
    return v;
  }

  /// Angle of the hole at the end of the path if it goes on to `v`: counter-clockwise from there to where it came from.
  double inner_angle(const Loop& path, std::uint32_t v) const {
    const Eigen::Vector3d& at = surface_.vertices[path.back()];
    const Eigen::Vector3d normal = normals_.at(path.back()).normalized();
    const auto flat = [&](std::uint32_t w) -> Eigen::Vector3d {
      const Eigen::Vector3d d = surface_.vertices[w] - at;
      return d - d.dot(normal) * normal;
    };
    const Eigen::Vector3d out = flat(v), back = flat(path[path.size() - 2]);
    const double angle = std::atan2(out.cross(back).dot(normal), out.dot(back));
    return angle > 0.0 ? angle : angle + 2.0 * std::numbers::pi;
  }

  const RawMesh& surface_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> next_;
  std::map<std::uint32_t, Eigen::Vector3d> normals_;  ///< Sums over border triangles.
};

/// Cost of a triangulation: first the number of degenerate triangles, then the area.
struct Cost {
  std::size_t degenerate = 0;
  double area = 0.0;

  bool operator<(const Cost& other) const {
    return degenerate != other.degenerate ? degenerate < other.degenerate : area < other.area;
  }
  Cost operator+(const Cost& other) const { return {degenerate + other.degenerate, area + other.area}; }
};
constexpr Cost k_impossible{std::numeric_limits<std::size_t>::max() / 4, 0.0};

class Filling {
 public:
  using Edges = std::set<std::pair<std::uint32_t, std::uint32_t>>;

  /// @param taken tells whether an edge exists
  template <class Taken>
  Filling(const RawMesh& surface, const Loop& loop, const Taken& taken) : loop_(loop), n_(loop.size()) {
    cost_.assign(n_ * n_, Cost{});
    middle_.assign(n_ * n_, 0);
    for (std::size_t span = 2; span < n_; ++span) {
      for (std::size_t i = 0; i + span < n_; ++i) {
        const std::size_t j = i + span;
        Cost& best = cost_[i * n_ + j] = k_impossible;
        if (span + 1 < n_ && taken(loop[i], loop[j])) continue;
        for (std::size_t k = i + 1; k < j; ++k) {
          const Cost cost = cost_[i * n_ + k] + cost_[k * n_ + j] + cost_of(surface, i, k, j);
          if (!(cost < best)) continue;
          best = cost;
          middle_[i * n_ + j] = k;
        }
      }
    }
  }

  bool possible() const { return total() < k_impossible; }
  double area() const { return total().area; }

  std::vector<Triangle> triangles() const {
    std::vector<Triangle> result;
    const auto add = [&](auto&& self, std::size_t i, std::size_t j) -> void {
      if (j < i + 2) return;
      const std::size_t k = middle_[i * n_ + j];
      result.push_back({loop_[i], loop_[k], loop_[j]});
      self(self, i, k);
      self(self, k, j);
    };
    add(add, 0, n_ - 1);
    return result;
  }

 private:
  const Cost& total() const { return cost_[n_ - 1]; }

  Cost cost_of(const RawMesh& surface, std::size_t i, std::size_t k, std::size_t j) const {
    const Triangle t{loop_[i], loop_[k], loop_[j]};
    return {is_degenerate(surface, t) ? std::size_t{1} : 0, 0.5 * surface.normal(t).norm()};
  }

  const Loop& loop_;
  const std::size_t n_;
  std::vector<Cost> cost_;           ///< [i * n + j]: of the part of the loop from i to j.
  std::vector<std::size_t> middle_;  ///< The third corner of the triangle at its edge from i to j.
};

/// Area of what edges connect to each triangle.
std::vector<double> connected_areas(const RawMesh& surface, const std::vector<Side>& sides) {
  UnionFind connected(surface.triangles.size());
  for_each_edge(sides, [&](std::span<const Side> edge) {
    for (const Side& side : edge.subspan(1)) connected.join(side.triangle(), edge[0].triangle());
  });
  std::vector<double> of_root(surface.triangles.size(), 0.0), areas(surface.triangles.size());
  for (std::uint32_t t = 0; t < areas.size(); ++t) {
    of_root[connected.find(t)] += 0.5 * surface.normal(surface.triangles[t]).norm();
  }
  for (std::uint32_t t = 0; t < areas.size(); ++t) areas[t] = of_root[connected.find(t)];
  return areas;
}

}  // namespace

std::size_t fill_holes(RawMesh& surface, std::size_t max_edges, RepairLog& log) {
  const std::vector<Side> sides = sorted_sides(surface.triangles);
  const std::vector<Side> border = border_sides(sides);
  if (border.empty() || max_edges == 0) return 0;
  const std::vector<double> areas = connected_areas(surface, sides);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> at_border;  // open edge -> its triangle
  for (const Side& side : border) at_border[{end_of(side), start_of(side)}] = side.triangle();

  Filling::Edges added;
  const auto taken = [&](std::uint32_t a, std::uint32_t b) {
    const auto [low, high] = std::minmax(a, b);
    const auto before = [](const Side& x, const std::pair<std::uint32_t, std::uint32_t>& y) {
      return std::pair(x.low, x.high) < y;
    };
    const auto at = std::lower_bound(sides.begin(), sides.end(), std::pair(low, high), before);
    return (at != sides.end() && at->low == low && at->high == high) || added.contains({low, high});
  };
  std::size_t filled = 0;
  for (const Loop& loop : OpenEdges(surface, border).loops()) {
    if (loop.size() < 3 || loop.size() > max_edges) continue;
    const Filling filling(surface, loop, taken);
    const double area = areas[at_border.at({loop[0], loop[1]})];
    if (!filling.possible() || filling.area() > k_largest_hole * area) continue;
    for (const Triangle& t : filling.triangles()) {
      surface.triangles.push_back(t);
      for (std::size_t k = 0; k < 3; ++k) added.insert(std::minmax(t[k], t[(k + 1) % 3]));
    }
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const std::uint32_t v : loop) middle += surface.vertices[v] / static_cast<double>(loop.size());
    log.add(RepairKind::filled_holes, middle);
    ++filled;
  }
  return filled;
}

}  // namespace sixdof::repairing
