#include <sixdof/geometry/sides.h>

#include <algorithm>
#include <limits>
#include <tuple>

namespace sixdof {

std::vector<Side> sorted_sides(std::span<const Triangle> triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = triangles[t][k];
      const std::uint32_t to = triangles[t][(k + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), 3 * t + k, from < to});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
  });
  return sides;
}

std::vector<std::uint32_t> find_twins(std::span<const Side> sorted) {
  std::vector<std::uint32_t> twins(sorted.size(), k_no_twin);
  for_each_edge(sorted, [&](std::span<const Side> edge) {
    if (edge.size() != 2) return;
    twins[edge[0].corner] = edge[1].corner;
    twins[edge[1].corner] = edge[0].corner;
  });
  return twins;
}

Shells find_shells(std::span<const Side> sorted, std::size_t triangle_count) {
  UnionFind connected(triangle_count);
  for_each_edge(sorted, [&](std::span<const Side> edge) {
    if (edge.size() == 2) connected.join(edge[0].triangle(), edge[1].triangle());
  });
  constexpr std::uint32_t k_unset = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(triangle_count, k_unset);
  Shells shells;
  shells.of_triangle.resize(triangle_count);
  for (std::uint32_t t = 0; t < triangle_count; ++t) {
    std::uint32_t& shell = number[connected.find(t)];
    if (shell == k_unset) {
      shell = static_cast<std::uint32_t>(shells.triangles.size());
      shells.triangles.emplace_back();
    }
    shells.of_triangle[t] = shell;
    shells.triangles[shell].push_back(t);
  }
  return shells;
}

}  // namespace sixdof
