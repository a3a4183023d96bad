#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// One side of a triangle: an undirected edge and the direction in which the triangle uses it.
struct Side {
  std::uint32_t low, high;  ///< Vertices of the edge.
  std::uint32_t corner;     ///< 3 * triangle + k: the side from corner k to corner k + 1.
  bool forward;             ///< From low to high.

  std::uint32_t triangle() const { return corner / 3; }
};

inline std::uint32_t next_corner(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
inline std::uint32_t previous_corner(std::uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

/// All sides, by edge and then by corner. Time and memory grow with the largest vertex index, too.
std::vector<Side> sorted_sides(std::span<const Triangle> triangles);

/// visit(the sides of one edge) for every edge, in the order of sorted_sides().
template <class Visit>
void for_each_edge(std::span<const Side> sorted, const Visit& visit) {
  for (std::size_t begin = 0; begin < sorted.size();) {
    std::size_t end = begin + 1;
    while (end < sorted.size() && sorted[end].low == sorted[begin].low && sorted[end].high == sorted[begin].high) ++end;
    visit(sorted.subspan(begin, end - begin));
    begin = end;
  }
}

/// Disjoint sets of 0 .. n - 1.
class UnionFind {
 public:
  explicit UnionFind(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t i, std::uint32_t j) { parent_[find(i)] = find(j); }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace sixdof
