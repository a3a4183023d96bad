#pragma once

#include <sixdof/scene/scene_algorithm.h>

namespace sixdof::scene {

/// Bullet's broad phases, each with GImpact's narrow phase on triangle meshes in double precision: `bullet-simple`,
/// `bullet-dbvt`, `bullet-axis-sweep`. They answer touching; GImpact has no distances, and finds all contacts of a
/// pair.
///
/// Bodies that are fixed are in a group that does not meet itself. The axis sweep is told the bounds of the bodies at
/// all recorded poses, which it needs in advance.
void add_bullet_scenes(SceneAlgorithms& algorithms);

}  // namespace sixdof::scene
