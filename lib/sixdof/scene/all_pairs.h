#pragma once

#include <memory>

#include <sixdof/scene/scene_algorithm.h>

namespace sixdof::scene {

/// `all-pairs`: every pair that matters in every frame, none of them kept or put off: what defines the truth. A pair is
/// left out only if its boxes along the world's axes, enlarged by rounding, are further apart than what is asked for;
/// all others are measured by the distance oracle without a limit. Meshes that deform are prepared anew in each frame.
std::unique_ptr<SceneAlgorithm> make_all_pairs();

}  // namespace sixdof::scene
