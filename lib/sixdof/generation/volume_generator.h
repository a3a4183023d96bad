#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include <sixdof/base/run_options.h>
#include <sixdof/generation/distance_generator.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof {

/// Finds the translations at which B, moving from outside towards A, overlaps A by given volumes for the first time.
///
/// The search measures the volume V where the last measurements predict the target and brackets it (overlap_march.h);
/// the oracle's exact derivative makes both cubic. V need not grow monotonically inwards. A target counts as met only
/// if no interval between measurements before it can contain an earlier hit: V is bounded there by the changes of slope
/// that the triangles intersecting in it can cause (overlap_bounds.h). Where the bounds do not suffice, the interval is
/// divided, down to k_first_overlap_resolution.
///
/// The leaves whose triangles may intersect are collected for the displacement between two measurements (candidates.h)
/// and used for all bounds in it. Where they do not suffice, their triangles are collected, and used for the
/// measurements in it as well. A ray takes about three measurements per target.
///
/// Hits that begin and end within the resolution may be missed where the bounds do not exclude them; in meshes that
/// intersect themselves, longer ones too.
///
/// The first measurement on a ray is as far from contact as the previous ray was when it met its first target. The bits
/// are the same for every number of threads and on every instruction set.
/// @param touching finds where the surfaces meet first
/// @return makes a solver for these meshes; may be called from several threads. Both meshes and `touching` outlive it
/// and the solvers. Targets are volumes in the cube of the meshes' unit, ascending; 0 stands for contact, which is
/// distance bucket 0. Measurements are those of the volume.
/// @throws BadMesh naming the mesh that is not a solid and why. So do the solvers where the rounding of a volume
/// (overlap.h) exceeds its tolerance: A some thousand times smaller than B's triangles, or both far from their origins.
std::function<std::unique_ptr<RaySolver>()> volume_solvers(const DistanceGenerator& touching, const Mesh& a,
                                                           const Mesh& b);

/// In units of the diagonal of the smaller mesh's box.
constexpr double k_first_overlap_resolution = 2e-3;

/// Finds all configurations of volume buckets, as generate_distances() does those of distance buckets.
/// @param percents of A's volume, each once, as a BucketKey has them
/// @throws BadArgument, BadMesh, Interrupted, and Error naming the configuration
Generated generate_volumes(const DistanceGenerator& touching, const Mesh& a, const Mesh& b, const Grid& grid,
                           std::span<const double> percents, const RunOptions& run = {},
                           std::span<const std::uint32_t> rotations = {});

}  // namespace sixdof
