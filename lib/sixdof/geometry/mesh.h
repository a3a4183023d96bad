#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <sixdof/geometry/forgiven.h>

namespace sixdof {

using Triangle = std::array<std::uint32_t, 3>;  ///< Vertex indices, counter-clockwise seen from outside.

/// What reading and validation changed or found, so that nothing is repaired in silence.
struct MeshRepairs {
  ForgivenKinds forgiven;                 ///< By reading the file.
  std::size_t welded_vertices = 0;        ///< Vertices merged because all three coordinates are equal.
  std::size_t unreferenced_vertices = 0;  ///< Vertices that no triangle uses, dropped.
  std::size_t collapsed_triangles = 0;    ///< Triangles with a repeated vertex after welding, dropped.
  /// Indices into Mesh::triangles() of triangles whose area is zero in double precision (three distinct but collinear
  /// vertices). They are kept because the surface may need them to stay closed.
  std::vector<std::uint32_t> zero_area_triangles;
  /// What else a reader of the file has to say, one line each: its unit and axes, what was left out.
  std::vector<std::string> notes;
};

/// How the triangles are connected.
struct MeshTopology {
  bool closed = false;           ///< No edge has exactly one triangle: there is no border.
  bool manifold = false;         ///< No edge has more than two triangles, and around every vertex they form one fan.
  bool oriented = false;         ///< The triangles of an edge use its two directions equally often, border edges aside.
  std::size_t border_edges = 0;  ///< Edges with one triangle.
  std::size_t nonmanifold_edges = 0;     ///< Edges with three or more triangles.
  std::size_t nonmanifold_vertices = 0;  ///< Vertices around which the triangles form more than one fan.
  std::size_t misoriented_edges = 0;     ///< Edges of two or more triangles that are not oriented.
  std::size_t edges = 0;                 ///< Of all kinds; two triangles that share one count it once.
  std::size_t components = 0;            ///< Parts connected through edges.
  /// V - E + F; for closed connected surfaces 2 - 2 * genus.
  std::int64_t euler_characteristic = 0;
};

/// Drops vertices that no triangle uses; the others keep their order. @return how many
std::size_t drop_unreferenced(std::vector<Eigen::Vector3d>& vertices, std::vector<Triangle>& triangles);

/// A triangle mesh that has passed validation; immutable. Coordinates are in the mesh's own length unit and frame.
class Mesh {
 public:
  /// Welds vertices with exactly equal coordinates (+0 equals -0), drops unreferenced vertices and triangles with a
  /// repeated vertex, and counts them in repairs(). Vertices and triangles keep their order; a welded vertex takes the
  /// number of the first equal one.
  /// @param name shown in messages and tables: a file name or a model's name.
  /// @param repairs what was repaired while a file was read; kept in repairs().
  /// @throws BadMesh if there is no triangle, a coordinate is not finite, an index is out of range, or 32-bit indices
  /// do not suffice; the message names the element.
  static Mesh build(std::vector<Eigen::Vector3d> vertices, std::vector<Triangle> triangles, std::string name = {},
                    MeshRepairs repairs = {});

  /// The same triangles on other vertices, as a body has after it was deformed. Topology and name are this mesh's;
  /// box, area, volume and hash are computed anew.
  /// @param vertices one for each of vertices(), in their order
  /// @throws BadMesh if there is another number of them, a coordinate is not finite, two of them are equal (build()
  /// would weld them), or the box is too large; the message names the element
  Mesh with_vertices(std::vector<Eigen::Vector3d> vertices) const;

  /// Shown in messages and tables: a file name or a model's name.
  const std::string& name() const { return name_; }
  /// The same mesh under another name: `std::move(mesh).renamed("b")`.
  Mesh renamed(std::string name) && {
    name_ = std::move(name);
    return std::move(*this);
  }
  /// [vertex], in the mesh's own frame and length unit; all finite, no two equal.
  const std::vector<Eigen::Vector3d>& vertices() const { return vertices_; }
  /// [triangle], each three different indices into vertices().
  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// How the triangles are connected.
  const MeshTopology& topology() const { return topology_; }
  /// What reading and build() changed or found.
  const MeshRepairs& repairs() const { return repairs_; }

  const Eigen::AlignedBox3d& box() const { return box_; }     ///< Axis-aligned bounding box.
  Eigen::Vector3d center() const { return box_.center(); }    ///< Centre of box(), the anchor of the sphere method.
  double diagonal() const { return box_.diagonal().norm(); }  ///< Length of box()'s diagonal: the object's size.

  double area() const { return area_; }  ///< Sum of the triangles' areas.
  /// Signed volume by the divergence theorem, positive if triangles face outwards. It is the volume of a body only
  /// where topology() is closed and oriented.
  double volume() const { return volume_; }
  /// Centre of mass of the enclosed body (same condition as volume()); the mean of the surface where volume() is zero.
  const Eigen::Vector3d& centroid() const { return centroid_; }

  /// Whether the mesh bounds a body: closed, consistently oriented, facing outwards. It need not be manifold: two
  /// bodies may touch in an edge.
  bool solid() const { return topology_.closed && topology_.oriented && volume_ > 0.0; }

  /// Why solid() is false ("not closed: 12 border edges"); empty if it is true.
  std::string why_not_solid() const;

  /// Content hash of the vertex and triangle arrays, without the name: 32 hexadecimal digits.
  const std::string& hash() const { return hash_; }

 private:
  Mesh() = default;
  /// Box, area, volume, centroid and hash of vertices_ and triangles_.
  void measure();
  /// Area, signed volume and centroid, by the tetrahedra of all triangles with the centre (divergence theorem).
  void integrate();

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
