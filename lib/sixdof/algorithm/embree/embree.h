#pragma once

#include <memory>

#include <sixdof/query/registry.h>

namespace sixdof {

/// `embree`: Embree's rtcCollide() of two scenes, with this project's exact test of triangles. Answers collide.
///
/// **What Embree does.** rtcCollide() traverses the trees of two scenes of user geometry and passes on pairs of
/// primitives of leaves that overlap. It tests neither the boxes of these primitives nor the primitives: here their
/// boxes come first, in double precision, then triangles_intersect() (geometry/triangle_distance.h).
///
/// **Precision.** Embree's boxes are floats. A triangle's box is that of its corners in double precision in A's frame,
/// rounded outwards, so that no pair is lost; the pairs are tested in double precision, exactly for B's rounded
/// corners. Embree takes no coordinate beyond 1.8e18: a query that has one fails.
///
/// **Prepare** builds a scene for each mesh. **A query** transforms all vertices of B, tells Embree that B's geometry
/// has changed, commits B's scene and calls rtcCollide(). rtcCollide() has no pose of a scene, and user geometry is the
/// only one that it accepts, so instances cannot move B. The time of a query grows with the number of B's triangles,
/// however far the bodies are apart. A callback cannot stop rtcCollide(): after the first pair that intersects, the
/// others are passed over without a test. Nothing is kept from query to query but the structure of B's tree.
///
/// **Profiles.** `default` is what Embree's tutorial `collide` does: scenes of quality LOW, whose trees are rebuilt by
/// every commit (https://github.com/RenderKit/embree/blob/master/tutorials/collide/collide_device.cpp). `tuned` follows
/// Embree's manual: A's scene of quality HIGH, "better rendering performance but slower scene commit times"
/// (https://manpages.ubuntu.com/manpages/jammy/man3/rtcSetSceneBuildQuality.3.html); B's scene with the flag DYNAMIC,
/// "better build performance for dynamic scenes"
/// (https://man.archlinux.org/man/extra/embree3/rtcSetSceneFlags.3embree3.en); B's geometry of quality REFIT, "when
/// changing only the vertex buffer"
/// (https://man.archlinux.org/man/rtcSetGeometryBuildQuality.3embree3.en.txt).
///
/// **Threads.** Embree spreads builds and rtcCollide() over all cores. Here both run in a task arena of one thread.
///
/// **Known failures.** Surfaces only: a body wholly inside the other does not collide. No distance: rtcPointQuery()
/// gives the distance of a point to a surface, which bounds that of two surfaces from above only.
std::unique_ptr<Algorithm> make_embree_algorithm();

/// Adds it.
void register_embree_algorithms(Registry& registry);

}  // namespace sixdof
