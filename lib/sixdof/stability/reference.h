#pragma once

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>

namespace sixdof::stability {

/// Distance of two surfaces over all pairs of triangles in long double: nine pairs of edges, six corners against
/// faces, and edges that pierce a face. It shares no code with the oracle. Its error is a few roundings of long double
/// relative to the coordinates, so it serves as truth where bodies are apart by more than 1e-18 of their size.
/// @pre meshes of a few hundred triangles: all pairs are visited
long double reference_distance(const Mesh& a, const Mesh& b, const Pose& X_AB);

}  // namespace sixdof::stability
