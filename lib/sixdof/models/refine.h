#pragma once

#include <functional>

#include <sixdof/models/surface.h>

namespace sixdof {

/// Where the vertex goes that splits the edge from vertex a to vertex b of a surface. It becomes the surface's next
/// vertex: number vertices.size().
using PlaceOnEdge = std::function<Eigen::Vector3d(const Surface& surface, std::uint32_t a, std::uint32_t b)>;

/// The plain midpoint.
Eigen::Vector3d midpoint_of_edge(const Surface& surface, std::uint32_t a, std::uint32_t b);

/// Splits the longest edge, again and again, until the surface has at least `triangles` triangles. Each split cuts all
/// triangles at the edge in two, so nothing comes apart; a closed surface gains two a time and ends with exactly
/// `triangles` if that is even (where two triangles meet at each edge). Since the longest edge of all is the longest of
/// its triangles, no angle falls below half the smallest one of the input as long as `place` is the midpoint (Rosenberg
/// and Stenger 1975). Among equally long edges the one with lower vertex numbers is first: the result is deterministic.
/// Cost O((edges + splits) log edges).
void refine_to(Surface& surface, std::size_t triangles, const PlaceOnEdge& place = midpoint_of_edge);

/// The same solid with at least `triangles` triangles: exactly that many, or one more, if two triangles meet at every
/// edge. New vertices are midpoints of edges, so the shape stays what it is up to the rounding of those midpoints (half
/// a unit in the last place of the coordinates). A mesh that has as many triangles already is returned as it is.
/// @param name of the result
/// @throws BadArgument above k_maximum_triangles.
Mesh subdivide(const Mesh& mesh, std::size_t triangles, std::string name);

}  // namespace sixdof
