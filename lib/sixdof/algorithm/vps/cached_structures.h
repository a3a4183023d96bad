#pragma once

#include <sixdof/algorithm/vps/field.h>
#include <sixdof/algorithm/vps/pointshell.h>
#include <sixdof/algorithm/vps/voxelmap.h>

/// The structures' build() functions with the cache on disk (base/cache.h): an entry that is missing or not valid is
/// built and stored.

namespace sixdof::vps {

VoxelMap cached_voxelmap(const Mesh& mesh, double voxel_size, int border);
PointShell cached_pointshell(const Mesh& mesh, double spacing);
/// @param map cached_voxelmap() of the same mesh
DistanceField cached_field(const Mesh& mesh, const VoxelMap& map);

}  // namespace sixdof::vps
