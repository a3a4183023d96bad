#pragma once

#include <string>
#include <string_view>

#include <benchmark/benchmark.h>

#include <sixdof/scene/families.h>
#include <sixdof/scene/score.h>

/// What rows of scenes share.
namespace sixdof::bench {

/// The scene and the truth of the last row: rows of one scene come one after the other.
struct SceneStage {
  std::string key;  ///< Of what is here.
  scene::Scene scene;
  scene::SceneAnswers truth;
};

/// Replays a scene to an algorithm, and reports its times, faults and work as counters; a fault is an error of the row.
/// @param key names the scene and the question
void run_scene(SceneStage& stage, const std::string& key, const scene::SceneNumbers& numbers, std::string_view family,
               const scene::SceneAlgorithm& algorithm, scene::Question question, benchmark::State& state);

}  // namespace sixdof::bench
