#pragma once

#include <memory>

#include <sixdof/algorithm/vps/field.h>
#include <sixdof/algorithm/vps/pointshell.h>
#include <sixdof/algorithm/vps/voxelmap.h>
#include <sixdof/query/algorithm.h>

namespace sixdof {

/// `vps`: voxmap-pointshell (McNeely et al. 1999, Sagardia et al. 2008). A is a voxelmap with integer layers v, B is
/// points P on its surface with inward normals n and weights w, the area of each point's cell. Every point in a voxel
/// of layer v >= 0 adds a force along its own normal:
///
///   F = k sum w p n        T = k sum w p (P - C) x n        p = max(0, n . eps + v s)
///
/// with s the voxel size, eps = voxel centre - P, C the centre of B's box. F and T act on B. B's inward normals point
/// out of A where the surfaces meet face to face, so F pushes B out. Penalty: the greatest p.
///
/// `vps-field`: the same points in a smooth signed distance f to A. The wrench is minus the gradient of the energy
/// k sum w min(f, 0)^2 / 2 by B's translation and rotation about C: it is conservative and continuous. Penalty: the
/// greatest -f.
///
/// Errors of p: for `vps` up to VoxelMap::k_layer_error voxels, namely half a voxel on a face along the axes, more on a
/// slanted face, where surface voxels reach deeper and layers are too small. For `vps-field` a fraction of a voxel, at
/// edges only.
///
/// Limits of both:
/// - A is sampled at B's points only: no force where A lies wholly inside B or penetrates B between two points;
///   `pointshell=a` finds such contacts.
/// - Where B encloses a thin part of A, `vps-field` pushes each point out of that part the shortest way, which is
///   sideways; `vps` pushes along B's normals.
/// - Parts smaller than a voxel are surface voxels. On a plate thinner than a voxel `vps` acts with layer 0, counted
///   from the voxel's centre: a point on either side is pushed along its own normal. With `depth=layers` there is no
///   force, with `vps-field` hardly any.
/// - Both bodies must be solid; prepare() throws BadMesh otherwise, also for inside-out meshes. Inner walls of a mesh
///   that intersects itself count as surface.
std::unique_ptr<Algorithm> make_vps_algorithm();
/// `vps-field`.
std::unique_ptr<Algorithm> make_vps_field_algorithm();

namespace vps {

/// The structures that the queries use, built with the algorithms' settings or taken from the cache on disk
/// (base/cache.h). They throw what the structures' build() functions do.
VoxelMap prepare_voxelmap(const Mesh& mesh, const Settings& settings);
/// The points of B.
PointShell prepare_pointshell(const Mesh& mesh, const Settings& settings);
/// @param map prepare_voxelmap() of the same mesh
DistanceField prepare_field(const Mesh& mesh, const VoxelMap& map);

}  // namespace vps
}  // namespace sixdof
