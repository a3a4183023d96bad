#pragma once

#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// The convex hull of a mesh's vertices as a solid (algorithm/ccd/convex_hull.h).
/// @throws BadArgument in a build without Qhull; BadMesh if the vertices lie in a plane
Mesh hull_of(const Mesh& mesh);

}  // namespace sixdof
