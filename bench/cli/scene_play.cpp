#include <algorithm>
#include <charconv>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/base/own_command.h>
#include <sixdof/base/parallel.h>
#include <sixdof/base/shell_text.h>
#include <sixdof/scene/scene_file.h>
#include <sixdof/scene/score.h>
#include "bench/cli/scene.h"
#include "bench/cli/scene_play.h"
#include "bench/cli/shared.h"
#include "bench/common/duration.h"
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
using scene::SceneAnswers;

constexpr const char* k_details =
    R"(Questions:
  touching                all pairs of bodies that have a point in common
  near                    all pairs whose surfaces are no further apart than the scene's margin
  closest                 the closest pair
  wrenches                forces and torques by the overlap volume on bodies that touch others
  impacts                 pairs that are apart at the frame before and touch until this one, with the time t, 0 to 1

A body inside another one touches it, as in sixdof query. Libraries look at surfaces only; pairs that they miss for
this reason are counted as nested. Distances are those of surfaces. Open meshes have no inside.

Where a mesh deforms, cpu is also printed by its parts: the update of the meshes and bodies, and the query after it; built
is what exact built anew, in percent of the triangles that deformed.

Times are means per frame: cpu is the processor time of all threads, wall the elapsed time. The first frame, in which
all pairs are new, has a column of its own and is not in the means unless the scene has no other. * marks the least
cpu among the algorithms without faults. ! marks missed or wrong pairs, with a command that shows the first of them
again. Differences for bodies that just touch (grazing), and nested pairs, are not faults. Algorithms that do not
answer a question are left out, with a message. The truth is every pair in every frame, by the distance oracle; it is
kept in the cache.

Columns of --list: question, algorithm, frame; for a pair body, other and their distance (in the meshes' unit; of
impacts t); for a wrench body, force fx, fy, fz and torque tx, ty, tz about the centre of the body's box, in the world's frame. --list
--json: an array with an object for each question, algorithm and frame.)";

struct NamedPlay {
  const SceneAlgorithm& algorithm;
  Play play;
  std::string command;       ///< That plays it again.
  std::string reproduction;  ///< The first wrong answer's command; empty if all are right.
};

/// The answers to one question.
struct Played {
  Question question;
  SceneAnswers truth;
  std::vector<NamedPlay> plays;
  std::vector<LeftOut> left_out;
};

/// Those that were named, or all but references, as far as they answer the question; who does not is left out.
Asked choose(const scene::SceneAlgorithms& all, const std::vector<std::string>& names, const Scene& scene,
             Question question) {
  Asked asked{.question = question, .algorithms = {}, .left_out = {}};
  for (const std::string& name : names) {
    const SceneAlgorithm& algorithm = scene::find_algorithm(all, name);
    if (!algorithm.traits().answers_to(question)) {
      asked.left_out.push_back({name, "does not answer this question"});
    } else if (scene.deforms() && !algorithm.traits().deforms) {
      asked.left_out.push_back({name, "does not take scenes in which a mesh deforms"});
    } else {
      asked.algorithms.push_back(&algorithm);
    }
  }
  if (!names.empty()) return asked;
  for (const auto& algorithm : all) {
    const scene::SceneTraits& traits = algorithm->traits();
    if (traits.is_default_for(scene) && traits.answers_to(question)) asked.algorithms.push_back(algorithm.get());
  }
  return asked;
}

bool has_faults(const NamedPlay& named) {
  return named.play.score.failed() || (named.algorithm.traits().own && !named.play.score.same_bits);
}

