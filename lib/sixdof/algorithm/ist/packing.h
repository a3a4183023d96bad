#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <sixdof/algorithm/ist/sphere.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof::ist {

/// Packing stops at the first of these limits.
struct PackingOptions {
  std::size_t spheres = 10'000;
  double fill = 1.0;              ///< Fraction of the mesh's volume that the spheres fill.
  double smallest_radius = 1e-4;  ///< In box diagonals of the mesh.
  std::uint64_t seed = 1;         ///< Of the start points on the surface.
};

struct Packing {
  std::vector<Sphere> spheres;  ///< In the order of their insertion, nearly from large to small; pairwise disjoint.
  double fill = 0.0;            ///< Volume of the spheres over the volume of the mesh.
};

/// Packs disjoint spheres into a solid, greedily from large to small (ProtoSphere; Weller and Zachmann 2010).
///
/// A prototype is a candidate centre. Prototypes start on the surface and around every inserted sphere, and move away
/// from the closest obstacle, surface or sphere, to a local maximum of the clearance. The largest are inserted; those
/// that now overlap an inserted sphere are optimised again. A prototype never moves farther than its clearance, so it
/// stays inside the solid. The spheres keep a relative margin of 1e-9 from the surface and from each other.
///
/// The same bits for every number of threads. @throws BadMesh if the mesh is not solid, or too thin for a single sphere
/// of the smallest radius.
Packing pack_spheres(const Mesh& mesh, const PackingOptions& options);

/// The same, kept in the cache on disk.
Packing cached_packing(const Mesh& mesh, const PackingOptions& options);

/// Weight of each packed sphere: the volume of its cell over its own volume, at least 1.
///
/// A sphere's cell is the part of the solid that is nearer to its surface than to any other sphere's (an additively
/// weighted Voronoi cell; Aurenhammer, "Voronoi Diagrams", ACM Computing Surveys 1991). Cells are star-shaped about
/// their spheres' centres, so a volume is a mean of the cubes of ray lengths; a ray ends at the surface. The gaps
/// between the spheres are scaled so that the cells' volumes sum to the mesh's.
///
/// The same bits for every number of threads.
/// @param spheres disjoint and inside the mesh, as pack_spheres() returns them
std::vector<double> cell_weights(const Mesh& mesh, std::span<const Sphere> spheres);

/// The same, kept in the cache on disk.
std::vector<double> cached_cell_weights(const Mesh& mesh, std::span<const Sphere> spheres);

}  // namespace sixdof::ist
