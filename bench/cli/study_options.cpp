#include "bench/cli/study_options.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>
#include <sixdof/base/shell_text.h>
#include "bench/common/rivals.h"

namespace sixdof::cli {

void add_study_options(CLI::App& command, StudyOptions& options) {
  auto* const pairs =
      command.add_option("--pair", options.pairs, "Pairs of the sets that come with sixdof: elephant,bunny");
  pairs->delimiter(',')->type_name("PAIR");
  auto* const sets = command.add_option("--set", options.sets, "A configuration set of your own; may be repeated");
  sets->type_name("FILE")->allow_extra_args(false)->excludes(pairs);
  auto* const a = command.add_option("--a", options.a,
                                     "Fixed mesh A, a model's name or a file, instead of --pair: measured on a coarse "
                                     "set that is made in seconds and kept in the cache");
  a->type_name("MESH")->excludes(pairs)->excludes(sets);
  command.add_option("--b", options.b, "Moving mesh B, likewise")
      ->type_name("MESH")
      ->default_str("a copy of A")
      ->needs(a);
  command.add_option("--algorithms", options.algorithms, "Those to try: vps,ist,...; rivals: all set up")
      ->type_name("ALGORITHM")
      ->default_str("all that answer")
      ->delimiter(',');
  command
      .add_option("--params", options.values,
                  "Values of a parameter to try, instead of the algorithm's own; may be repeated, and then every "
                  "combination is tried")
      ->type_name("ALGORITHM:NAME=VALUE,VALUE,...")
      ->allow_extra_args(false);
  command.add_option("--seed", options.seed, "Seed of the random choice of poses")
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--budget", options.budget, "Longest time of the whole study: 90s, 10min")
      ->type_name("TIME")
      ->capture_default_str();
  add_process_options(command, options.process);
  command
      .add_option("-o,--output", options.output, "Write the rows to this JSON file; it is complete after every step")
      ->type_name("FILE");
  command.add_flag("--json", options.json, "Print the rows as JSON");
}

bench::Options harness_options(const StudyOptions& options, std::size_t sample, std::string arguments) {
  if (options.pairs.empty() && options.sets.empty() && options.a.empty()) {
    throw BadArgument("--pair, --set or --a is needed");
  }
  bench::Options harness{.program = "sixdof", .a = options.a, .b = options.b, .sample = sample, .seed = options.seed};
  for (const std::string& set : options.sets) harness.sets.emplace_back(set);
  if (!options.pairs.empty()) harness.manifest = bench::default_manifest();
  harness.arguments = std::move(arguments);
  return harness;
}

std::vector<const Algorithm*> study_algorithms(const Registry& registry, const std::vector<std::string>& names,
                                               bench::QueryKind question) {
  std::vector<const Algorithm*> chosen;
  const auto suits = [&](const Traits& traits) {
    return bench::answers(traits.answers, question) && traits.body == Body::mesh;
  };
  for (const std::string& name : with_rivals(names, registry, suits)) {
    const Algorithm& algorithm = registry.find(name);
    if (!bench::answers(algorithm.traits().answers, question)) {
      throw BadArgument(fmt::format("{} does not answer {}", name, to_string(question)));
    }
    if (algorithm.traits().body != Body::mesh) {
      throw BadArgument(fmt::format("{} answers for the {} of the meshes, which no study compares with others", name,
                                    to_string(algorithm.traits().body)));
    }
    if (std::ranges::find(chosen, &algorithm) == chosen.end()) chosen.push_back(&algorithm);
  }
  if (!names.empty()) return chosen;
  for (const auto& algorithm : registry.all()) {
    const Traits& traits = algorithm->traits();
    if (traits.in_default_runs() && traits.name != "null" && bench::answers(traits.answers, question)) {
      chosen.push_back(algorithm.get());
    }
  }
  return chosen;
}

std::vector<study::SweptValues> swept_values(const StudyOptions& options,
                                             const std::vector<const Algorithm*>& algorithms) {
  std::vector<study::SweptValues> all;
  for (const std::string& text : options.values) {
    study::SweptValues values = study::parse_swept_values(text);
    const bool known =
        std::ranges::any_of(algorithms, [&](const Algorithm* each) { return each->traits().name == values.algorithm; });
    if (!known) throw BadArgument(fmt::format("--params {}: {} is not among the algorithms", text, values.algorithm));
    all.push_back(std::move(values));
  }
  for (const Algorithm* const algorithm : algorithms) static_cast<void>(study::sweep_points(*algorithm, all));
  return all;
}

void require_metric(const std::string& option, const std::string& name, const std::vector<std::string>& known) {
  if (std::ranges::find(known, name) != known.end()) return;
  throw BadArgument(fmt::format("{} {}: must be one of {}", option, name, fmt::join(known, ", ")));
}

void leave_out_unasked(const Registry& registry, const std::vector<const Algorithm*>& asked, StudyProgress& progress) {
  for (const auto& algorithm : registry.all()) {
    if (std::ranges::find(asked, algorithm.get()) != asked.end()) continue;
    const Traits& traits = algorithm->traits();
    std::string why = "does not answer what is asked";
    if (!traits.timed || !traits.by_default) why = "too slow for all; asked where it is named";
    if (traits.body != Body::mesh) why = fmt::format("answers for the {} of the meshes", to_string(traits.body));
    if (traits.is_rival()) why = "a rival; asked where it is named";
    if (traits.name == "null") why = "answers with constants";
    progress.leave_out(traits.name, std::move(why));
  }
}

std::string arguments_of(const std::string& command, const StudyOptions& options) {
  std::string text = command;
  if (!options.pairs.empty()) text += fmt::format(" --pair {}", fmt::join(options.pairs, ","));
  for (const std::string& set : options.sets) text += " --set " + shell_quoted(set);
  if (!options.a.empty()) text += " --a " + shell_quoted(options.a);
  if (!options.b.empty()) text += " --b " + shell_quoted(options.b);
  if (!options.algorithms.empty()) text += fmt::format(" --algorithms {}", fmt::join(options.algorithms, ","));
  for (const std::string& values : options.values) text += " --params " + shell_quoted(values);
  return text + process_words(options.process, StudyOptions().process) +
         fmt::format(" --seed {} --budget {}", options.seed, options.budget);
}

}  // namespace sixdof::cli
