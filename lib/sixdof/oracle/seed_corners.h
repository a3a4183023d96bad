#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <sixdof/geometry/tree.h>

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

/// Finds a corner that is closer to p than `best.squared`. Returns whether there is one. It need not be the closest:
/// squared distances that differ by about 32 times a leaf's area, or by the factor `tolerance`, count as equal. The
/// same corner on every instruction set.
/// @param p relative to the tree's centre
/// @param stack scratch
bool find_corner(const Tree& tree, const float (&p)[3], float tolerance, Corner& best,
                 std::vector<CornerVolume>& stack);

/// Inserts a pair or volume into stack[first], stack[first + 1], ..., which is sorted: the smallest `lower` is on top.
template <class T>
void push_sorted(std::vector<T>& stack, std::size_t first, const T& x) {
  std::size_t at = stack.size();
  stack.push_back(x);
  for (; at > first && stack[at - 1].lower < x.lower; --at) stack[at] = stack[at - 1];
  stack[at] = x;
}

}  // namespace sixdof::detail
