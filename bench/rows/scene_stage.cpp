#include "bench/rows/scene_stage.h"

#include <fmt/format.h>

#include "bench/common/interrupt.h"

namespace sixdof::bench {
namespace {

void report(const scene::Play& play, benchmark::State& state) {
  constexpr double k_ns = 1e3;  // per microsecond
  const auto number = [](auto x) { return static_cast<double>(x); };
  const double frames = number(play.score.frames);
  state.SetIterationTime(1e-6 * play.timing.mean_us);
  auto& counters = state.counters;
  counters["mean_ns"] = k_ns * play.timing.mean_us;
  counters["processor_ns"] = k_ns * play.timing.processor_us;
  counters["update_ns"] = k_ns * play.timing.update_us;
  counters["answer_ns"] = k_ns * play.timing.answer_us;
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
  if (play.work.undecided > 0) counters["undecided_pairs"] = number(play.work.undecided);
  if (play.work.built > 0) counters["built_triangles"] = number(play.work.built) / frames;
  if (play.score.failed() || (play.score.first && !play.score.same_bits)) {
    const scene::WrongPair& wrong = *play.score.first;
    state.SkipWithError(fmt::format("{} missed, {} wrong; the first: frame {}, bodies {} and {}, distance {:.6g}",
                                    play.score.missed, play.score.wrong, wrong.frame, wrong.pair.a, wrong.pair.b,
                                    wrong.truth)
                            .c_str());
  }
}

}  // namespace

void run_scene(SceneStage& stage, const std::string& key, const scene::SceneNumbers& numbers, std::string_view family,
               const scene::SceneAlgorithm& algorithm, scene::Question question, benchmark::State& state) {
  if (stage.key != key) {
    stage.key.clear();
    stage.scene = scene::make_scene(family, numbers);
    stage.truth = scene::truth_of(stage.scene, question, InterruptGuard::requested);
    stage.key = key;
  }
  for (auto _ : state) {
    report(scene::play(stage.scene, algorithm, question, stage.truth, InterruptGuard::requested), state);
    state.counters["bodies"] = static_cast<double>(stage.scene.bodies.size());
  }
}

}  // namespace sixdof::bench
