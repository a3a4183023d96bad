#pragma once

#include <sixdof/scene/scene_algorithm.h>

namespace sixdof {

/// Every algorithm for scenes of this build: this project's own, then those of the libraries that were found.
scene::SceneAlgorithms all_scene_algorithms();

}  // namespace sixdof
