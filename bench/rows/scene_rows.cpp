#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/scene/families.h>
#include <sixdof/scene/score.h>
#include "bench/common/interrupt.h"
#include "bench/common/scene_algorithms.h"
#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

using scene::Question;
using scene::SceneAlgorithm;

/// Rows of more bodies are of light families, where bodies have some hundred triangles.
struct Size {
  std::size_t bodies;
  std::size_t frames;
  bool light_only;
};
constexpr Size k_sizes[] = {{100, 60, false}, {1000, 30, false}, {10'000, 8, true}, {100'000, 4, true}};

/// The scene and the truth of the last row: rows of one scene come one after the other.
struct Stage {
  std::string key;
  scene::Scene scene;
  scene::SceneAnswers truth;
};

void report(const scene::Play& play, benchmark::State& state) {
  constexpr double k_ns = 1e3;  // per microsecond
  const auto number = [](auto x) { return static_cast<double>(x); };
  const double frames = number(play.score.frames);
  state.SetIterationTime(1e-6 * play.timing.mean_us);
  auto& counters = state.counters;
  counters["mean_ns"] = k_ns * play.timing.mean_us;
  counters["processor_ns"] = k_ns * play.timing.processor_us;
  counters["p99_frame_ns"] = k_ns * play.timing.p99_us;
  counters["max_ns"] = k_ns * play.timing.max_us;
  counters["first_frame_ns"] = k_ns * play.timing.first_us;
  counters["frames"] = frames;
  counters["true_pairs"] = number(play.score.true_pairs) / frames;
  counters["missed_pairs"] = number(play.score.missed);
  counters["wrong_pairs"] = number(play.score.wrong);
  counters["grazing_pairs"] = number(play.score.grazing);
  counters["nested_pairs"] = number(play.score.nested);
  counters["same_bits"] = play.score.same_bits ? 1.0 : 0.0;
  counters["false_per_true"] = play.false_per_true();
  counters["pairs_looked_at"] = number(play.work.candidates) / frames;
  counters["pairs_never_looked_at"] = (number(play.pairs_in_all) - number(play.work.candidates)) / frames;
  counters["pairs_put_off"] = number(play.work.put_off) / frames;
  counters["triangle_pairs"] = number(play.work.triangles) / frames;
  counters["bytes"] = number(play.bytes);
  if (play.score.failed() || (play.score.first && !play.score.same_bits)) {
    const scene::WrongPair& wrong = *play.score.first;
    state.SkipWithError(fmt::format("{} missed, {} wrong; the first: frame {}, bodies {} and {}, distance {:.6g}",
                                    play.score.missed, play.score.wrong, wrong.frame, wrong.pair.a, wrong.pair.b,
                                    wrong.truth)
                            .c_str());
  }
}

void run(Stage& stage, const std::string& key, const scene::SceneNumbers& numbers, std::string_view family,
         const SceneAlgorithm& algorithm, Question question, benchmark::State& state) {
  if (stage.key != key) {
    stage.key.clear();
    stage.scene = scene::make_scene(family, numbers);
    stage.truth = scene::truth_of(stage.scene, question, InterruptGuard::requested);
    stage.key = key;
  }
  for (auto _ : state) {
    report(scene::play(stage.scene, algorithm, question, stage.truth, InterruptGuard::requested), state);
    state.counters["bodies"] = static_cast<double>(numbers.bodies);
  }
}

}  // namespace

std::vector<PlannedRow> scene_rows(const Resources& resources) {
  const auto algorithms = std::make_shared<const scene::SceneAlgorithms>(all_scene_algorithms());
  const auto stage = std::make_shared<Stage>();
  std::vector<PlannedRow> rows;
  for (const scene::SceneFamily& family : scene::scene_families()) {
    for (const Size& size : k_sizes) {
      if (size.light_only && family.name == "pairs") continue;
      for (const Question question : scene::k_questions) {
        const scene::SceneNumbers numbers{.bodies = size.bodies, .frames = size.frames, .seed = resources.seed};
        const std::string key = fmt::format("{}/n:{}/question:{}", family.name, size.bodies, to_string(question));
        for (const auto& algorithm : *algorithms) {
          if (!algorithm->traits().answers_to(question)) continue;
          rows.push_back({.name = fmt::format("scene/{}/algorithm:{}", key, algorithm->traits().name),
                          .run =
                              [=, &family, &each = *algorithm](benchmark::State& state, const Share&) {
                                static_cast<void>(algorithms);  // owns `each`
                                run(*stage, key, numbers, family.name, each, question, state);
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
