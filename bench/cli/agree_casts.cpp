#include "bench/cli/agree.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/base/own_command.h>
#include "bench/cli/shared.h"
#include "bench/common/interrupt.h"
#include "bench/common/json_text.h"
#include "bench/common/rivals.h"
#include "bench/common/run_guarded.h"
#include "bench/common/study_progress.h"
#include "bench/harness/options.h"
#include "bench/study/cast_agreement.h"
#include "bench/study/study_pairs.h"

namespace sixdof::cli {
namespace {

using Json = nlohmann::ordered_json;
using study::AskedAlgorithm;
using study::CastAnswers;
using study::CastDifference;
using study::PairCasts;

/// Those of --algorithms, or all about meshes that answer casts but `null` and rivals.
std::vector<AskedAlgorithm> chosen_algorithms(const Registry& registry, const AgreeArguments& arguments) {
  const auto settings = bench::parse_parameters(arguments.parameters, registry);
  std::vector<AskedAlgorithm> chosen;
  const auto add = [&](const Algorithm& algorithm) {
    const bool is_new = std::ranges::find(chosen, &algorithm, &AskedAlgorithm::algorithm) == chosen.end();
    if (is_new) chosen.push_back({&algorithm, settings.at(algorithm.traits().name)});
  };
  const auto suits = [](const Traits& traits) { return traits.answers.cast && traits.body == Body::mesh; };
  for (const std::string& name : with_rivals(arguments.algorithms, registry, suits)) {
    const Algorithm& algorithm = registry.find(name);
    if (!suits(algorithm.traits())) throw BadArgument(name + " answers no first contacts of meshes");
    add(algorithm);
  }
  if (!arguments.algorithms.empty()) return chosen;
  for (const auto& algorithm : registry.all()) {
    const Traits& traits = algorithm->traits();
    if (suits(traits) && traits.timed && !traits.is_rival() && traits.name != "null") add(*algorithm);
  }
  return chosen;
}

std::string motion_text(MotionKind kind, double percent) { return fmt::format("{} {} %", to_string(kind), percent); }

Json as_json(const CastAnswers& answers) {
  Json json{{"algorithm", answers.algorithm}, {"motion", to_string(answers.kind)}, {"percent", answers.percent}};
  for (const auto& [name, value] : answers.counts.values()) json[name] = value;
  return json;
}

Json as_json(const CastDifference& difference) {
  return {{"algorithm", difference.algorithm},
          {"motion", to_string(difference.kind)},
          {"percent", difference.percent},
          {"place", difference.place},
          {"verdict", to_string(difference.verdict)},
          {"answer", difference.answer},
          {"truth", difference.truth},
          {"command", difference.command}};
}

Json as_json(const PairCasts& pair) {
  Json answers = Json::array(), differences = Json::array();
  for (const CastAnswers& each : pair.answers) answers.push_back(as_json(each));
  for (const CastDifference& each : pair.differences) differences.push_back(as_json(each));
  return {{"pair", pair.pair},
          {"refusals", pair.refusals},
          {"answers", std::move(answers)},
          {"differences", std::move(differences)}};
}

void print_totals(const PairCasts& pair) {
  const std::vector<CastAnswers> totals = pair.totals();
  const std::size_t asked = totals.empty() ? 0 : totals.front().counts.asked;
  fmt::print("{}: {} motions of {} kinds and steps\n", pair.pair, asked, study::k_cast_groups);
  fmt::print("  {:<16} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>10} {:>10}\n", "algorithm", "hits", "missed",
             "late", "phantom", "at start", "early", "failed", "most late", "most early");
  for (const CastAnswers& each : totals) {
    const bench::CastCounts& counts = each.counts;
    fmt::print("  {:<16} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>10.1e} {:>10.1e}\n", each.algorithm, counts.hits,
               counts.count(ImpactVerdict::missed), counts.count(ImpactVerdict::late),
               counts.count(ImpactVerdict::phantom), counts.count(ImpactVerdict::false_contact),
               counts.count(ImpactVerdict::early), counts.count(ImpactVerdict::failed), counts.late_max,
               counts.early_max);
  }
  for (const std::string& refusal : pair.refusals) fmt::print("  left out: {}\n", refusal);
}

/// The differences of one algorithm, kind, step and verdict: how many, and the first of them as commands.
void print_differences(const PairCasts& pair, std::size_t show) {
  using Key = std::tuple<std::string, MotionKind, double, ImpactVerdict>;
  std::map<Key, std::vector<const CastDifference*>> groups;
  for (const CastDifference& each : pair.differences) {
    groups[{each.algorithm, each.kind, each.percent, each.verdict}].push_back(&each);
  }
  for (const auto& [key, list] : groups) {
    const auto& [algorithm, kind, percent, verdict] = key;
    fmt::print("  {} {}: {} {}\n", algorithm, motion_text(kind, percent), list.size(), to_string(verdict));
    for (std::size_t i = 0; i < std::min(show, list.size()); ++i) {
      fmt::print("    {} instead of {}: {}\n", list[i]->answer, list[i]->truth, list[i]->command);
    }
  }
}

}  // namespace

void agree_casts(const AgreeArguments& arguments) {
  Registry registry;
  register_all_algorithms(registry, arguments.process);
  const std::vector<AskedAlgorithm> algorithms = chosen_algorithms(registry, arguments);
  bench::Options options{.program = "sixdof", .sample = arguments.sample, .seed = arguments.seed};
  for (const std::string& set : arguments.sets) options.sets.emplace_back(set);
  if (arguments.sets.empty()) options.manifest = bench::default_manifest();
  study::StudyPairs pairs(std::move(options), arguments.pairs);
  Json json{
      {"seed", arguments.seed}, {"sample", arguments.sample}, {"algorithms", Json::array()}, {"pairs", Json::array()}};
  for (const AskedAlgorithm& asked : algorithms) {
    const Traits& traits = asked.algorithm->traits();
    json["algorithms"].push_back(
        {{"name", traits.name}, {"version", traits.version}, {"settings", asked.settings.to_string()}});
  }
  StudyProgress progress(own_command("sixdof agree"));
  const std::size_t steps = study::k_cast_groups * algorithms.size(), total = steps * pairs.pairs().size();
  progress.begin(
      fmt::format("pairs: {}, algorithms: {}; a step is one algorithm on one kind and length of motion: {} steps",
                  pairs.pairs().size(), algorithms.size(), total),
      static_cast<double>(total));
  std::size_t faults = 0, before = 0;
  for (const CatalogueEntry* const entry : pairs.pairs()) {
    const study::MeshWords meshes{pairs.argument(entry->a), pairs.argument(entry->b)};
    const auto step = [&](std::uint64_t done, std::uint64_t) { progress.counted(before + done, total, "steps"); };
    const PairCasts pair = study::compare_casts(pairs.cache(), *entry, meshes, algorithms, arguments.seed,
                                                {.progress = step, .cancelled = InterruptGuard::requested});
    before += steps;
    progress.counted(before, total, "steps");
    for (const std::string& refusal : pair.refusals) progress.leave_out(pair.pair, refusal);
    faults += pair.differences.size();
    if (arguments.json) {
      json["pairs"].push_back(as_json(pair));
      continue;
    }
    print_totals(pair);
    print_differences(pair, arguments.show);
  }
  if (arguments.json) fmt::print("{}\n", json_text(json));
  progress.end();
  if (faults > 0) throw DefectsFound(fmt::format("{} first contacts are wrong or missing", faults));
}

}  // namespace sixdof::cli
