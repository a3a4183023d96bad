#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>
#include <sixdof/scene/scene_file.h>
#include <sixdof/scene/score.h>
#include "bench/cli/scene.h"
#include "bench/cli/shared.h"
#include "bench/common/interrupt.h"
#include "bench/common/json_text.h"
#include "bench/common/run_guarded.h"
#include "bench/common/scene_algorithms.h"

namespace sixdof::cli {
namespace {

using scene::Play;
using scene::Question;
using scene::Scene;
using scene::SceneAlgorithm;
using scene::Truth;

struct PlayOptions {
  std::string file;
  std::vector<std::string> algorithms, questions{"touching"};
  unsigned threads = 0;
  bool json = false;
};

struct NamedPlay {
  const SceneAlgorithm& algorithm;
  Play play;
};

std::vector<const SceneAlgorithm*> choose(const scene::SceneAlgorithms& all, const PlayOptions& options,
                                          Question question) {
  std::vector<const SceneAlgorithm*> chosen;
  for (const std::string& name : options.algorithms) {
    const SceneAlgorithm& algorithm = scene::find_algorithm(all, name);
    scene::check_answers(algorithm.traits(), question);
    chosen.push_back(&algorithm);
  }
  if (!options.algorithms.empty()) return chosen;
  for (const auto& algorithm : all) {
    if (algorithm->traits().by_default && algorithm->traits().answers_to(question)) chosen.push_back(algorithm.get());
  }
  return chosen;
}

/// Share of a count that is large, in percent: two digits are significant.
std::string percent(double part, double whole) {
  return whole == 0.0 ? "-" : fmt::format("{:.2g}", 100.0 * part / whole);
}

void print_table(const Scene& scene, Question question, const Truth& truth, const std::vector<NamedPlay>& plays) {
  fmt::print("{}, {}: {} bodies, {} frames, {} true pairs in all frames, truth {}\n",
             scene.name.empty() ? "scene" : scene.name, to_string(question), scene.bodies.size(), scene.frames.size(),
             truth.pairs(), truth.hash);
  fmt::print("{:<20} {:>10} {:>10} {:>10} {:>10} {:>10} {:>7} {:>6} {:>7} {:>9} {:>9} {:>8} {:>5}\n", "", "cpu, us",
             "wall, us", "p99", "max", "first", "missed", "wrong", "grazing", "false per", "looked at", "put off",
             "same");
  fmt::print("{:<20} {:>10} {:>10} {:>10} {:>10} {:>10} {:>7} {:>6} {:>7} {:>9} {:>9} {:>8} {:>5}\n", "algorithm",
             "per frame", "per frame", "", "", "frame", "", "", "", "true pair", "of all, %", "of th., %", "bits");
  for (const auto& [algorithm, play] : plays) {
    const auto& t = play.timing;
    const auto& s = play.score;
    const auto candidates = static_cast<double>(play.work.candidates);
    fmt::print(
        "{:<20} {:>10.4g} {:>10.4g} {:>10.4g} {:>10.4g} {:>10.4g} {:>7} {:>6} {:>7} {:>9.3g} {:>9} {:>8} {:>5}\n",
        algorithm.traits().name, t.processor_us, t.mean_us, t.p99_us, t.max_us, t.first_us, s.missed, s.wrong,
        s.grazing, play.false_per_true(), percent(candidates, static_cast<double>(play.pairs_in_all)),
        percent(static_cast<double>(play.work.put_off), candidates), s.same_bits ? "yes" : "-");
  }
  for (const auto& [algorithm, play] : plays) {
    if (!play.score.first) continue;
    const scene::WrongPair& wrong = *play.score.first;
    fmt::print("! {}: {} missed, {} wrong; the first: frame {}, bodies {} and {}, distance {:.6g}, {}\n",
               algorithm.traits().name, play.score.missed, play.score.wrong, wrong.frame, wrong.pair.a, wrong.pair.b,
               wrong.truth, wrong.missed ? "not reported" : "reported");
  }
}

nlohmann::ordered_json json_of(const NamedPlay& named) {
  const Play& play = named.play;
  nlohmann::ordered_json json;
  json["algorithm"] = named.algorithm.traits().name;
  json["version"] = named.algorithm.traits().version;
  json["processor_us"] = play.timing.processor_us;
  json["mean_us"] = play.timing.mean_us;
  json["p99_us"] = play.timing.p99_us;
  json["max_us"] = play.timing.max_us;
  json["first_us"] = play.timing.first_us;
  json["prepare_s"] = play.timing.prepare_s;
  json["missed"] = play.score.missed;
  json["wrong"] = play.score.wrong;
  json["grazing"] = play.score.grazing;
  json["largest_error"] = play.score.largest_error;
  json["same_bits"] = play.score.same_bits;
  json["hash"] = play.score.hash;
  json["false_per_true"] = play.false_per_true();
  json["candidates"] = play.work.candidates;
  json["put_off"] = play.work.put_off;
  json["narrow"] = play.work.narrow;
  json["triangles"] = play.work.triangles;
  json["pairs_in_all"] = play.pairs_in_all;
  json["bytes"] = play.bytes;
  if (const auto& first = play.score.first) {
    json["first_wrong"] = {{"frame", first->frame},
                           {"bodies", {first->pair.a, first->pair.b}},
                           {"distance", first->truth},
                           {"missed", first->missed}};
  }
  return json;
}

std::vector<NamedPlay> play_all(const Scene& scene, Question question, const Truth& truth,
                                const std::vector<const SceneAlgorithm*>& chosen) {
  std::vector<NamedPlay> plays;
  for (const SceneAlgorithm* algorithm : chosen) {
    plays.push_back({*algorithm, scene::play(scene, *algorithm, question, truth, InterruptGuard::requested)});
  }
  return plays;
}

void play(const PlayOptions& options) {
  const Scene scene = scene::load_scene(options.file);
  const scene::SceneAlgorithms all = all_scene_algorithms();
  std::vector<Question> questions;
  for (const std::string& word : options.questions) questions.push_back(scene::parse_question(word));
  for (const Question question : questions) choose(all, options, question);  // refuses before anything is measured
  auto json = nlohmann::ordered_json::array();
  std::string differs;
  parallel::with_threads(options.threads, [&] {
    for (const Question question : questions) {
      const Truth truth = scene::truth_of(scene, question, InterruptGuard::requested);
      const std::vector<NamedPlay> plays = play_all(scene, question, truth, choose(all, options, question));
      nlohmann::ordered_json part{
          {"question", to_string(question)}, {"truth", truth.hash}, {"true_pairs", truth.pairs()}};
      for (const NamedPlay& each : plays) {
        part["algorithms"].push_back(json_of(each));
        if (each.algorithm.traits().own && !each.play.score.same_bits) differs = each.algorithm.traits().name;
      }
      if (!options.json) print_table(scene, question, truth, plays);
      json.push_back(std::move(part));
    }
  });
  if (options.json) fmt::print("{}\n", json_text(json));
  if (!differs.empty()) throw DefectsFound(fmt::format("{} has not the bits of the truth", differs));
}

}  // namespace

void add_scene_play(CLI::App& group) {
  auto* const command = group.add_subcommand("play", "Replay a scene to algorithms: time, work and misses");
  const auto options = std::make_shared<PlayOptions>();
  command->add_option("file", options->file, "Scene")->required();
  command->add_option("--algorithms", options->algorithms, "Names, separated by commas; default: all but references")
      ->delimiter(',');
  command->add_option("--question", options->questions, "touching, near, closest, wrenches; separated by commas")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--threads", options->threads, "Threads of this project's own; 0: as many as there are")
      ->capture_default_str();
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options] { play(*options); });
  add_examples(*command, "sixdof scene play cube.h5 --algorithms exact,all-pairs --question touching,near",
               "sixdof scene play pile.h5 --threads 1",
               "Truth is every pair in every frame by the distance oracle; it is kept in the cache.");
}

}  // namespace sixdof::cli
