#pragma once

#include <functional>
#include <string>
#include <vector>

#include <sixdof/scene/scene_algorithm.h>

namespace sixdof::scene {

/// The answers to a question in a scene, one for each frame: what they should be, or what an algorithm says.
struct SceneAnswers {
  std::vector<SceneAnswer> frames;  ///< One for each frame of the scene.
  std::string hash;                 ///< Of all bits of all frames.
  std::size_t pairs() const;        ///< Of all frames.
};

/// Sets SceneAnswers::hash from the frames.
void set_hash(SceneAnswers& truth);

/// Asks an algorithm in every frame. @param cancelled called before each frame; true ends it with Interrupted
SceneAnswers replay(const Scene& scene, const SceneAlgorithm& algorithm, Question question,
                    const std::function<bool()>& cancelled = {});

/// Version of the definitions, of the last bits of the answers and of their layout in the cache: what another version
/// stored is not used.
inline constexpr int k_truth_version = 8;

/// The answers of `all-pairs`, from the cache on disk (base/cache.h), where they are kept by the scene's content hash.
SceneAnswers truth_of(const Scene& scene, Question question, const std::function<bool()>& cancelled = {});

}  // namespace sixdof::scene
