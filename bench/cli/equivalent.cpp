#include "bench/cli/commands.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/base/shell_text.h>
#include <sixdof/process/remote_algorithm.h>
#include <sixdof/results/results.h>
#include <sixdof/scenario/scenario.h>
#include "bench/cli/equivalent_text.h"
#include "bench/cli/shared.h"
#include "bench/common/interrupt.h"
#include "bench/common/json_text.h"
#include "bench/common/progress_line.h"
#include "bench/harness/options.h"
#include "bench/harness/run_context.h"
#include "bench/study/equivalent_rows.h"
#include "bench/study/equivalent_scenario.h"

namespace sixdof::cli {
namespace {

using study::EquivalentResult;

struct Options {
  std::vector<std::string> scenarios = scenario_names();
  std::vector<std::string> algorithms{"vps", "ist"};
  std::vector<std::string> taus{"0.9ms"};
  double reverse = 0.0;  ///< eta; 0: tau is given.
  std::string weights = "sigma=1,gamma=1";
  std::string law = "own";
  std::vector<std::string> parameters;  ///< "ALGORITHM:NAME=VALUE".
  std::vector<std::string> grids;       ///< "NAME=VALUE,VALUE,VALUE".
  double reach = study::k_default_reach;
  double largest_gb = 2.0;
  std::size_t steps = k_default_steps;
  std::string output;
  bool json = false;
  ProcessOptions process{.isolate = "third-party"};
};

double parse_number(const std::string& text, const std::string& context) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) throw BadArgument(fmt::format("{}: \"{}\" is no number", context, text));
  return value;
}

/// "name=rest" in two.
std::pair<std::string, std::string> split(const std::string& text, const char* wanted) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw BadArgument(fmt::format("{}: must read {}", text, wanted));
  return {text.substr(0, equals), text.substr(equals + 1)};
}

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) c == ',' ? (void)parts.emplace_back() : parts.back().push_back(c);
  return parts;
}

study::EtaWeights parse_weights(const std::string& text) {
  study::EtaWeights weights;
  for (const std::string& part : split_list(text)) {
    const auto [name, value] = split(part, "sigma=NUMBER,gamma=NUMBER");
    if (name != "sigma" && name != "gamma") throw BadArgument(fmt::format("--weights: {}: sigma or gamma", name));
    (name == "sigma" ? weights.sigma : weights.gamma) = parse_number(value, "--weights");
  }
  if (!(weights.sigma >= 0.0 && weights.gamma >= 0.0 && weights.sigma + weights.gamma > 0.0)) {
    throw BadArgument(fmt::format("--weights {}: must not be negative, nor both zero", text));
  }
  return weights;
}

study::Grids parse_grids(const std::vector<std::string>& texts) {
  study::Grids grids;
  for (const std::string& text : texts) {
    const auto [name, values] = split(text, "NAME=VALUE,VALUE,VALUE");
    for (const std::string& value : split_list(values)) grids[name].push_back(parse_number(value, "--grid " + text));
  }
  return grids;
}

/// One algorithm and its part of the options.
struct Candidate {
  const Algorithm* algorithm = nullptr;
  std::array<study::ResolutionAxis, 2> axes;
  Settings settings;
};

/// @throws BadArgument if an algorithm cannot be studied, or a parameter or a grid belongs to none
std::vector<Candidate> select(const Options& options, const Registry& registry,
                              const std::map<std::string, Settings>& settings) {
  const study::Grids grids = parse_grids(options.grids);
  std::vector<Candidate> candidates;
  for (const std::string& name : options.algorithms) {
    const Algorithm& algorithm = registry.find(name);
    if (!algorithm.traits().answers.respond) throw BadArgument(fmt::format("{} gives no response", name));
    candidates.push_back(
        {&algorithm, study::resolution_axes(algorithm.traits(), grids, options.reach), settings.at(name)});
  }
  const auto searched = [&](const std::string& parameter, const std::string& algorithm) {
    return std::ranges::any_of(candidates, [&](const Candidate& candidate) {
      const bool meant = algorithm.empty() || algorithm == candidate.algorithm->traits().name;
      return meant && (candidate.axes[0].parameter == parameter || candidate.axes[1].parameter == parameter);
    });
  };
  for (const auto& [name, values] : grids) {
    if (!searched(name, {})) throw BadArgument(fmt::format("--grid {}: no algorithm of the study searches it", name));
  }
  for (const std::string& text : options.parameters) {
    const std::size_t colon = text.find(':');
    const std::string parameter = text.substr(colon + 1, text.find('=') - colon - 1);
    if (searched(parameter, text.substr(0, colon))) {
      throw BadArgument(fmt::format("--parameter {}: {} is searched; --grid sets its values", text, parameter));
    }
  }
  return candidates;
}

