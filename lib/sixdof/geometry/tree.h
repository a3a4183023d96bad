#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

namespace sixdof {

namespace tree_builder {
struct Subtree;
struct Surface;
}  // namespace tree_builder

/// Bounding-volume tree over the triangles of one mesh: shared by all queries and threads. Immutable but for refit()
/// and rebuild(), for meshes that deform.
///
/// A node holds the volumes of up to eight children as arrays over the children, for SIMD. A child's volume is the
/// intersection of an axis-aligned box with a slab along the mean normal of its triangles. On a smooth surface the
/// thickness of the slab shrinks with the square of the patch's size, that of the box linearly.
///
/// Volumes are floats relative to center(), rounded outwards: they contain the double-precision triangles at any
/// distance of the mesh from its origin. Triangles are stored in the order of the leaves, so that those of any subtree
/// are consecutive. Existing children fill the first lanes; the other lanes hold empty boxes (lower = k_empty, upper =
/// -k_empty). Leaves also hold their corners as floats, for tests that come before the exact ones.
///
/// Built by the surface-area heuristic; the same bits for every number of threads. A node takes 512
/// bytes, a leaf 192, a triangle 76; a row `prepare/algorithm:exact` reports a pair's bytes.
class Tree {
 public:
  static constexpr std::size_t k_width = 8;                 ///< Children per node, at most.
  static constexpr std::size_t k_leaf_triangles = 4;        ///< Triangles per leaf, at most.
  static constexpr std::uint32_t k_leaf_number = 1u << 31;  ///< What numbers of leaves begin with.
  static constexpr float k_empty = 1e30f;                   ///< Bound of the empty boxes in lanes without a child.

  /// Limits of the mesh's diagonal (length): squares and products of floats neither underflow nor overflow.
  static constexpr double k_smallest_diagonal = 1e-15;
  static constexpr double k_largest_diagonal = 1e15;

  /// What a lane refers to: a node, or a leaf's consecutive triangles.
  class Child {
   public:
    Child() = default;
    static Child node(std::uint32_t index) { return Child(index); }
    static Child leaf(std::uint32_t first, std::uint32_t count) { return Child(k_leaf | (count - 1) << 29 | first); }

    bool is_leaf() const { return (bits_ & k_leaf) != 0; }
    std::uint32_t node() const { return bits_; }                     ///< Index into nodes(); not for leaves.
    std::uint32_t first() const { return bits_ & k_first; }          ///< Leaf: its first triangle in tree order.
    std::uint32_t count() const { return ((bits_ >> 29) & 3) + 1; }  ///< Leaf: number of triangles, 1 to 4.

   private:
    explicit Child(std::uint32_t bits) : bits_(bits) {}
    static constexpr std::uint32_t k_leaf = 1u << 31;
    static constexpr std::uint32_t k_first = (1u << 29) - 1;
    std::uint32_t bits_ = 0;
  };

  /// The volume of one child.
  struct Volume {
    float lower[3];
    float upper[3];
    float normal[3];
    float slab_lower;
    float slab_upper;

    /// Of the box (length^2).
    float squared_diagonal() const {
      const float x = upper[0] - lower[0], y = upper[1] - lower[1], z = upper[2] - lower[2];
      return x * x + y * y + z * z;
    }
  };

  struct alignas(64) Node {
    float lower[3][k_width];  ///< Boxes, [axis][child], relative to center().
    float upper[3][k_width];
    float normal[3][k_width];   ///< Slabs: direction, of length 1 - 1e-6 .. 1.
    float slab_lower[k_width];  ///< Slabs: lower <= normal . (p - center) <= upper for every point p of the child.
    float slab_upper[k_width];
    Child child[k_width];
    /// Of the children: an index into nodes(), or k_leaf_number plus one into leaves().
    std::uint32_t number[k_width];
    Volume volume;                 ///< Of this node; the root's has normal zero and a slab from 0 to 0.
    std::uint32_t child_count;     ///< 1 .. 8 (1 only in the root of a mesh of up to four triangles).
    std::uint32_t first_triangle;  ///< The subtree's triangles in tree order: first_triangle + 0 .. triangle_count - 1.
    std::uint32_t triangle_count;

