#pragma once

#include <span>
#include <string>
#include <vector>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/motion.h>
#include <sixdof/oracle/advancement.h>

namespace sixdof {

/// Raised whenever a bit of a truth changes.
inline constexpr int k_impact_truth_version = 2;

/// The bracket of each motion by ImpactTruth, from the cache on disk (base/cache.h) where it is known. The key is the
/// content of both meshes, all bits of the motions, and k_impact_truth_version. Triangles of the closest points
/// are not kept.
/// @throws BadMesh as Tree does, BadArgument for a motion that cannot be computed
std::vector<ImpactBracket> stored_impacts(const Mesh& a, const Mesh& b, std::span<const Motion> motions);

/// The key: what the truths depend on.
std::string impact_key(const Mesh& a, const Mesh& b, std::span<const Motion> motions);

}  // namespace sixdof
