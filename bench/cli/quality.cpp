#include "bench/cli/commands.h"

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/base/own_command.h>
#include <sixdof/base/shell_text.h>
#include <sixdof/measure/metrics.h>
#include <sixdof/results/paper.h>
#include <sixdof/scenario/evaluation.h>
#include <sixdof/scenario/path_settings.h>
#include <sixdof/scenario/scenario.h>
#include "bench/cli/shared.h"
#include "bench/common/json_text.h"

namespace sixdof::cli {
namespace {

std::vector<std::string> law_words() {
  std::vector<std::string> words{"own", "paper"};
  for (const IdealLaw law : all_ideal_laws()) words.emplace_back(to_string(law));
  return words;
}

struct Options {
  std::string scenario;
  AlgorithmOptions algorithm;
  std::vector<std::string> shape;
  std::size_t steps = k_default_steps;
  std::string law = "own";
  std::string series;
  bool json = false;
};

void print_json(const Options& options, IdealLaw law, const SeriesSource& source, const Recording& recording,
                const Measures& measures) {
  nlohmann::ordered_json json = {{"scenario", options.scenario},  {"shape", source.shape},
                                 {"algorithm", source.algorithm}, {"version", source.version},
                                 {"settings", source.settings},   {"law", to_string(law)},
                                 {"steps", recording.size()}};
  if (!recording.first_failure.empty()) json["first_failure"] = recording.first_failure;
  nlohmann::ordered_json values = nlohmann::ordered_json::object();
  for (const auto& [name, value] : measures) values[name] = value;
  json["measures"] = values;
  for (const auto& [scenario, algorithm, measure, value] : results::k_paper_values) {
    const bool is_it = algorithm == source.algorithm && (scenario.empty() || scenario == options.scenario);
    if (is_it) json["paper"][std::string(measure)] = value;
  }
  fmt::print("{}\n", json_text(json));
}

void print_text(const Scenario& scenario, IdealLaw law, const SeriesSource& source, const Recording& recording,
                const Measures& measures) {
  fmt::print("scenario   {}: {}\n", scenario.name(), scenario.description().purpose);
  for (const std::string& rule : scenario.description().rules) fmt::print("           {}\n", rule);
  fmt::print("shape      {}\nalgorithm  {} {}\nsettings   {}\nlaw        {}\nsteps      {}\n", source.shape,
             source.algorithm, source.version, source.settings.empty() ? "none" : source.settings, to_string(law),
             recording.size());
  if (!recording.first_failure.empty()) fmt::print("failure    {}\n", recording.first_failure);
  fmt::print("\n{:<20} {:>14}  {:<15} {:<9} {}\n", "measure", "value", "unit", "better", "meaning");
  for (const auto& [name, value] : measures) {
    const Metric* const metric = find_metric(name);
    if (metric == nullptr) throw Error(fmt::format("{} is not in the table of metrics", name));
    fmt::print("{:<20} {:>14.6g}  {:<15} {:<9} {}\n", name, value, metric->unit, to_string(metric->better),
               metric->meaning);
  }
}

/// The command line, for the file.
std::string command_of(const Options& options) {
  std::string text =
      fmt::format("sixdof quality --scenario {} --algorithm {}", options.scenario, options.algorithm.name);
  for (const std::string& parameter : options.algorithm.parameters) text += " -p " + shell_quoted(parameter);
  for (const std::string& shape : options.shape) text += " --shape " + shell_quoted(shape);
  text += fmt::format(" --steps {} --law {}", options.steps, options.law);
  return own_command(text + process_words(options.algorithm.process));
}

void run(const Options& options) {
  Settings shape = scenario_settings(options.scenario);
  shape.set_all(options.shape);
  const auto scenario = make_scenario(options.scenario, shape);
  if (options.algorithm.name.empty()) throw BadArgument("--algorithm is needed");
  const auto [registry, algorithm, at_default] = select_algorithm(options.algorithm);
  const Settings settings = settings_along(options.scenario, *algorithm, options.algorithm.parameters);
  const Traits& traits = algorithm->traits();
  if (!traits.answers.respond) throw BadArgument(fmt::format("{} gives no response", traits.name));
  const IdealLaw law = parse_ideal_law(options.law, traits);

  const auto query = algorithm->prepare(scenario->a(), scenario->b(), settings);
  const Recording recording = record(*scenario, *query, options.steps);
  Measures measures = evaluate(*scenario, recording, law);
  for (const auto& measure : evaluate_jumps(*scenario, *query, recording, law)) measures.push_back(measure);
  const SeriesSource source{traits.name, traits.version, settings.to_string(), shape.to_string(), command_of(options)};
  if (!options.series.empty()) write_series(options.series, *scenario, recording, law, source, measures);
  options.json ? print_json(options, law, source, recording, measures)
               : print_text(*scenario, law, source, recording, measures);
}

}  // namespace

void add_quality_command(CLI::App& app) {
  auto* const command =
      app.add_subcommand("quality", "Compare the force of an algorithm along a path with the ideal one");
  const auto options = std::make_shared<Options>();
  command->add_option("--scenario", options->scenario, "Two solids and a path of one into the other")
      ->required()
      ->type_name("SCENARIO")
      ->check(words_of(scenario_names()));
  add_algorithm_options(*command, options->algorithm, "An algorithm that gives responses (sixdof algorithms)");
  add_process_options(*command, options->algorithm.process);
  command
      ->add_option("--shape", options->shape,
                   "Parameter of the scenario's solids and path (the line \"shape\" of the output lists them); may be "
                   "repeated")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command->add_option("--steps", options->steps, "Steps along the path")->type_name("N")->capture_default_str();
  command
      ->add_option(
          "--law", options->law,
          "Ideal to compare with: own is the law that the algorithm's wrench tends to with increasing resolution, "
          "or that it declares; paper is the formula printed in the paper")
      ->type_name("LAW")
      ->check(words_of(law_words()))
      ->capture_default_str();
  command->add_option("-o,--output", options->series, "Write the forces along the path to this file (HDF5)")
      ->type_name("FILE");
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options] { run(*options); });
  add_examples(*command, "sixdof quality --scenario II --algorithm vps --steps 100",
               "sixdof quality --scenario III --algorithm ist --shape rotation_degrees=20 --law gradient -o III-ist.h5",
               "Along Ia, II and III ist has a finer resolution than its default, of at most 0.9 ms a query; making it "
               "takes up to a minute, once. -p spheres=10000 sets another.");
}

}  // namespace sixdof::cli
