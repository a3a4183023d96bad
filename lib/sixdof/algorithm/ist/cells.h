#pragma once

#include <span>
#include <vector>

#include <sixdof/algorithm/ist/sphere.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof::ist {

/// Weight of each packed sphere: the volume of its cell over its own volume, at least 1.
///
/// A sphere's cell is the part of the solid that is nearer to its surface than to any other sphere's (an additively
/// weighted Voronoi cell; Aurenhammer, "Voronoi Diagrams", ACM Computing Surveys 1991). Cells are star-shaped about
/// their spheres' centres, so a volume is a mean of the cubes of ray lengths; a ray ends at the surface. The gaps
/// between the spheres are scaled so that the cells' volumes sum to the mesh's.
///
/// @param spheres disjoint and inside the mesh, as pack_spheres() returns them
/// The same bits for every number of threads.
std::vector<double> cell_weights(const Mesh& mesh, std::span<const Sphere> spheres);

/// The same, kept in the cache on disk.
std::vector<double> cached_cell_weights(const Mesh& mesh, std::span<const Sphere> spheres);

}  // namespace sixdof::ist