/// What the searches of one run are asked for.
std::vector<study::SearchOptions> targets(const Options& options) {
  constexpr double k_gigabyte = 1e9;
  const double largest_bytes = options.largest_gb * k_gigabyte;
  if (options.reverse > 0.0) {
    return {{.goal = study::Goal::eta, .target = options.reverse, .largest_bytes = largest_bytes}};
  }
  std::vector<study::SearchOptions> list;
  for (const std::string& tau : options.taus) {
    list.push_back({.target = study::parse_time_ns(tau), .largest_bytes = largest_bytes});
  }
  return list;
}

/// One search for each target. A resolution is measured once for all of them.
std::vector<EquivalentResult> run_one(const Options& options, const std::string& name, const Candidate& candidate,
                                      StatusLine& line) {
  const auto scenario = make_scenario(name);
  const Traits& traits = candidate.algorithm->traits();
  const IdealLaw law = parse_ideal_law(options.law, traits.law);
  const study::ScenarioStudy study{.scenario = *scenario,
                                   .algorithm = *candidate.algorithm,
                                   .settings = candidate.settings,
                                   .law = law,
                                   .weights = parse_weights(options.weights),
                                   .steps = options.steps};
  std::map<study::Resolution, study::Measurement> known;
  const study::Measure measure = [&](const study::Resolution& at) {
    if (const auto found = known.find(at); found != known.end()) return found->second;
    InterruptGuard::check();
    line.show(fmt::format("{} {}: {}={} {}={}", name, traits.name, candidate.axes[0].parameter, at[0],
                          candidate.axes[1].parameter, at[1]));
    return known[at] = study::measure_scenario(study, candidate.axes, at);
  };
  std::vector<EquivalentResult> results;
  for (const study::SearchOptions& target : targets(options)) {
    results.push_back({.scenario = name,
                       .algorithm = traits.name,
                       .settings = candidate.settings,
                       .law = std::string(to_string(law)),
                       .axes = candidate.axes,
                       .options = target,
                       .search = study::search_equivalent(candidate.axes, target, measure),
                       .isolated = is_isolated(*candidate.algorithm)});
  }
  line.clear();
  return results;
}

std::vector<results::Row> rows_of(const std::vector<EquivalentResult>& results) {
  std::vector<results::Row> rows;
  for (const EquivalentResult& result : results) {
    for (results::Row& row : study::equivalent_rows(result)) rows.push_back(std::move(row));
  }
  return rows;
}

/// Until the study ends, the file says that it is not whole.
void write(const Options& options, nlohmann::ordered_json context, const std::vector<EquivalentResult>& results,
           bool interrupted) {
  if (options.output.empty()) return;
  if (interrupted) context["interrupted"] = "true";
  results::write_rows(options.output, context, rows_of(results));
}

/// What can be checked before anything is measured. @throws BadArgument
void check(const Options& options) {
  for (const std::string& scenario : options.scenarios) scenario_settings(scenario);
  targets(options);
  parse_weights(options.weights);
}

/// The command line, for the context of the result.
std::string arguments_of(const Options& options) {
  std::string text = fmt::format("equivalent --scenario {} --algorithm {}", fmt::join(options.scenarios, ","),
                                 fmt::join(options.algorithms, ","));
  text += options.reverse > 0.0 ? fmt::format(" --reverse {}", options.reverse)
                                : fmt::format(" --tau {}", fmt::join(options.taus, ","));
  for (const std::string& parameter : options.parameters) text += " -p " + shell_quoted(parameter);
  for (const std::string& grid : options.grids) text += " --grid " + shell_quoted(grid);
  text += fmt::format(" --weights {} --law {} --reach {} --memory {} --steps {}", options.weights, options.law,
                      options.reach, options.largest_gb, options.steps);
  return text + process_words(options.process, Options().process);
}

