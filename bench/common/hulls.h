#pragma once

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// convex_hull() (oracle/convex_hull.h) of a mesh, kept in the cache on disk (base/cache.h) by the mesh's content hash.
/// @throws BadMesh if the vertices lie in a plane
Mesh hull_of(const Mesh& mesh);

}  // namespace sixdof
