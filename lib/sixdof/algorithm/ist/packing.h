#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <sixdof/algorithm/ist/sphere.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/tree.h>

namespace sixdof::ist {

/// When to stop packing: whichever comes first.
struct PackingGoal {
  std::size_t spheres = 10'000;   ///< Number of spheres.
  double fill = 1.0;              ///< Share of the mesh's volume that the spheres fill.
  double smallest_radius = 1e-4;  ///< In box diagonals of the mesh.
  std::uint64_t seed = 1;         ///< Of the starting points on the surface.
};

struct Packing {
  std::vector<Sphere> spheres;  ///< In the order of their insertion, nearly from large to small; pairwise disjoint.
  double fill = 0.0;            ///< Volume of the spheres over the volume of the mesh.
};

/// Packs non-overlapping spheres into a solid, greedily from large to small (ProtoSphere; Weller and Zachmann 2010).
///
/// Prototypes start on the surface and around every placed sphere, and move away from whatever is closest, surface or
/// sphere, with shrinking steps until they stand near a local maximum of the clearance. The largest are inserted; those
/// that an insertion disturbed move on. A prototype never steps farther than its clearance, so it cannot leave the
/// solid. The spheres keep a relative margin of 1e-9 from the surface and from each other, against rounding.
///
/// The same spheres, bit for bit, for every number of threads.
/// @throws BadMesh if the mesh is not solid, or too thin for a single sphere of the smallest radius.
Packing pack_spheres(const Mesh& mesh, const Tree& tree, const PackingGoal& goal);

/// The same, kept on disk between runs (cache.h).
Packing pack_spheres_cached(const Mesh& mesh, const PackingGoal& goal);

}  // namespace sixdof::ist
