#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/tree.h>

namespace sixdof {

/// Behind a reason why a mesh is no solid.
inline constexpr const char* k_repair_hint = "; `sixdof repair IN -o OUT` may mend it";

/// A closed mesh prepared for overlap queries: potentials by which the part of the surface inside a closed curve is
/// integrated from the curve alone.
///
/// **Idea.** By the divergence theorem a volume is a flux through its surface. On a closed surface a flux has a
/// potential except for its total: give every directed edge h a number alpha(h) = -alpha(twin of h) such that the three
/// numbers around every triangle sum to its flux, except at one triangle per connected piece, the pole, whose sum lacks
/// the piece's total flux. Then (Stokes) the flux through any region of triangles is the sum of alpha along its border,
/// plus the piece's total if the pole lies inside. No triangle of the interior is visited, so a query's cost depends on
/// the length of the curve in which two surfaces intersect, not on how much surface lies inside.
///
/// **Numbers.** alpha is the flux through the subtree beyond the edge in a spanning tree of the triangles. It may be as
/// large as the whole flux where the answer is tiny, so potentials are 128-bit integers (fixed point): sums of them are
/// exact. There are four fluxes: that of (p - m) / 3, which gives the volume, and the three components of
/// |p - m|^2 n / 2, which give the first moment; m is the tree's centre.
///
/// **Curves between vertices.** Curves are deformed to run through vertices: each crossing of a side moves to the
/// side's vertex of lowest index. The two sides at the triangle's lowest vertex need no more; for a crossing of the
/// opposite side the deformed curve runs along the triangle's side from the lowest to the middle index. So one
/// potential per triangle, that of this side, is stored. No curve runs through a triangle's corner of highest index:
/// there the pole is.
///
/// Memory: 66 bytes per triangle, besides the tree's. Preparation: linear, but for sorting.
class Solid {
 public:
  /// A flux in fixed point.
  using Integer = __int128;

  /// Fluxes through a piece of surface, about some origin: volume and first moment of what the piece spans.
  struct Moments {
    double volume = 0.0;                              ///< Integral of p . n / 3 (length^3).
    Eigen::Vector3d first = Eigen::Vector3d::Zero();  ///< Integral of |p|^2 n / 2 (length^4).
  };

  /// One potential for each of the four fluxes.
  struct alignas(64) Potential {
    Integer volume = 0;              ///< That of the volume.
    std::array<Integer, 3> first{};  ///< Those of the first moment.

    /// Adds to each of the four.
    void add(const Potential& x) {
      volume += x.volume;
      for (std::size_t k = 0; k < 3; ++k) first[k] += x.first[k];
    }
    /// Adds `factor` times.
    void add(const Potential& x, int factor) {
      volume += factor * x.volume;
      for (std::size_t k = 0; k < 3; ++k) first[k] += factor * x.first[k];
    }
  };

  /// Connected piece of the surface (through edges).
  struct Piece {
    Eigen::Vector3d pole = Eigen::Vector3d::Zero();  ///< A vertex, in the mesh's frame.
    Potential total;                                 ///< Its whole flux, see to_moments().
  };

  /// How a triangle's corners are ordered by vertex index.
  struct Order {
    std::uint8_t lowest : 2;  ///< Corner of lowest index.
    bool rises : 1;           ///< The corner after it has a lower index than the one after that.

    /// The corner whose vertex index is neither the lowest nor the highest.
    std::size_t middle() const { return k_remainder[lowest + (rises ? 1u : 2u)]; }
    /// Number of the side opposite the lowest corner; side k runs from corner k to the next.
    std::size_t opposite_side() const { return k_remainder[lowest + 1u]; }

   private:
    static constexpr std::uint8_t k_remainder[] = {0, 1, 2, 0, 1};  // of a division by 3
  };

  /// @param mesh the tree's mesh; both outlive this object.
  /// @throws BadMesh with Mesh::why_not_solid() and k_repair_hint if the mesh is open or not consistently oriented, and
  /// if a coordinate lies outside the range of the exact predicates.
  Solid(const Mesh& mesh, const Tree& tree);

  /// The mesh, in its own frame.
  const Mesh& mesh() const { return *mesh_; }
  /// The tree of the mesh.
  const Tree& tree() const { return *tree_; }
  /// Connected pieces of the surface.
  std::span<const Piece> pieces() const { return pieces_; }

  /// Potential of the side from lowest to middle index, per triangle in tree order.
  const Potential& potential(std::uint32_t triangle) const { return potentials_[triangle]; }
  /// Order of the corners, per triangle in tree order.
  const Order& order(std::uint32_t triangle) const { return orders_[triangle]; }

  /// A sum of potentials as fluxes about Tree::center().
  Moments to_moments(const Potential& sum) const;

  /// Memory, without the mesh and the tree.
  std::size_t bytes() const;

 private:
  /// Flux through each triangle of the mesh; sets the exponents.
  std::vector<Potential> triangle_fluxes();

  const Mesh* mesh_;
  const Tree* tree_;
  std::vector<Potential> potentials_;
  std::vector<Order> orders_;
  std::vector<Piece> pieces_;
  int volume_exponent_ = 0;  ///< Fixed point: integer = flux * 2^exponent.
  int first_exponent_ = 0;
};

/// Fluxes through the plane triangle a, b, c (corners relative to the origin of the moments), positive where the
/// origin is behind it.
inline Solid::Moments triangle_moments(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d area = 0.5 * (b - a).cross(c - a);
  const Eigen::Vector3d sum = a + b + c;
  // Mean of |p|^2 over a triangle: (|a|^2 + |b|^2 + |c|^2 + |a + b + c|^2) / 12.
  const double mean = (a.squaredNorm() + b.squaredNorm() + c.squaredNorm() + sum.squaredNorm()) / 12.0;
  return {a.dot(area) / 3.0, 0.5 * mean * area};
}

}  // namespace sixdof
