#pragma once

#include <memory>

#include <sixdof/query/algorithm.h>
#include <sixdof/algorithm/vps/pointshell.h>
#include <sixdof/algorithm/vps/voxelmap.h>

namespace sixdof {

/// `vps`: voxmap-pointshell (McNeely et al. 1999, Sagardia et al. 2008). A is voxels with integer layers, B is points
/// on its surface with inward normals and the area w that each stands for. Every point in a voxel of layer v >= 0
/// pushes along its own normal:
///
///   F = k sum w p n        T = k sum w p (P - C) x n        p = max(0, n . eps + v s)
///
/// with s the voxel size, eps = voxel centre - point, C the centre of B's box. F and T act on B. B's inward normals
/// point out of A where the surfaces meet face to face, which is what makes F push B out. Penalty: the greatest p.
///
/// `vps-field`: the same points against a smooth signed distance f. The wrench is minus the gradient of one energy,
/// k sum w min(f, 0)^2 / 2, by B's translation and rotation about C: it is conservative and continuous. Penalty: the
/// greatest -f.
///
/// A point's p is off by up to VoxelMap::k_layer_error voxels: half a voxel on a face along the axes; on a slanted face
/// surface voxels reach deeper and layers read short. `vps-field` is off by a fraction of a voxel at edges only.
///
/// What both cannot see:
/// - A is known at B's points only. Where A lies wholly inside B, or pokes through B between two points, nothing is
/// felt;
///   `pointshell=a` sees it.
/// - Where B swallows a thin part of A, `vps-field` pushes each point out of that part the nearest way, which is
/// sideways;
///   `vps` still pushes along B's normals.
/// - Anything smaller than a voxel is a surface voxel. A plate thinner than a voxel is felt by `vps` (layer 0: p counts
///   from the voxel's centre, so a point on either side is pushed along its own normal), not with `depth=layers`, and
///   hardly by `vps-field`.
/// - Both bodies must be solids; prepare() throws BadMesh otherwise, inside-out meshes included. Inner walls of a mesh
///   that intersects itself count as surface.
std::unique_ptr<Algorithm> make_vps_algorithm();
std::unique_ptr<Algorithm> make_vps_field_algorithm();

/// What queries are made of, from the algorithm's settings, kept on disk between runs (cache.h).
/// @throws BadMesh, BadArgument as the structures' build() does
namespace vps {

VoxelMap prepare_voxelmap(const Mesh& mesh, const Settings& settings);
PointShell prepare_pointshell(const Mesh& mesh, const Settings& settings);

}  // namespace vps

}  // namespace sixdof
