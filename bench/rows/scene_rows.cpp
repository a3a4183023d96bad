#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <sixdof/scene/families.h>
#include "bench/common/scene_algorithms.h"
#include "bench/rows/families.h"
#include "bench/rows/scene_stage.h"

namespace sixdof::bench {
namespace {

using scene::Question;

/// Rows of more bodies are of light families, where bodies have some hundred triangles.
struct Size {
  std::size_t bodies;
  std::size_t frames;
  bool light_only;
};
constexpr Size k_sizes[] = {{100, 60, false}, {1000, 30, false}, {10'000, 8, true}, {100'000, 4, true}};

}  // namespace

std::vector<PlannedRow> scene_rows(const Resources& resources) {
  const auto algorithms = std::make_shared<const scene::SceneAlgorithms>(all_scene_algorithms());
  const auto stage = std::make_shared<SceneStage>();
  std::vector<PlannedRow> rows;
  for (const scene::SceneFamily& family : scene::scene_families()) {
    for (const Size& size : k_sizes) {
      if (size.light_only && family.name == "pairs") continue;
      for (const Question question : scene::k_questions) {
        const scene::SceneNumbers numbers{.bodies = size.bodies, .frames = size.frames, .seed = resources.seed};
        const std::string key = fmt::format("{}/n:{}/question:{}", family.name, size.bodies, to_string(question));
        for (const auto& algorithm : *algorithms) {
          if (!algorithm->traits().answers_to(question) || !algorithm->traits().rigid) continue;
          rows.push_back({.name = fmt::format("scene/{}/algorithm:{}", key, algorithm->traits().name),
                          .run =
                              [=, &family, &each = *algorithm](benchmark::State& state, const Share&) {
                                static_cast<void>(algorithms);  // owns `each`
                                run_scene(*stage, key, numbers, family.name, each, question, state);
                              },
                          .fields = {.query = "scene",
                                     .algorithm = algorithm->traits().name,
                                     .scenario = std::string(family.name),
                                     .question = std::string(to_string(question))},
                          .unit = benchmark::kMicrosecond,
                          .one_round = true});
        }
      }
    }
  }
  return rows;
}

}  // namespace sixdof::bench
