#pragma once

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// The convex hull of a mesh's vertices as a solid, by Qhull (option Qt: triangulated facets). Its vertices are some of
/// the mesh's.
/// @throws BadMesh if the vertices lie in a plane, or in one within Qhull's rounding
Mesh convex_hull(const Mesh& mesh);

}  // namespace sixdof
