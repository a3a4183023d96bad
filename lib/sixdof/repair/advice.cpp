#include <sixdof/repair/advice.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include <sixdof/base/error.h>
#include <sixdof/geometry/sides.h>
#include <sixdof/repair/neighbours.h>
#include <sixdof/repair/steps.h>

namespace sixdof {
namespace {

/// Border vertices around the middle of a border edge at which the nearest other edge is looked for.
constexpr std::size_t k_around = 8;

/// Above them vertices are joined that someone may have modelled as two.
constexpr double k_welds[] = {3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3};
constexpr std::size_t k_holes[] = {128, RepairOptions::k_largest_max_hole};

RepairAttempt attempt(const Mesh& mesh, const RepairOptions& options) {
  try {
    const RepairedMesh repaired = repair_mesh(mesh, options);
    return {options, repaired.mesh.topology().border_edges, repaired.mesh.solid()};
  } catch (const BadMesh&) {  // the tolerance leaves no triangle
    return {options, mesh.topology().border_edges, false};
  }
}

}  // namespace

std::optional<RepairGaps> measure_gaps(const Mesh& mesh) {
  const std::vector<Eigen::Vector3d>& vertices = mesh.vertices();
  const std::vector<Side> border = repairing::border_sides(sorted_sides(mesh.triangles()));
  std::map<std::uint32_t, std::vector<std::uint32_t>> next;  // by border vertex: the other ends of its border edges
  for (const Side& side : border) {
    next[side.low].push_back(side.high);
    next[side.high].push_back(side.low);
  }
  std::vector<std::uint32_t> ends;
  for (const auto& entry : next) ends.push_back(entry.first);
  if (ends.empty()) return std::nullopt;
  const repairing::Neighbours neighbours(vertices, std::move(ends));
  std::vector<double> gaps;
  for (const Side& side : border) {
    const Eigen::Vector3d middle = 0.5 * (vertices[side.low] + vertices[side.high]);
    std::vector<std::uint32_t> around = neighbours.nearest(middle, k_around);
    around.insert(around.end(), {side.low, side.high});
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t n : around) {
      for (const std::uint32_t m : next.at(n)) {
        if (std::min(n, m) == side.low && std::max(n, m) == side.high) continue;
        least = std::min(least, repairing::Segment{vertices[n], vertices[m]}.distance(middle));
      }
    }
    if (std::isfinite(least)) gaps.push_back(least / mesh.diagonal());
  }
  if (gaps.empty()) return std::nullopt;
  std::ranges::sort(gaps);
  return RepairGaps{.edges = gaps.size(), .median = gaps[gaps.size() / 2], .largest = gaps.back()};
}

std::vector<RepairAttempt> try_other_repairs(const Mesh& mesh, const RepairOptions& tried) {
  std::vector<RepairAttempt> attempts{attempt(mesh, tried)};
  for (const double weld : k_welds) {
    if (weld <= tried.weld) continue;
    attempts.push_back(attempt(mesh, {.weld = weld, .max_hole = tried.max_hole, .max_fin = tried.max_fin}));
    if (attempts.back().solid) return attempts;
  }
  // With the smallest tolerance that leaves the fewest open edges.
  const RepairOptions best = std::ranges::min_element(attempts, {}, &RepairAttempt::border_edges)->options;
  for (const std::size_t hole : k_holes) {
    if (hole <= tried.max_hole) continue;
    attempts.push_back(attempt(mesh, {.weld = best.weld, .max_hole = hole, .max_fin = best.max_fin}));
    if (attempts.back().solid) return attempts;
  }
  return attempts;
}

}  // namespace sixdof