/// The least processor time of a frame among those without faults; null if all have some.
const NamedPlay* find_fastest(const std::vector<NamedPlay>& plays) {
  const NamedPlay* fastest = nullptr;
  for (const NamedPlay& each : plays) {
    if (has_faults(each)) continue;
    if (fastest == nullptr || each.play.timing.processor_us < fastest->play.timing.processor_us) fastest = &each;
  }
  return fastest;
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

/// `sixdof scene play ...` of one algorithm, without --bodies and --frames.
std::string play_command(const PlayOptions& options, Question question, const SceneAlgorithm& algorithm) {
  return own_command(fmt::format("sixdof scene play {} --question {} --algorithms {}", shell_quoted(options.file),
                                 to_string(question), algorithm.traits().name));
}

/// The shortest command that shows a wrong answer again: of the two bodies in that frame alone, or of all up to it.
std::string reproduction(const Part& part, const PlayOptions& options, Question question,
                         const SceneAlgorithm& algorithm, const scene::WrongPair& wrong) {
  std::string command = play_command(options, question, algorithm);
  const std::vector<std::uint32_t> bodies{wrong.pair.a, wrong.pair.b};
  const Scene two = scene::excerpt(part.scene, bodies, wrong.frame, wrong.frame);
  const SceneAnswers truth = scene::truth_of(two, question);
  if (scene::play(two, algorithm, question, truth).score.failed()) {
    return fmt::format("{} --bodies {},{} --frames {}", command, wrong.pair.a, wrong.pair.b, part.first + wrong.frame);
  }
  if (!options.bodies.empty()) command += fmt::format(" --bodies {}", fmt::join(options.bodies, ","));
  return fmt::format("{} --frames {}:{}", command, part.first, part.first + wrong.frame);
}

/// Of all deformations of all frames.
double number_of_deformed_triangles(const Scene& scene) {
  std::size_t sum = 0;
  for (const auto& frame : scene.deformations) {
    for (const scene::Deformation& each : frame) sum += scene.meshes[each.mesh]->triangles().size();
  }
  return static_cast<double>(sum);
}

void print_table(const Scene& scene, const Played& played) {
  fmt::print("{}, {}: {} bodies, {} {}, {} true pairs in all frames, truth {}\n",
             scene.name.empty() ? "scene" : scene.name, to_string(played.question), scene.bodies.size(),
             scene.frames.size(), scene.frames.size() == 1 ? "frame" : "frames", played.truth.pairs(),
             played.truth.hash);
  constexpr const char* k_line =
      "{:<22} {:>9} {:>9} {:>9} {:>9} {:>9} {:>7} {:>6} {:>7} {:>7} {:>9} {:>9} {:>8} {:>5}\n";
  fmt::print(k_line, "", "cpu", "wall", "p99", "max", "first", "missed", "wrong", "grazing", "nested", "false per",
             "looked at", "put off", "same");
  fmt::print(k_line, "  algorithm", "per frame", "per frame", "", "", "frame", "", "", "", "", "true pair", "of all, %",
             "of th., %", "bits");
  const auto time = [](double us) { return duration_text(1e-6 * us); };
  const NamedPlay* const fastest = find_fastest(played.plays);
  for (const NamedPlay& each : played.plays) {
    const auto& t = each.play.timing;
    const auto& s = each.play.score;
    const auto candidates = static_cast<double>(each.play.work.candidates);
    const char* const mark = has_faults(each) ? "!" : &each == fastest ? "*" : " ";
    fmt::print(k_line, fmt::format("{} {}", mark, each.algorithm.traits().name), time(t.processor_us), time(t.mean_us),
               time(t.p99_us), time(t.max_us), time(t.first_us), s.missed, s.wrong, s.grazing, s.nested,
               fmt::format("{:.3g}", each.play.false_per_true()),
               percent(candidates, static_cast<double>(each.play.pairs_in_all)),
               percent(static_cast<double>(each.play.work.put_off), candidates), s.same_bits ? "yes" : "-");
  }
  if (scene.deforms()) {
    fmt::print("{:<22} {:>9} {:>9} {:>9} {:>9}\n", "", "cpu", "update", "query", "built, %");
    for (const NamedPlay& each : played.plays) {
      const double triangles = number_of_deformed_triangles(scene);
      fmt::print("  {:<20} {:>9} {:>9} {:>9} {:>9}\n", each.algorithm.traits().name,
                 time(each.play.timing.processor_us), time(each.play.timing.update_us),
                 time(each.play.timing.answer_us),
                 each.algorithm.traits().own ? percent(static_cast<double>(each.play.work.built), triangles) : "");
    }
  }
  for (const NamedPlay& each : played.plays) {
    const auto& s = each.play.score;
    if (!s.first) continue;
    const scene::WrongPair& wrong = *s.first;
    fmt::print("! {}: {} missed, {} wrong; the first: frame {}, bodies {} and {}, distance {:.6g}, {}\n  {}\n",
               each.algorithm.traits().name, s.missed, s.wrong, wrong.frame, wrong.pair.a, wrong.pair.b, wrong.truth,
               wrong.missed ? "not reported" : "reported", each.reproduction);
  }
  for (const NamedPlay& each : played.plays) {
    if (each.play.work.undecided == 0) continue;
    fmt::print("- {}: {} undecided: bodies pass each other more closely than a thousandth of their motion\n",
               each.algorithm.traits().name, each.play.work.undecided);
  }
  for (const auto& [algorithm, reason] : played.left_out) fmt::print("- {}: left out: {}\n", algorithm, reason);
}

nlohmann::ordered_json json_of(const NamedPlay& named, bool is_fastest) {
  const Play& play = named.play;
  nlohmann::ordered_json json;
  json["algorithm"] = named.algorithm.traits().name;
  json["command"] = named.command;
  json["version"] = named.algorithm.traits().version;
  json["fastest"] = is_fastest;
  json["processor_us"] = play.timing.processor_us;
  json["mean_us"] = play.timing.mean_us;
  json["p99_us"] = play.timing.p99_us;
  json["max_us"] = play.timing.max_us;
  json["first_us"] = play.timing.first_us;
  json["update_us"] = play.timing.update_us;
  json["answer_us"] = play.timing.answer_us;
  json["prepare_s"] = play.timing.prepare_s;
  json["missed"] = play.score.missed;
  json["wrong"] = play.score.wrong;
  json["grazing"] = play.score.grazing;
  json["nested"] = play.score.nested;
  json["largest_error"] = play.score.largest_error;
  json["same_bits"] = play.score.same_bits;
  json["hash"] = play.score.hash;
  json["false_per_true"] = play.false_per_true();
  json["candidates"] = play.work.candidates;
  json["put_off"] = play.work.put_off;
  json["narrow"] = play.work.narrow;
  json["triangles"] = play.work.triangles;
  json["built"] = play.work.built;
  json["undecided"] = play.work.undecided;
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

nlohmann::ordered_json json_of(const Played& played) {
  nlohmann::ordered_json json{{"question", to_string(played.question)},
                              {"truth", played.truth.hash},
                              {"true_pairs", played.truth.pairs()},
                              {"algorithms", nlohmann::ordered_json::array()},
                              {"left_out", nlohmann::ordered_json::array()}};
  const NamedPlay* const fastest = find_fastest(played.plays);
  for (const NamedPlay& each : played.plays) json["algorithms"].push_back(json_of(each, &each == fastest));
  for (const auto& [algorithm, reason] : played.left_out) {
    json["left_out"].push_back({{"algorithm", algorithm}, {"reason", reason}});
  }
  return json;
}

NamedPlay play_one(const Part& part, const PlayOptions& options, Question question, const SceneAnswers& truth,
                   const SceneAlgorithm& algorithm) {
  NamedPlay named{.algorithm = algorithm,
                  .play = scene::play(part.scene, algorithm, question, truth, InterruptGuard::requested),
                  .command = play_command(options, question, algorithm),
                  .reproduction = {}};
  if (!options.bodies.empty()) named.command += fmt::format(" --bodies {}", fmt::join(options.bodies, ","));
  if (!options.frames.empty()) named.command += fmt::format(" --frames {}", options.frames);
  if (auto& wrong = named.play.score.first) {
    named.reproduction = reproduction(part, options, question, algorithm, *wrong);
    wrong->frame += part.first;  // frames are those of the file
  }
  return named;
}

/// Asks every algorithm. One that cannot answer this scene is left out; all are, if there is no truth.
Played play_question(const Part& part, const PlayOptions& options, const Asked& asked) {
  Played played{.question = asked.question, .truth = {}, .plays = {}, .left_out = asked.left_out};
  if (asked.algorithms.empty()) return played;
  try {
    played.truth = scene::truth_of(part.scene, asked.question, InterruptGuard::requested);
  } catch (const BadMesh& e) {
    for (const SceneAlgorithm* each : asked.algorithms) played.left_out.push_back({each->traits().name, e.what()});
    return played;
  }
  for (const SceneAlgorithm* algorithm : asked.algorithms) {
    try {
      played.plays.push_back(play_one(part, options, asked.question, played.truth, *algorithm));
    } catch (const Interrupted&) {
      throw;
    } catch (const Error& e) {
      if (algorithm->traits().own) throw;
      played.left_out.push_back({algorithm->traits().name, e.what()});
    }
  }
  return played;
}

void judge(const Part& part, const PlayOptions& options, const std::vector<Asked>& asked) {
  auto json = nlohmann::ordered_json::array();
  std::string differs, left_out;
  bool has_answers = false;
  for (const Asked& each : asked) {
    const Played played = play_question(part, options, each);
    for (const NamedPlay& named : played.plays) {
      if (named.algorithm.traits().own && !named.play.score.same_bits) differs = named.algorithm.traits().name;
    }
    has_answers = has_answers || !played.plays.empty();
    if (!played.left_out.empty()) {
      left_out = fmt::format("{}: {}: {}", to_string(played.question), played.left_out.front().algorithm,
                             played.left_out.front().reason);
    }
    options.json ? json.push_back(json_of(played)) : print_table(part.scene, played);
  }
  if (options.json) fmt::print("{}\n", json_text(json));
  if (!has_answers) throw BadArgument("no question has an answer; " + left_out);
  if (!differs.empty()) throw DefectsFound(fmt::format("answers differ from the truth in some bits: {}", differs));
}

void play(const PlayOptions& options) {
  Part part{.scene = scene::load_scene(options.file)};
  if (!options.frames.empty() || !options.bodies.empty()) {
    const auto [first, last] = parse_frames(options.frames, part.scene);
    part = {.scene = scene::excerpt(part.scene, options.bodies, first, last), .first = first};
  }
  const scene::SceneAlgorithms all = all_scene_algorithms();
  std::vector<std::string> names = options.algorithms;
  if (names.empty() && options.list) names = {"exact"};
  std::vector<Asked> asked;
  for (const std::string& word : options.questions) {
    asked.push_back(choose(all, names, part.scene, scene::parse_question(word)));
  }
  parallel::with_threads(options.threads,
                         [&] { options.list ? list_answers(part, asked, options.json) : judge(part, options, asked); });
}

}  // namespace

void add_scene_play(CLI::App& group) {
  auto* const command =
      group.add_subcommand("play", "Measure algorithms on a scene: time, work and missed pairs; or print the pairs");
  const auto options = std::make_shared<PlayOptions>();
  std::vector<std::string> questions;
  for (const Question question : scene::k_questions) questions.emplace_back(to_string(question));
  command->add_option("file", options->file, "The scene (HDF5)")->required()->type_name("FILE");
  command->add_option("--algorithms", options->algorithms, "Algorithms to ask: exact,fcl-hash,...")
      ->type_name("PAIR-FINDER")
      ->delimiter(',')
      ->default_str("all but references; with --list, exact");
  command->add_option("--question", options->questions, "What is asked in each frame (below): touching,near")
      ->type_name("QUESTION")
      ->check(words_of(questions))
      ->delimiter(',')
      ->capture_default_str();
  command->add_flag("--list", options->list,
                    "Print pairs, distances and wrenches of each frame instead of times, as CSV or with --json");
  command->add_option("--bodies", options->bodies, "Only these bodies, by their identifiers: 3,17")
      ->type_name("ID")
      ->delimiter(',')
      ->default_str("all");
  command->add_option("--frames", options->frames, "Only these frames, from 0: 12, or 12:20")
      ->type_name("FRAMES")
      ->default_str("all");
  command->add_option("--threads", options->threads, "Threads of sixdof's own algorithms; 0: as many as there are")
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options] { play(*options); });
  add_examples(*command, "sixdof scene play cube.h5 --algorithms exact,all-pairs --question touching,near",
               "sixdof scene play cube.h5 --question near --frames 2 --list", k_details);
}

}  // namespace sixdof::cli
