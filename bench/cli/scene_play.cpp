#include <algorithm>
#include <charconv>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
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
#include "bench/common/shell_text.h"

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
  std::vector<std::uint32_t> bodies;
  std::string frames;
  unsigned threads = 0;
  bool json = false;
};

/// What is played of the file.
struct Part {
  Scene scene;
  std::size_t first = 0;  ///< Its first frame's number in the file.
};

struct NamedPlay {
  const SceneAlgorithm& algorithm;
  Play play;
  std::string reproduction;  ///< The first wrong answer's command; empty if all are right.
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

/// Frames to play: "F" or "FIRST:LAST", of all if empty.
std::pair<std::size_t, std::size_t> parse_frames(const std::string& text, const Scene& scene) {
  if (text.empty()) return {0, scene.frames.size() - 1};
  const std::size_t colon = text.find(':');
  const auto parse = [&](std::string_view number) {
    std::size_t frame = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), frame);
    if (error == std::errc() && end == number.data() + number.size() && !number.empty()) return frame;
    throw BadArgument(fmt::format("--frames {}: give a frame, or FIRST:LAST", text));
  };
  const std::string_view view = text;
  if (colon == std::string::npos) return {parse(view), parse(view)};
  return {parse(view.substr(0, colon)), parse(view.substr(colon + 1))};
}

/// The shortest command that shows a wrong answer again: of the two bodies in that frame alone, or of all up to it.
std::string reproduction(const Part& part, const PlayOptions& options, Question question,
                         const SceneAlgorithm& algorithm, const scene::WrongPair& wrong) {
  std::string command = fmt::format("sixdof scene play {} --question {} --algorithms {}", shell_quoted(options.file),
                                    to_string(question), algorithm.traits().name);
  const std::vector<std::uint32_t> bodies{wrong.pair.a, wrong.pair.b};
  const Scene two = scene::excerpt(part.scene, bodies, wrong.frame, wrong.frame);
  const Truth truth = scene::truth_of(two, question);
  if (scene::play(two, algorithm, question, truth).score.failed()) {
    return fmt::format("{} --bodies {},{} --frames {}", command, wrong.pair.a, wrong.pair.b, part.first + wrong.frame);
  }
  if (!options.bodies.empty()) command += fmt::format(" --bodies {}", fmt::join(options.bodies, ","));
  return fmt::format("{} --frames {}:{}", command, part.first, part.first + wrong.frame);
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
  for (const auto& [algorithm, play, again] : plays) {
    const auto& t = play.timing;
    const auto& s = play.score;
    const auto candidates = static_cast<double>(play.work.candidates);
    fmt::print(
        "{:<20} {:>10.4g} {:>10.4g} {:>10.4g} {:>10.4g} {:>10.4g} {:>7} {:>6} {:>7} {:>9.3g} {:>9} {:>8} {:>5}\n",
        algorithm.traits().name, t.processor_us, t.mean_us, t.p99_us, t.max_us, t.first_us, s.missed, s.wrong,
        s.grazing, play.false_per_true(), percent(candidates, static_cast<double>(play.pairs_in_all)),
        percent(static_cast<double>(play.work.put_off), candidates), s.same_bits ? "yes" : "-");
  }
  for (const auto& [algorithm, play, again] : plays) {
    if (!play.score.first) continue;
    const scene::WrongPair& wrong = *play.score.first;
    fmt::print("! {}: {} missed, {} wrong; the first: frame {}, bodies {} and {}, distance {:.6g}, {}\n  {}\n",
               algorithm.traits().name, play.score.missed, play.score.wrong, wrong.frame, wrong.pair.a, wrong.pair.b,
               wrong.truth, wrong.missed ? "not reported" : "reported", again);
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
                           {"missed", first->missed},
                           {"reproduction", named.reproduction}};
  }
  return json;
}

std::vector<NamedPlay> play_all(const Part& part, const PlayOptions& options, Question question, const Truth& truth,
                                const std::vector<const SceneAlgorithm*>& chosen) {
  std::vector<NamedPlay> plays;
  for (const SceneAlgorithm* algorithm : chosen) {
    NamedPlay& last = plays.emplace_back(
        NamedPlay{*algorithm, scene::play(part.scene, *algorithm, question, truth, InterruptGuard::requested), ""});
    if (const auto& wrong = last.play.score.first) {
      last.reproduction = reproduction(part, options, question, *algorithm, *wrong);
      // Frames are those of the file.
      last.play.score.first->frame += part.first;
    }
  }
  return plays;
}

void play(const PlayOptions& options) {
  Part part{.scene = scene::load_scene(options.file)};
  if (!options.frames.empty() || !options.bodies.empty()) {
    const auto [first, last] = parse_frames(options.frames, part.scene);
    part = {.scene = scene::excerpt(part.scene, options.bodies, first, last), .first = first};
  }
  const Scene& scene = part.scene;
  const scene::SceneAlgorithms all = all_scene_algorithms();
  std::vector<Question> questions;
  for (const std::string& word : options.questions) questions.push_back(scene::parse_question(word));
  for (const Question question : questions) choose(all, options, question);  // refuses before anything is measured
  auto json = nlohmann::ordered_json::array();
  std::string differs;
  parallel::with_threads(options.threads, [&] {
    for (const Question question : questions) {
      const Truth truth = scene::truth_of(scene, question, InterruptGuard::requested);
      const std::vector<NamedPlay> plays = play_all(part, options, question, truth, choose(all, options, question));
      nlohmann::ordered_json answers{
          {"question", to_string(question)}, {"truth", truth.hash}, {"true_pairs", truth.pairs()}};
      for (const NamedPlay& each : plays) {
        answers["algorithms"].push_back(json_of(each));
        if (each.algorithm.traits().own && !each.play.score.same_bits) differs = each.algorithm.traits().name;
      }
      if (!options.json) print_table(scene, question, truth, plays);
      json.push_back(std::move(answers));
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
  command->add_option("--bodies", options->bodies, "Identifiers, separated by commas: only these bodies")
      ->delimiter(',');
  command->add_option("--frames", options->frames, "F or FIRST:LAST, from 0: only these frames");
  command->add_option("--threads", options->threads, "Threads of this project's own; 0: as many as there are")
      ->capture_default_str();
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options] { play(*options); });
  add_examples(*command, "sixdof scene play cube.h5 --algorithms exact,all-pairs --question touching,near",
               "sixdof scene play pile.h5 --threads 1",
               "Truth is every pair in every frame by the distance oracle; it is kept in the cache.");
}

}  // namespace sixdof::cli
