#pragma once

#include <cstdint>
#include <string_view>

#include <sixdof/geometry/mesh.h>

/// Numbers that describe the shape of a mesh, and a kind that follows from them, so that a rule classifies the objects
/// of a collection.
namespace sixdof {

/// None of them depends on the unit of length. All are 0 where they have no meaning.
struct ShapeFacts {
  std::int64_t genus = 0;      ///< Handles of all components together; of closed manifold meshes only.
  double box_aspect = 0.0;     ///< Shortest edge of the box / longest one.
  double box_fill = 0.0;       ///< Volume / volume of the box; of solids only.
  double thickness = 0.0;      ///< 2 volume / area / diagonal; of solids only. A plate's own thickness / its diagonal.
  double aligned_share = 0.0;  ///< Part of the area whose normal is within k_aligned_deg of an axis of the frame.
  /// Part of the edges of two triangles that bend by less than k_flat_share of the mean bend: many where faces are
  /// planes, cylinders or cones, few where the surface is curved everywhere. Independent of the number of triangles.
  double flat_share = 0.0;

  static constexpr double k_aligned_deg = 1.0;  ///< Of aligned_share, in degrees.
  static constexpr double k_flat_share = 0.05;  ///< Of flat_share: part of the mean bend.
};

/// The numbers of a mesh. Cost O(triangles log triangles).
ShapeFacts shape_facts(const Mesh& mesh);

/// What a shape is like, by its facts.
enum class ShapeKind {
  handles,  ///< Genus of 10 or more.
  thin,     ///< A sheet, a rod, a wire: thickness below 0.02, or box_aspect below 0.04.
  boxy,     ///< Aligned share of 0.8 or more.
  cad,      ///< Flat share of 0.25 or more.
  organic,  ///< None of these: curved everywhere.
};

/// The first kind whose condition holds.
ShapeKind kind_of(const ShapeFacts& facts);

/// The enumerator's name.
std::string_view name_of(ShapeKind kind);

}  // namespace sixdof