void run(const Options& options) {
  check(options);
  Registry registry;
  register_all_algorithms(registry, options.process);
  const std::map<std::string, Settings> settings = bench::parse_parameters(options.parameters, registry);
  const std::vector<Candidate> candidates = select(options, registry, settings);

  const nlohmann::ordered_json context = bench::run_context(
      {.program = "sixdof", .arguments = arguments_of(options)}, registry, settings);
  std::vector<EquivalentResult> results;
  StatusLine line;
  for (const std::string& scenario : options.scenarios) {
    for (const Candidate& candidate : candidates) {
      for (EquivalentResult& result : run_one(options, scenario, candidate, line)) {
        if (!options.json) print_equivalent(result, options.weights);
        results.push_back(std::move(result));
      }
      std::fflush(stdout);  // into a file, too: the next search may take minutes
      write(options, context, results, true);
    }
  }
  write(options, context, results, false);
  if (!options.json) return print_prediction_errors(results);
  fmt::print("{}\n", json_text(results::document_of(context, rows_of(results))));
}

}  // namespace

void add_equivalent_command(CLI::App& app) {
  auto* const command = app.add_subcommand(
      "equivalent", "Find the resolutions of both bodies with the least error of a force at a given mean time");
  const auto options = std::make_shared<Options>();
  command->add_option("--scenario", options->scenarios, "Two solids and a path (sixdof quality): one or more")
      ->type_name("SCENARIO")
      ->check(words_of(scenario_names()))
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  command->add_option("--algorithm", options->algorithms, "Algorithms with a resolution for each body: one or more")
      ->type_name("ALGORITHM")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  command->add_option("--tau", options->taus, "Mean processor time of a query: 10us, 1ms; one or more")
      ->type_name("TIME")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  command
      ->add_option("--reverse", options->reverse,
                   "Instead of --tau: find the least time at which the error eta (below) is this")
      ->type_name("ETA")
      ->check(CLI::PositiveNumber);
  command->add_option("--weights", options->weights, "Weights of sigma and gamma in the error eta (below)")
      ->type_name("WEIGHT")
      ->capture_default_str();
  command->add_option("--law", options->law, "Ideal to compare with (sixdof quality --help)")
      ->type_name("LAW")
      ->capture_default_str();
  command->add_option("--grid", options->grids, "Values to try of a parameter that is searched; may be repeated")
      ->type_name("NAME=VALUE,VALUE,...")
      ->allow_extra_args(false);
  command
      ->add_option("-p,--parameter", options->parameters,
                   "Fixed value of a parameter that is not searched; may be repeated")
      ->type_name("ALGORITHM:NAME=VALUE")
      ->allow_extra_args(false);
  command->add_option("--reach", options->reach, "Search beyond the grid by this factor on both sides")
      ->type_name("FACTOR")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  command
      ->add_option("--memory", options->largest_gb,
                   "Leave out resolutions predicted to need more memory, in GB; 0: no limit")
      ->type_name("GB")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--steps", options->steps, "Steps along the path")->type_name("N")->capture_default_str();
  add_process_options(*command, options->process);
  command->add_option("-o,--output", options->output, "Write all measurements to this file (JSON)")->type_name("FILE");
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options] { run(*options); });
  add_examples(
      *command,
      "sixdof equivalent --scenario II --algorithm vps --tau 10us --steps 100 "
      "--grid voxel_size=0.03,0.02,0.01 --grid point_spacing=0.03,0.02,0.01",
      "sixdof equivalent --scenario II --algorithm vps --reverse 0.05 --steps 100 "
      "--grid voxel_size=0.03,0.02,0.01 --grid point_spacing=0.03,0.02,0.01 -o equivalent.json",
      "Measures a grid of resolutions, fits time and error, and measures the predicted best one. The error is eta = "
      "w1 sigma + w2 gamma: sigma is the error of the force's magnitude, as a fraction; gamma that of its direction, "
      "in radians; w1 and w2 are the --weights.");
}

}  // namespace sixdof::cli
