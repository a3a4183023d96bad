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

/// In percent of the diagonal of the mesh that deforms.
constexpr double k_amplitudes[] = {0.1, 0.3, 1.0, 3.0, 10.0, 30.0};
constexpr std::size_t k_frames = 30;

/// The triangles of all meshes that deform, in a frame.
double deformed_triangles(const scene::Scene& scene) {
  double sum = 0.0;
  for (const auto& frame : scene.deformations) {
    for (const scene::Deformation& each : frame) {
      sum += static_cast<double>(scene.meshes[each.mesh]->triangles().size());
    }
  }
  return sum / static_cast<double>(scene.frames.size());
}

}  // namespace

std::vector<PlannedRow> deform_rows(const Resources& resources) {
  const auto algorithms = std::make_shared<const scene::SceneAlgorithms>(all_scene_algorithms());
  const auto stage = std::make_shared<SceneStage>();
  std::vector<PlannedRow> rows;
  for (const scene::SceneFamily& family : scene::deforming_families()) {
    for (const double percent : k_amplitudes) {
      const scene::SceneNumbers numbers{.frames = k_frames, .amplitude = percent / 100.0, .seed = resources.seed};
      for (const Question question : {Question::touching, Question::near, Question::closest}) {
        const std::string key = fmt::format("{}/amplitude:{}/question:{}", family.name, percent, to_string(question));
        for (const auto& algorithm : *algorithms) {
          const scene::SceneTraits& traits = algorithm->traits();
          if (!traits.answers_to(question) || !traits.deforms || !traits.by_default) continue;
          rows.push_back({.name = fmt::format("deform/{}/algorithm:{}", key, traits.name),
                          .run =
                              [=, &family, &each = *algorithm](benchmark::State& state, const Share&) {
                                static_cast<void>(algorithms);  // owns `each`
                                run_scene(*stage, key, numbers, family.name, each, question, state);
                                state.counters["amplitude"] = percent;
                                state.counters["deformed_triangles"] = deformed_triangles(stage->scene);
                              },
                          .fields = {.query = "deform",
                                     .algorithm = traits.name,
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
