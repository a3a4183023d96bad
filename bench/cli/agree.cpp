#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/base/own_command.h>
#include "bench/cli/agree.h"
#include "bench/cli/commands.h"
#include "bench/cli/shared.h"
#include "bench/cli/study_options.h"
#include "bench/common/interrupt.h"
#include "bench/common/json_text.h"
#include "bench/common/rivals.h"
#include "bench/common/run_guarded.h"
#include "bench/common/study_progress.h"
#include "bench/harness/options.h"
#include "bench/study/set_agreement.h"
#include "bench/study/study_pairs.h"

namespace sixdof::cli {
namespace {

using study::AnswerCounts;
using study::AskedAlgorithm;
using study::Difference;
using study::PairAgreement;

constexpr const char* k_keys =
    "An answer differs if it contradicts the set: yes at a distance, no at an overlap, or a distance whose error\n"
    "is larger than the set's tolerance plus 1e-9 of A's diagonal. For touching bodies (0 %) both yes and no are\n"
    "right. A missing answer counts as a difference. Algorithms about convex hulls are compared with exact on the\n"
    "hulls. Exit code 3 if any answer differs.\n"
    "Keys of --json: seed, sample, algorithms[] {name, version, settings}, pairs[] {pair, refusals[], buckets[]\n"
    "{bucket, configurations, split, algorithms[] {algorithm, yes, judged_collide, wrong_collide, judged_distance,\n"
    "wrong_distance, failed, largest_distance_error}}, differences[] {algorithm, bucket, cell, question, answer, "
    "truth,\n"
    "pose, command}}. split: configurations where some algorithms say yes and others no.\n"
    "With --question cast B moves from the poses of contact (0 %), by 0.01 to 100 % of A's diagonal. A contact that "
    "is\n"
    "missed, late, or none (phantom; at start) is a fault, beyond 1e-9 of A's diagonal; an early one is counted.\n"
    "pairs[] {pair, refusals[], answers[] {algorithm, motion, percent, hits, missed_hits, late_hits, late_max, early,\n"
    "early_max, ...}, differences[] {algorithm, motion, percent, place, verdict, answer, truth, command}}.";

/// Those of --algorithms, or all of default runs that answer yes/no or distance, but `null`.
std::vector<AskedAlgorithm> chosen_algorithms(const Registry& registry, const AgreeArguments& arguments) {
  const auto settings = bench::parse_parameters(arguments.parameters, registry);
  std::vector<AskedAlgorithm> chosen;
  const auto add = [&](const Algorithm& algorithm) {
    const std::string& name = algorithm.traits().name;
    chosen.push_back({&algorithm, settings.at(name)});
  };
  const auto asked_already = [&](const Algorithm& algorithm) {
    return std::ranges::any_of(chosen, [&](const AskedAlgorithm& each) { return each.algorithm == &algorithm; });
  };
  const auto suits = [](const Traits& traits) { return traits.answers.collide || traits.answers.distance; };
  for (const std::string& name : with_rivals(arguments.algorithms, registry, suits)) {
    const Algorithm& algorithm = registry.find(name);
    const Traits& traits = algorithm.traits();
    if (!traits.answers.collide && !traits.answers.distance) {
      throw BadArgument(name + " answers neither yes/no nor distance");
    }
    if (!asked_already(algorithm)) add(algorithm);
  }
  if (!arguments.algorithms.empty()) return chosen;
  for (const auto& algorithm : registry.all()) {
    const Traits& traits = algorithm->traits();
    const bool answers = traits.answers.collide || traits.answers.distance;
    if (traits.in_default_runs() && traits.name != "null" && answers) add(*algorithm);
  }
  return chosen;
}

using Json = nlohmann::ordered_json;

Json as_json(const AnswerCounts& counts) {
  return {{"algorithm", counts.algorithm},
          {"yes", counts.yes},
          {"judged_collide", counts.judged_collide},
          {"wrong_collide", counts.wrong_collide},
          {"judged_distance", counts.judged_distance},
          {"wrong_distance", counts.wrong_distance},
          {"failed", counts.failed},
          {"largest_distance_error", counts.largest_distance_error}};
}

Json as_json(const Difference& difference) {
  return {{"algorithm", difference.algorithm}, {"bucket", difference.bucket.name()},
          {"cell", difference.cell},           {"question", to_string(difference.question)},
          {"answer", difference.answer},       {"truth", difference.truth},
          {"pose", difference.pose.text()},    {"command", difference.command}};
}

Json as_json(const PairAgreement& pair) {
  Json buckets = Json::array(), differences = Json::array();
  for (const study::BucketAgreement& bucket : pair.buckets) {
    Json algorithms = Json::array();
    for (const AnswerCounts& counts : bucket.algorithms) algorithms.push_back(as_json(counts));
    buckets.push_back({{"bucket", bucket.bucket.name()},
                       {"configurations", bucket.configurations},
                       {"split", bucket.split},
                       {"algorithms", std::move(algorithms)}});
  }
  for (const Difference& difference : pair.differences) differences.push_back(as_json(difference));
  return {{"pair", pair.pair},
          {"refusals", pair.refusals},
          {"buckets", std::move(buckets)},
          {"differences", std::move(differences)}};
}

/// "12 of 400", or "-" where nothing is judged.
std::string share(std::size_t wrong, std::size_t judged) {
  return judged == 0 ? "-" : fmt::format("{} of {}", wrong, judged);
}

void print_totals(const PairAgreement& pair) {
  fmt::print("{}: {} configurations in {} buckets\n", pair.pair, pair.configurations(), pair.buckets.size());
  fmt::print("  {:<16} {:>16} {:>16} {:>8} {:>14}\n", "algorithm", "wrong yes/no", "wrong distance", "failed",
             "largest error");
  for (const AnswerCounts& counts : pair.totals()) {
    const bool distances = counts.judged_distance > 0;
    fmt::print("  {:<16} {:>16} {:>16} {:>8} {:>14}\n", counts.algorithm,
               share(counts.wrong_collide, counts.judged_collide), share(counts.wrong_distance, counts.judged_distance),
               counts.failed, distances ? fmt::format("{:.1e}", counts.largest_distance_error) : "-");
  }
  for (const std::string& refusal : pair.refusals) fmt::print("  left out: {}\n", refusal);
}

/// The differences of one algorithm, bucket and question: how many, and the first of them as commands.
void print_differences(const PairAgreement& pair, std::size_t show) {
  using Key = std::tuple<std::string, BucketKey, bench::QueryKind>;
  std::map<Key, std::vector<const Difference*>> groups;
  for (const Difference& each : pair.differences) {
    groups[{each.algorithm, each.bucket, each.question}].push_back(&each);
  }
  for (const auto& [key, list] : groups) {
    const auto& [algorithm, bucket, question] = key;
    fmt::print("  {} {} {}: {} differ\n", algorithm, bucket.name(), to_string(question), list.size());
    for (std::size_t i = 0; i < std::min(show, list.size()); ++i) {
      fmt::print("    {} instead of {}: {}\n", list[i]->answer, list[i]->truth, list[i]->command);
    }
  }
}

/// A step is one algorithm on one bucket.
class AgreeProgress {
 public:
  AgreeProgress(const study::StudyPairs& pairs, std::size_t algorithms, std::size_t sample)
      : algorithms_(algorithms), progress_(own_command("sixdof agree")) {
    std::size_t buckets = 0;
    for (const CatalogueEntry* const pair : pairs.pairs()) buckets += pair->buckets.size();
    total_ = buckets * algorithms;
    progress_.begin(
        fmt::format("pairs: {}, buckets: {}, algorithms: {}; a step is one algorithm at {} poses of a bucket: {} steps",
                    pairs.pairs().size(), buckets, algorithms, sample == 0 ? "all" : std::to_string(sample), total_),
        static_cast<double>(total_));
  }

