#pragma once

#include <functional>

#include <sixdof/models/surface.h>

namespace sixdof {

/// Puts a point near a smooth surface onto it.
using Project = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// Makes a closed manifold surface coarser and its triangles better: collapses the shortest edge, again and again,
/// until exactly `triangles` (even) are left, then moves vertices along the surface wherever that betters their worst
/// triangle. New places are projected. Never changes the topology: an edge is collapsed only if its end points have no
/// common neighbours but the two opposite ones, and no triangle turns over. Deterministic; among equals lower numbers
/// are first.
/// @throws BadMesh if the surface is not a closed manifold or so few triangles cannot hold its topology.
void coarsen_to(Surface& surface, std::size_t triangles, const Project& project);

}  // namespace sixdof