    /// Index into leaves() of a child that is a leaf.
    std::uint32_t leaf(std::size_t i) const { return number[i] - k_leaf_number; }
  };

  /// A leaf's corners, rounded to floats relative to center(); lanes beyond the count repeat the last triangle.
  struct alignas(64) Leaf {
    float corner[3][3][k_leaf_triangles];  ///< [corner][axis][triangle]
    Volume volume;
    Child child;
  };

  using Corners = std::array<Eigen::Vector3d, 3>;

  /// @throws BadMesh if the mesh has 2^29 triangles or more, or its diagonal is outside k_smallest_diagonal ..
  /// k_largest_diagonal.
  explicit Tree(const Mesh& mesh);

  /// Of the triangles of a mesh that deforms. @throws BadMesh likewise
  explicit Tree(const tree_builder::Surface& surface);

  /// Takes new places of the vertices: the triangles stay partitioned as they are, and all volumes contain them anew.
  /// Cost: linear, several times less than building. Slabs of nodes with more than k_exact_slab triangles are those of
  /// the boxes two levels below. While no query uses the tree.
  /// @param surface the same triangles as before
  /// @throws BadMesh as the constructor does; then nothing has changed
  void refit(const tree_builder::Surface& surface);
  static constexpr std::uint32_t k_exact_slab = 256;

  static constexpr std::uint32_t k_new = ~std::uint32_t{0};  ///< No node of before.
  /// Builds some subtrees anew, at the places of the vertices that refit() took. While no query uses the tree.
  /// @param parts their nodes, ascending, none below another, without the root
  /// @return of each node the one that it was before, or k_new
  std::vector<std::uint32_t> rebuild(const tree_builder::Surface& surface, std::span<const std::uint32_t> parts);

  /// Depth first, parents before children; the root is node 0.
  std::span<const Node> nodes() const { return nodes_; }

  /// In tree order.
  std::span<const Leaf> leaves() const { return leaves_; }

  /// Mesh triangle of each triangle in tree order: a permutation of 0 .. n-1.
  std::span<const std::uint32_t> mesh_triangle() const { return mesh_triangle_; }

  /// Corners of the triangles in tree order: the mesh's own coordinates, NOT relative to center().
  std::span<const Corners> corners() const { return corners_; }

  /// Origin of the volumes, in the mesh's frame: the centre of the mesh's box.
  const Eigen::Vector3d& center() const { return center_; }

  /// Largest distance of a vertex from center(), rounded up.
  double radius() const { return radius_; }

  std::size_t bytes() const;

 private:
  /// Sets centre and radius, and the corners of all triangles in tree order.
  void place(const tree_builder::Surface& surface);
  void place_corners(const tree_builder::Surface& surface);
  /// Appends the nodes of a subtree. @return the index of its root
  std::uint32_t store_nodes(const tree_builder::Subtree& subtree);
  void fit_slabs(Node& node) const;
  /// A child's slab. @param sum along its normal @param first, end its triangles
  void fit_slab(Node& node, std::size_t child, const Eigen::Vector3d& sum, std::uint32_t first,
                std::uint32_t end) const;
  /// Likewise, looser, from the boxes of the child's grandchildren. @pre it is a node, whose boxes are set
  void bound_slab(Node& node, std::size_t child, const Eigen::Vector3d& sum) const;
  void store_volumes();
  class Assembly;

  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
  std::vector<std::uint32_t> mesh_triangle_;
  std::vector<Corners> corners_;
  Eigen::Vector3d center_;
  double radius_ = 0.0;
};

/// A triangle of mesh A and one of mesh B: indices in the order of each mesh's Tree unless stated otherwise.
struct TrianglePair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

/// Area times normal of every triangle (length^2) in tree order, in the mesh's frame.
std::vector<Eigen::Vector3d> area_vectors(const Tree& tree);

}  // namespace sixdof
