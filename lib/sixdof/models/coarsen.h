#pragma once

#include <functional>

#include <sixdof/models/surface.h>

namespace sixdof {

/// Projects a point near a smooth surface onto it.
using Project = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// Coarsens a closed manifold surface and improves its triangles: collapses the shortest edge until exactly `triangles`
/// (even) are left, then moves each vertex along the surface if that improves its worst triangle. New positions are
/// projected. The topology stays: an edge is collapsed only if its end points have no common neighbours but the two
/// opposite vertices, and if no triangle is inverted. Deterministic; of equally long edges the one with lower vertex
/// numbers comes first.
/// @throws BadMesh if the surface is not a closed manifold or its topology needs more triangles.
void coarsen_to(Surface& surface, std::size_t triangles, const Project& project);

}  // namespace sixdof
