#pragma once

#include <span>

#include <sixdof/algorithm/ist/sphere.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof::ist {

/// How far the surface lies from the spheres inside it, at its vertices and at the centroids of its triangles, the
/// greatest value (length): what queries of the spheres do not see. Of large meshes evenly chosen ones are taken, so
/// that the time stays below that of some 1e7 distances.
double largest_gap(const Mesh& mesh, std::span<const Sphere> spheres);

}  // namespace sixdof::ist
