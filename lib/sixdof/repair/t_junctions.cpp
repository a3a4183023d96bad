#include <sixdof/repair/steps.h>

#include <algorithm>
#include <map>

#include <sixdof/repair/neighbours.h>

namespace sixdof::repairing {
namespace {

class Round {
 public:
  Round(RawMesh& surface, double tolerance, RepairLog& log)
      : surface_(surface),
        tolerance_(tolerance),
        log_(log),
        border_(border_sides(sorted_sides(surface.triangles))),
        neighbours_(surface.vertices, border_vertices()) {}

  /// Splits at most one side of every triangle. @return repairs made
  std::size_t run() {
    std::vector<std::uint8_t> gone(surface_.triangles.size(), 0);
    std::vector<Triangle> added;
    std::size_t made = 0;
    for (const Side& side : border_) {
      if (gone[side.triangle()] != 0) continue;
      const std::vector<std::uint32_t> on_side = vertices_on(side);
      if (on_side.empty() || !fan_out(side, on_side, added)) continue;
      gone[side.triangle()] = 1;
      for (const std::uint32_t v : on_side) log_.add(RepairKind::split_edges, surface_.vertices[v]);
      made += on_side.size();
    }
    erase_marked(surface_.triangles, gone);
    surface_.triangles.insert(surface_.triangles.end(), added.begin(), added.end());
    return made;
  }

 private:
  std::vector<std::uint32_t> border_vertices() {
    for (const Side& side : border_) {
      next_on_border_[side.low].push_back(side.high);
      next_on_border_[side.high].push_back(side.low);
    }
    std::vector<std::uint32_t> vertices;
    for (const auto& entry : next_on_border_) vertices.push_back(entry.first);
    return vertices;
  }

  /// Border vertices on a side, from its start to its end.
  std::vector<std::uint32_t> vertices_on(const Side& side) const {
    const Segment segment{surface_.vertices[start_of(side)], surface_.vertices[end_of(side)]};
    const std::uint32_t apex = apex_of(side, surface_.triangles);
    std::vector<std::pair<double, std::uint32_t>> found;
    const Eigen::Vector3d middle = 0.5 * (segment.from + segment.to);
    for (const std::uint32_t v : neighbours_.within(middle, 0.5 * segment.length() + tolerance_)) {
      const Eigen::Vector3d& p = surface_.vertices[v];
      if (v == apex || v == side.low || v == side.high || !segment.holds_inside(p, tolerance_)) continue;
      if (runs_along(v, segment)) found.emplace_back(segment.parameter(p), v);
    }
    std::sort(found.begin(), found.end());
    std::vector<std::uint32_t> vertices;
    for (const auto& entry : found) vertices.push_back(entry.second);
    return vertices;
  }

  /// Whether a border edge from `v` lies on the segment, or ends beyond it.
  bool runs_along(std::uint32_t v, const Segment& segment) const {
    const std::vector<std::uint32_t>& next = next_on_border_.at(v);
    return std::any_of(next.begin(), next.end(), [&](std::uint32_t n) {
      const Segment edge{surface_.vertices[v], surface_.vertices[n]};
      return segment.distance(edge.to) <= tolerance_ || edge.distance(segment.from) <= tolerance_ ||
             edge.distance(segment.to) <= tolerance_;
    });
  }

  /// Adds the parts of the side's triangle; false, and none, if one would face backwards.
  bool fan_out(const Side& side, const std::vector<std::uint32_t>& on_side, std::vector<Triangle>& added) const {
    const std::uint32_t apex = apex_of(side, surface_.triangles);
    const Eigen::Vector3d normal = surface_.normal(surface_.triangles[side.triangle()]);
    std::vector<Triangle> parts;
    std::uint32_t from = start_of(side);
    for (std::size_t i = 0; i <= on_side.size(); ++i) {
      const std::uint32_t to = i < on_side.size() ? on_side[i] : end_of(side);
      parts.push_back({from, to, apex});
      if (surface_.normal(parts.back()).dot(normal) <= 0.0) return false;
      from = to;
    }
    added.insert(added.end(), parts.begin(), parts.end());
    return true;
  }

  RawMesh& surface_;
  const double tolerance_;
  RepairLog& log_;
  const std::vector<Side> border_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> next_on_border_;
  const Neighbours neighbours_;
};

}  // namespace

std::size_t split_at_t_junctions(RawMesh& surface, double tolerance, RepairLog& log) {
  // A triangle has three sides; the parts of a side may meet further vertices, since they follow the first ones.
  constexpr int k_most_rounds = 16;
  std::size_t made = 0;
  for (int round = 0; round < k_most_rounds; ++round) {
    if (border_sides(sorted_sides(surface.triangles)).empty()) break;
    const std::size_t split = Round(surface, tolerance, log).run();
    if (split == 0) break;
    made += split;
  }
  return made;
}

}  // namespace sixdof::repairing
