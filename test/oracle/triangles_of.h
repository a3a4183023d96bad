#pragma once

#include <cstdint>
#include <utility>

#include <sixdof/geometry/tree.h>
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

}  // namespace sixdof::test
