#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace sixdof {

using Triangle = std::array<std::uint32_t, 3>;  ///< Vertex indices, counter-clockwise seen from outside.

/// What the validating step changed or found, so that nothing is mended in silence.
struct MeshRepairs {
  std::size_t welded_vertices = 0;        ///< Vertices merged because all three coordinates are equal.
  std::size_t unreferenced_vertices = 0;  ///< Vertices that no triangle uses, dropped.
  std::size_t collapsed_triangles = 0;    ///< Triangles with a repeated vertex after welding, dropped.
  /// Triangles kept although their area is zero in double precision (three distinct but collinear vertices); indices
  /// into Mesh::triangles(). They are kept because the surface may need them to stay closed.
  std::vector<std::uint32_t> zero_area_triangles;
};

/// How the triangles are joined.
struct MeshTopology {
  bool closed = false;           ///< No edge has exactly one triangle, i.e. no border.
  bool manifold = false;         ///< No edge has more than two triangles, and around every vertex they form one fan.
  bool oriented = false;         ///< Every edge with two triangles is run through once in each direction.
  std::size_t border_edges = 0;  ///< Edges with one triangle.
  std::size_t nonmanifold_edges = 0;     ///< Edges with three or more triangles.
  std::size_t nonmanifold_vertices = 0;  ///< Vertices around which the triangles form more than one fan.
  std::size_t misoriented_edges = 0;     ///< Edges run through twice in the same direction.
  std::size_t edges = 0;
  std::size_t components = 0;  ///< Pieces connected through edges.
  /// V - E + F; for closed connected surfaces 2 - 2 * genus.
  std::int64_t euler_characteristic = 0;
};

/// A triangle mesh that has passed validation; immutable. Coordinates are in the mesh's own length unit and frame.
class Mesh {
 public:
  /// The one way to make a mesh. Welds vertices with exactly equal coordinates (+0 equals -0), drops unreferenced
  /// vertices and triangles that collapse, and records that in repairs(). Vertices keep the order of their first use in
  /// the input's vertex list, triangles their order.
  /// @param name shown in messages and tables: a file name or a model's name.
  /// @throws BadMesh if there is no triangle, a coordinate is not finite, an index is out of range, or the count passes
  /// 32 bits;
  ///         the message names the element.
  static Mesh build(std::vector<Eigen::Vector3d> vertices, std::vector<Triangle> triangles, std::string name = {});

  const std::string& name() const { return name_; }
  /// The same mesh under another name: `std::move(mesh).renamed("b")`.
  Mesh renamed(std::string name) && {
    name_ = std::move(name);
    return std::move(*this);
  }
  const std::vector<Eigen::Vector3d>& vertices() const { return vertices_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const MeshTopology& topology() const { return topology_; }
  const MeshRepairs& repairs() const { return repairs_; }

  const Eigen::AlignedBox3d& box() const { return box_; }     ///< Axis-aligned bounding box.
  Eigen::Vector3d center() const { return box_.center(); }    ///< Centre of box(), the anchor of the sphere method.
  double diagonal() const { return box_.diagonal().norm(); }  ///< Length of box()'s diagonal: the object's size.

  double area() const { return area_; }  ///< Sum of the triangles' areas.
  /// Signed volume by the divergence theorem, taken about box()'s centre. Positive if triangles face outwards. It is
  /// the volume of a body only where topology() is closed and oriented.
  double volume() const { return volume_; }
  /// Centre of mass of the enclosed body (same condition as volume()); the mean of the surface where volume() is zero.
  const Eigen::Vector3d& centroid() const { return centroid_; }

  /// True if the mesh bounds a body: closed, consistently oriented, facing outwards. Manifoldness is not needed: two
  /// bodies may touch in an edge.
  bool solid() const { return topology_.closed && topology_.oriented && volume_ > 0.0; }

  /// Why solid() is false, in words ("12 border edges"); empty if it is true.
  std::string why_not_solid() const;

  /// Content hash of the vertex and triangle arrays: 32 hexadecimal digits. Names play no part.
  const std::string& hash() const { return hash_; }

 private:
  Mesh() = default;
  std::string name_;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Triangle> triangles_;
  MeshTopology topology_;
  MeshRepairs repairs_;
  Eigen::AlignedBox3d box_;
  double area_ = 0.0;
  double volume_ = 0.0;
  Eigen::Vector3d centroid_ = Eigen::Vector3d::Zero();
  std::string hash_;
};

}  // namespace sixdof
