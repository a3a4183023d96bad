#include <sixdof/oracle/shells.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>

#include <sixdof/geometry/sides.h>
#include <sixdof/oracle/winding.h>

namespace sixdof {
namespace {

/// The same for all triangles with the same corners in the same direction.
Triangle from_lowest(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

/// For each triangle, how many before it have the same corners and direction.
std::vector<std::uint32_t> copy_numbers(const std::vector<Triangle>& triangles) {
  std::vector<std::pair<Triangle, std::uint32_t>> sorted;
  sorted.reserve(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) sorted.emplace_back(from_lowest(triangles[i]), i);
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::uint32_t> numbers(triangles.size(), 0);
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first == sorted[i - 1].first) numbers[sorted[i].second] = numbers[sorted[i - 1].second] + 1;
  }
  return numbers;
}

double tetrahedron(const Mesh& mesh, const Triangle& t) {
  const auto corner = [&](std::size_t k) -> Eigen::Vector3d { return mesh.vertices()[t[k]] - mesh.center(); };
  return corner(0).dot(corner(1).cross(corner(2))) / 6.0;
}

}  // namespace

Shells find_shells(const Mesh& mesh) {
  const std::vector<Triangle>& triangles = mesh.triangles();
  const std::vector<std::uint32_t> copy = copy_numbers(triangles);
  const std::vector<Side> sides = sorted_sides(triangles);
  UnionFind connected(triangles.size());
  for_each_edge(sides, [&](std::span<const Side> edge) {
    for (std::size_t i = 1; i < edge.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (copy[edge[i].triangle()] == copy[edge[j].triangle()])
          connected.join(edge[i].triangle(), edge[j].triangle());
      }
    }
  });

  constexpr std::uint32_t k_unset = std::numeric_limits<std::uint32_t>::max();
  Shells shells;
  shells.of_triangle.resize(triangles.size());
  std::vector<std::uint32_t> shell_of_root(triangles.size(), k_unset);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    std::uint32_t& s = shell_of_root[connected.find(t)];
    if (s == k_unset) {
      s = static_cast<std::uint32_t>(shells.all.size());
      shells.all.push_back({.first_triangle = t, .closed = true, .doubled = copy[t] > 0});
    }
    shells.of_triangle[t] = s;
    ++shells.all[s].triangles;
    shells.all[s].volume += tetrahedron(mesh, triangles[t]);
  }

  std::map<std::uint32_t, int> balance;  // by shell, at one edge
  for_each_edge(sides, [&](std::span<const Side> edge) {
    balance.clear();
    for (const Side& side : edge) balance[shells.of_triangle[side.triangle()]] += side.forward ? 1 : -1;
    for (const auto& [s, sum] : balance) shells.all[s].closed = shells.all[s].closed && sum == 0;
  });
  return shells;
}

std::map<std::uint32_t, int> windings_of_groups(const Tree& tree, std::span<const std::uint32_t> group,
                                                const Eigen::Vector3d& p) {
  std::map<std::uint32_t, int> windings;
  std::vector<std::uint32_t> scratch;
  detail::for_each_winding_term(tree, p, scratch,
                                [&](std::uint32_t i, int n) { windings[group[tree.mesh_triangle()[i]]] += n; });
  std::erase_if(windings, [](const auto& entry) { return entry.second == 0; });
  return windings;
}

}  // namespace sixdof
