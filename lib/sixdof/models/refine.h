#pragma once

#include <functional>

#include <sixdof/models/surface.h>

namespace sixdof {

/// Position of the vertex that splits the edge from vertex a to vertex b of a surface. It becomes vertex number
/// vertices.size().
using SplitPosition = std::function<Eigen::Vector3d(const RawMesh& surface, std::uint32_t a, std::uint32_t b)>;

Eigen::Vector3d midpoint_of_edge(const RawMesh& surface, std::uint32_t a, std::uint32_t b);

/// Splits the longest edge until the surface has at least `triangles` triangles. A split divides all triangles at the
/// edge in two: a surface with two triangles at each edge gains two per split and ends with exactly `triangles` if that
/// is even. If `position` is the midpoint, no angle falls below half the smallest one of the input (Rosenberg and
/// Stenger 1975), since the longest edge of all is the longest of its triangles. Of equally long edges the one with
/// lower vertex numbers comes first: the result is deterministic. Cost O((edges + splits) log edges).
void refine_to(RawMesh& surface, std::size_t triangles, const SplitPosition& position = midpoint_of_edge);

/// Projects a point near a smooth surface onto it.
using SurfaceProjection = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// Coarsens a closed manifold surface and improves its triangles: collapses the shortest edge until exactly `triangles`
/// (even) are left, then moves each vertex along the surface if that improves its worst triangle. New positions are
/// projected. The topology stays: an edge is collapsed only if its end points have no common neighbours but the two
/// opposite vertices, and if no triangle is inverted. Deterministic; of equally long edges the one with lower vertex
/// numbers comes first.
/// @throws BadMesh if the surface is not a closed manifold or its topology needs more triangles.
void coarsen_to(RawMesh& surface, std::size_t triangles, const SurfaceProjection& project);

/// refine_to() by midpoints: the shape stays the same up to their rounding, half a unit in the last place of the
/// coordinates.
/// @param name of the result
/// @throws BadArgument above k_maximum_triangles.
Mesh subdivide(const Mesh& mesh, std::size_t triangles, std::string name);

}  // namespace sixdof
