#pragma once

#include <span>
#include <vector>

#include <sixdof/algorithm/ist/sphere.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/tree.h>

namespace sixdof::ist {

/// How many times its own volume each packed sphere stands for: the volume of its cell over its own, at least 1.
///
/// A sphere's cell is the part of the solid that is nearer to its surface than to any other sphere's (Voronoi cells of
/// balls, additively weighted; Aurenhammer, "Voronoi Diagrams", ACM Computing Surveys 1991). Cells are star-shaped
/// about their spheres' centres, so a volume is a mean of cubes of lengths of rays; what lies behind a wall does not
/// count. The gaps between the spheres are scaled so that all cells together have the mesh's volume.
///
/// @param spheres disjoint and inside the mesh, as pack_spheres() leaves them
/// The same bits for every number of threads.
std::vector<double> cell_shares(const Mesh& mesh, const Tree& tree, std::span<const Sphere> spheres);

/// The same, kept on disk between runs (cache.h).
std::vector<double> cell_shares_cached(const Mesh& mesh, std::span<const Sphere> spheres);

}  // namespace sixdof::ist
