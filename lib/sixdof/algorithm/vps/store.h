#pragma once

#include <sixdof/algorithm/vps/field.h>
#include <sixdof/algorithm/vps/pointshell.h>
#include <sixdof/algorithm/vps/voxelmap.h>

namespace sixdof::vps {

/// The same as the build() functions, but taken from the cache on disk where it holds them (lib/base/cache.h), and kept
/// there after building. An entry that does not pass the checks is built again.

VoxelMap cached_voxelmap(const Mesh& mesh, double voxel_size, int border);
PointShell cached_pointshell(const Mesh& mesh, double spacing);
/// @param map cached_voxelmap of the same mesh
DistanceField cached_field(const Mesh& mesh, const VoxelMap& map);

}  // namespace sixdof::vps