  /// @param part of the pair's steps, which are fewer than planned where an algorithm refuses its meshes
  void step(const CatalogueEntry& pair, double part) {
    const auto steps = static_cast<std::size_t>(part * static_cast<double>(pair.buckets.size() * algorithms_));
    progress_.counted(before_ + steps, total_, "steps");
  }

  void end_pair(const CatalogueEntry& pair, const std::vector<std::string>& refusals) {
    before_ += pair.buckets.size() * algorithms_;
    progress_.counted(before_, total_, "steps");
    for (const std::string& refusal : refusals) progress_.leave_out(pair.pair, refusal);
  }

  StudyProgress& lines() { return progress_; }

 private:
  const std::size_t algorithms_;
  StudyProgress progress_;
  std::size_t total_ = 0, before_ = 0;  ///< Steps; before this pair.
};

void agree(const AgreeArguments& arguments) {
  if (arguments.question == "cast") return agree_casts(arguments);
  Registry registry;
  register_all_algorithms(registry, arguments.process);
  const std::vector<AskedAlgorithm> algorithms = chosen_algorithms(registry, arguments);
  bench::Options options{.program = "sixdof", .sample = arguments.sample, .seed = arguments.seed};
  for (const std::string& set : arguments.sets) options.sets.emplace_back(set);
  if (arguments.sets.empty()) options.manifest = bench::default_manifest();
  study::StudyPairs pairs(std::move(options), arguments.pairs);

  Json json{{"seed", arguments.seed}, {"sample", arguments.sample}};
  for (const AskedAlgorithm& asked : algorithms) {
    const Traits& traits = asked.algorithm->traits();
    json["algorithms"].push_back(
        {{"name", traits.name}, {"version", traits.version}, {"settings", asked.settings.to_string()}});
  }
  json["pairs"] = Json::array();
  std::size_t differences = 0;
  AgreeProgress progress(pairs, algorithms.size(), arguments.sample);
  for (const CatalogueEntry* const entry : pairs.pairs()) {
    const study::MeshWords meshes{pairs.argument(entry->a), pairs.argument(entry->b)};
    const auto step = [&](std::uint64_t done, std::uint64_t total) {
      progress.step(*entry, static_cast<double>(done) / static_cast<double>(total));
    };
    const PairAgreement pair = study::compare_with_set(pairs.cache(), *entry, meshes, algorithms,
                                                       {.progress = step, .cancelled = InterruptGuard::requested});
    progress.end_pair(*entry, pair.refusals);
    differences += pair.differences.size();
    if (arguments.json) {
      json["pairs"].push_back(as_json(pair));
      continue;
    }
    print_totals(pair);
    print_differences(pair, arguments.show);
  }
  if (arguments.json) fmt::print("{}\n", json_text(json));
  if (arguments.algorithms.empty()) {
    std::vector<const Algorithm*> asked;
    for (const AskedAlgorithm& each : algorithms) asked.push_back(each.algorithm);
    leave_out_unasked(registry, asked, progress.lines());
  }
  progress.lines().end();
  if (differences > 0) throw DefectsFound(fmt::format("{} answers differ from the sets' truth", differences));
}

}  // namespace

void add_agree_command(CLI::App& app) {
  auto* const command =
      app.add_subcommand("agree", "Compare answers of several algorithms with the truth of configuration sets");
  const auto arguments = std::make_shared<AgreeArguments>();
  auto* const pairs =
      command->add_option("--pair", arguments->pairs, "Pairs of the sets that come with sixdof: elephant,bunny");
  pairs->delimiter(',')->type_name("PAIR")->default_str("all");
  command->add_option("--set", arguments->sets, "A configuration set of your own; may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->excludes(pairs);
  command
      ->add_option("--question", arguments->question,
                   "pose: yes/no and distance; cast: when do the bodies first touch while B moves?")
      ->check(CLI::IsMember({"pose", "cast"}))
      ->type_name("QUESTION")
      ->capture_default_str();
  command
      ->add_option("--algorithms", arguments->algorithms,
                   "Algorithms to compare: exact,ode,...; rivals: all that are set up")
      ->type_name("ALGORITHM")
      ->default_str("all that answer, except slow ones")
      ->delimiter(',');
  command
      ->add_option("-p,--parameter", arguments->parameters,
                   "Parameter of an algorithm (sixdof algorithms lists them); may be repeated")
      ->type_name("ALGORITHM:NAME=VALUE")
      ->allow_extra_args(false);
  command->add_option("--sample", arguments->sample, "Poses per bucket of a set, drawn at random; 0: all")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "Seed of the draw")->type_name("N")->capture_default_str();
  add_process_options(*command, arguments->process);
  command
      ->add_option("--show", arguments->show,
                   "Differences to print of each algorithm, bucket and question; --json has all")
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "As JSON; the exit code is the same");
  add_examples(*command, "sixdof agree --set set.h5 --algorithms exact,fcl-obbrss --sample 20",
               "sixdof agree --set set.h5 --algorithms exact,fcl-kios --sample 0 --json", k_keys);
  command->callback([arguments] { agree(*arguments); });
}

}  // namespace sixdof::cli
