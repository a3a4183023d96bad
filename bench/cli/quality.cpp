#include "bench/cli/quality.h"

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include "bench/algorithms.h"
#include <sixdof/measure/metrics.h>
#include <sixdof/scenario/drawing.h>
#include <sixdof/scenario/evaluation.h>
#include <sixdof/scenario/series_file.h>

namespace sixdof::cli {
namespace {

struct Options {
  std::string scenario;
  std::string algorithm;
  std::vector<std::string> parameters;
  std::vector<std::string> lengths;
  std::size_t samples = k_default_stamps;
  std::string law = "own";
  std::string series;
  std::string drawing;
  bool json = false;
};

void print_json(const Options& options, IdealLaw law, const SeriesStamp& stamp, const Recording& recording,
                const Measures& measures) {
  nlohmann::ordered_json json = {{"scenario", options.scenario}, {"shape", stamp.shape},
                                 {"algorithm", stamp.algorithm}, {"version", stamp.version},
                                 {"settings", stamp.settings},   {"law", to_string(law)},
                                 {"samples", recording.size()}};
  if (!recording.first_failure.empty()) json["first_failure"] = recording.first_failure;
  nlohmann::ordered_json values = nlohmann::ordered_json::object();
  for (const auto& [name, value] : measures) values[name] = value;
  json["measures"] = values;
  fmt::print("{}\n", json.dump(2));
}

void print_text(const Scenario& scenario, IdealLaw law, const SeriesStamp& stamp, const Recording& recording,
                const Measures& measures) {
  fmt::print("scenario   {}: {}\n", scenario.name(), scenario.purpose());
  for (const std::string& rule : scenario.rules()) fmt::print("           {}\n", rule);
  fmt::print("shape      {}\nalgorithm  {} {}\nsettings   {}\nlaw        {}\nsamples    {}\n", stamp.shape,
             stamp.algorithm, stamp.version, stamp.settings.empty() ? "none" : stamp.settings, to_string(law),
             recording.size());
  if (!recording.first_failure.empty()) fmt::print("failure    {}\n", recording.first_failure);
  fmt::print("\n{:<20} {:>14}  {:<15} {:<9} {}\n", "measure", "value", "unit", "better", "what it is");
  for (const auto& [name, value] : measures) {
    const Metric& m = metric(name);
    fmt::print("{:<20} {:>14.6g}  {:<15} {:<9} {}\n", name, value, m.unit, to_string(m.better), m.meaning);
  }
}

void run(const Options& options) {
  Settings shape = scenario_settings(options.scenario);
  shape.set_all(options.lengths);
  const auto scenario = make_scenario(options.scenario, shape);
  if (!options.drawing.empty()) {
    write_file_atomically(options.drawing, draw(*scenario));
    return;
  }
  if (options.algorithm.empty()) throw BadArgument("--algorithm is needed (or --draw)");
  Registry registry;
  register_all_algorithms(registry);
  const Algorithm& algorithm = registry.find(options.algorithm);
  Settings settings = algorithm.settings();
  settings.set_all(options.parameters);
  const Traits& traits = algorithm.traits();
  if (!traits.answers.respond) throw BadArgument(fmt::format("{} gives no response", traits.name));
  const IdealLaw law = parse_ideal_law(options.law, traits.law);

  const auto query = algorithm.prepare(scenario->a(), scenario->b(), settings);
  const Recording recording = record(*scenario, *query, options.samples);
  Measures measures = evaluate(*scenario, recording, law);
  for (const auto& measure : evaluate_jumps(*scenario, *query, recording, law)) measures.push_back(measure);
  const SeriesStamp stamp{traits.name, traits.version, settings.to_string(), shape.to_string()};
  if (!options.series.empty()) write_series(options.series, *scenario, recording, law, stamp, measures);
  if (options.json) {
    print_json(options, law, stamp, recording, measures);
  } else {
    print_text(*scenario, law, stamp, recording, measures);
  }
}

}  // namespace

void add_quality_command(CLI::App& app) {
  auto* const command = app.add_subcommand("quality", "How right is an algorithm's response along a scenario?");
  const auto options = std::make_shared<Options>();
  command->add_option("--scenario", options->scenario, "Ia, Ib, II, III or IV")->required();
  command->add_option("--algorithm", options->algorithm, "Name of an algorithm that gives responses");
  command->add_option("--set", options->parameters, "Parameter of the algorithm, parameter=value; may be repeated");
  command->add_option("--shape", options->lengths, "Length of the scenario, name=value; may be repeated");
  command->add_option("--samples", options->samples, "Time stamps along the path")->capture_default_str();
  command
      ->add_option("--law", options->law,
                   "Ideal to judge by: own (the law the algorithm declares), paper (its printed formula), depth, "
                   "volume, gradient, energy, traction, wall-traction, paper-depth, paper-volume")
      ->capture_default_str();
  command->add_option("-o,--output", options->series, "Write the series to this HDF5 file");
  command->add_option("--draw", options->drawing, "Draw the scenario into this SVG file and do nothing else");
  command->add_flag("--json", options->json, "Print as JSON");
  command->callback([options] { run(*options); });
}

}  // namespace sixdof::cli
