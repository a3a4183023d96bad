#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <sixdof/geometry/tree.h>

/// How the triangles of a mesh are partitioned into the nodes of a Tree: the first half of its construction.
///
/// A range of triangles is split in two again and again, always the part with the largest box, until a node has eight
/// children. Ranges are split at multiples of a block of triangles: a full leaf (4), a full node of leaves (32) or a
/// full node of such nodes (256). So nearly all leaves and most nodes are full. The surface-area heuristic chooses
/// among these splits. In ranges of up to 256 triangles it compares all of them. A larger range is split at the block
/// nearest to the best of 15 cuts along each axis, or at that cut itself where parts lie far from each other.
namespace sixdof::tree_builder {

/// Axis-aligned box in single precision, relative to the tree's centre; contains its triangles.
struct Box {
  std::array<float, 3> lower{Tree::k_empty, Tree::k_empty, Tree::k_empty};
  std::array<float, 3> upper{-Tree::k_empty, -Tree::k_empty, -Tree::k_empty};

  void add(const Box& other) {
    for (std::size_t k = 0; k < 3; ++k) {
      lower[k] = std::min(lower[k], other.lower[k]);
      upper[k] = std::max(upper[k], other.upper[k]);
    }
  }
  float half_area() const {
    const float x = upper[0] - lower[0];
    const float y = upper[1] - lower[1];
    const float z = upper[2] - lower[2];
    return x * y + y * z + z * x;
  }
};

/// Triangles first .. last - 1 in tree order.
struct Range {
  std::size_t first = 0;
  std::size_t last = 0;
  Box box;
  std::size_t count() const { return last - first; }
};

/// A node with all nodes below it.
struct Subtree {
  std::vector<Range> children;                  ///< In tree order.
  std::vector<std::unique_ptr<Subtree>> nodes;  ///< Of each child; null if it is a leaf.
  std::size_t total = 1;                        ///< Nodes in this subtree.
};

/// Strictly below x: also below any double that rounds to x in a difference.
inline float round_down(double x) {
  return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}
inline float round_up(double x) {
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

/// Corners of the triangles of a mesh.
struct Surface {
  std::span<const Eigen::Vector3d> vertices;
  std::span<const Triangle> triangles;
};

/// The same for every number of threads.
/// @param[in,out] mesh_triangle the triangles that are partitioned, as indices into surface.triangles, in ascending
/// order; afterwards in tree order
/// @param first is added to all Range::first and Range::last
std::unique_ptr<Subtree> build(const Surface& surface, const Eigen::Vector3d& center,
                               std::span<std::uint32_t> mesh_triangle, std::size_t first = 0);

}  // namespace sixdof::tree_builder
