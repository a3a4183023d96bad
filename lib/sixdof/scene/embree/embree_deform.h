#pragma once

#include <sixdof/scene/scene_algorithm.h>

namespace sixdof::scene {

/// What Embree has for meshes that deform: rtcCollide with this project's exact test of triangles; it answers touching,
/// surfaces only, by one thread. A mesh's vertices are kept in the world, and a body that moves or deforms is committed
/// again: `embree-refit`: quality RTC_BUILD_QUALITY_REFIT in a dynamic scene; `embree-rebuild-fast`:
/// RTC_BUILD_QUALITY_LOW, a Morton build; `embree-rebuild`: RTC_BUILD_QUALITY_MEDIUM, by the surface-area heuristic.
/// There is no broad phase: every pair is asked.
void add_embree_deforms(SceneAlgorithms& algorithms);

}  // namespace sixdof::scene
