#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include <sixdof/geometry/tree.h>
#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/oracle/ray_cast_search.h>
#include <sixdof/proximity/close_search.h>

namespace sixdof::test {

/// The triangles of a volume, in tree order: first and count.
/// @param volume numbered as in detail::CloseVolume
inline std::pair<std::uint32_t, std::uint32_t> triangles_of(const Tree& tree, std::uint32_t volume) {
  if (volume >= detail::CloseVolume::k_leaf) {
    const Tree::Child leaf = tree.leaves()[volume - detail::CloseVolume::k_leaf].child;
    return {leaf.first(), leaf.count()};
  }
  const Tree::Node& node = tree.nodes()[volume];
  return {node.first_triangle, node.triangle_count};
}

/// The least distance of the triangles of two volumes, B's translated by t u.
inline double least_distance(const ray_cast::Cast& cast, std::uint32_t a, std::uint32_t b, double t) {
  const auto [first_a, count_a] = triangles_of(cast.a.tree(), a);
  const auto [first_b, count_b] = triangles_of(cast.b.tree(), b);
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = first_a; i < first_a + count_a; ++i) {
    for (std::uint32_t j = first_b; j < first_b + count_b; ++j) {
      TriangleCorners moved = cast.b.triangle(j);
      for (Eigen::Vector3d& corner : moved) corner = cast.R * corner + t * cast.direction;
      least = std::min(least, triangle_triangle_distance(cast.a.triangle(i), moved).distance);
    }
  }
  return least;
}

}  // namespace sixdof::test
