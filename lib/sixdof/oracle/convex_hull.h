#pragma once

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// The convex hull of a mesh's vertices as a solid. Exact: its vertices are some of the mesh's, bit for bit, and no
/// vertex of the mesh lies outside of the plane of a triangle (predicates.h). Triangles may be coplanar; none has
/// collinear corners. The same mesh gives the same triangles in the same order.
///
/// Quickhull (Barber, Dobkin, Huhdanpaa, ACM TOMS 22, 1996) with exact signs: the farthest point over a triangle is
/// added, and sees those triangles that it is strictly above. Then points in the plane of a triangle need no tolerance.
/// @throws BadMesh if the vertices lie in a plane
Mesh convex_hull(const Mesh& mesh);

}  // namespace sixdof
