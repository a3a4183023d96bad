#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <sixdof/geometry/tree.h>
#include <sixdof/proximity/sorted_stack.h>

/// Where searches of two trees may start. Internal: distance_search.h.
namespace sixdof::detail {

/// Corners spread over a surface.
struct SeedCorners {
  static constexpr std::size_t k_count = 64;
  explicit SeedCorners(const Tree& tree);
  alignas(64) float point[3][k_count];  ///< [axis][corner], relative to the tree's centre.
  std::uint32_t leaf[k_count];          ///< The corner is the first one of the first triangle of this leaf.
};

/// A corner of a tree and its squared distance from some point.
struct Corner {
  float squared;
  std::uint32_t leaf;
  std::uint32_t triangle;  ///< In the leaf.
  float point[3];          ///< Relative to the tree's centre.
};

inline std::uint32_t triangle_of(const Tree& tree, const Corner& corner) {
  return tree.leaves()[corner.leaf].child.first() + corner.triangle;
}

/// A node, or a leaf, and a lower bound on the squared distance of its corners from some point.
struct CornerVolume {
  Tree::Child child;
  std::uint32_t leaf;
  float lower;
};

/// How closely find_corner() looks.
struct CornerEffort {
  float tolerance = 1.0f;                             ///< Squared distances that differ by this factor count as equal,
  float leaf_areas = 32.0f;                           ///< and those that differ by so many times a leaf's area.
  int most_leaves = std::numeric_limits<int>::max();  ///< Nearer ones first, as far as a depth-first search finds them.
};

/// Finds a corner that is closer to p than `best.squared`. Returns whether there is one. The same corner on every
/// instruction set.
/// @param p relative to the tree's centre
/// @param stack scratch
bool find_corner(const Tree& tree, const float (&p)[3], const CornerEffort& effort, Corner& best,
                 std::vector<CornerVolume>& stack);

}  // namespace sixdof::detail
