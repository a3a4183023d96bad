#pragma once

#include <sixdof/scene/scene_algorithm.h>

namespace sixdof::scene {

/// What Bullet's GImpact has for meshes that deform; it answers touching, surfaces only, in double precision:
/// `bullet-refit`: postUpdate() and updateBound(), which fit the boxes of the tree anew, as its manual has it;
/// `bullet-rebuild`: a new shape. There is no broad phase: every pair is asked.
void add_bullet_deforms(SceneAlgorithms& algorithms);

}  // namespace sixdof::scene
