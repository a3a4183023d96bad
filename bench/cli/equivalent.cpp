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

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/base/own_command.h>
#include <sixdof/base/shell_text.h>
#include <sixdof/process/remote_algorithm.h>
#include <sixdof/results/paper.h>
#include <sixdof/results/results.h>
#include <sixdof/scenario/path_settings.h>
#include <sixdof/scenario/scenario.h>
#include "bench/cli/equivalent_text.h"
#include "bench/cli/shared.h"
#include "bench/common/duration.h"
#include "bench/common/json_text.h"
#include "bench/common/study_progress.h"
#include "bench/harness/options.h"
#include "bench/harness/run_context.h"
#include "bench/study/equivalent_run.h"
#include "bench/study/equivalent_scenario.h"

namespace sixdof::cli {
namespace {

struct Options {
  std::vector<std::string> scenarios = scenario_names();
  std::vector<std::string> algorithms{"vps", "ist"};
  std::vector<std::string> taus{"0.9ms"};
  double reverse = 0.0;  ///< eta; 0: tau is given.
  std::string weights = "sigma=1,gamma=1";
  std::string law = "own";
  std::vector<std::string> parameters;  ///< "ALGORITHM:NAME=VALUE".
  std::vector<std::string> grids;       ///< "NAME=VALUE,VALUE,VALUE".
  double reach = 0.0;                   ///< 0: reach_of().
  double largest_gb = 2.0;
  std::size_t steps = k_default_steps;
  bool paper = false;
  std::string budget;  ///< Empty: no limit.
  std::string output;
  bool resume = false, json = false, markdown = false;
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
  std::vector<std::string> assignments;  ///< What the user sets of it.
};

/// In the paper's table counts, such as spheres, are searched up to four times beyond the sweep, since the finest value
/// of the sweep is far faster than the paper's time. Beyond that a pair of bodies takes minutes to pack.
double reach_of(const Options& options, const Traits& traits) {
  const bool counts = std::ranges::any_of(
      traits.parameters, [](const Parameter& parameter) { return parameter.integer && !parameter.sweep.empty(); });
  constexpr double k_reach_of_counts = 4.0;
  if (options.reach > 0.0) return options.reach;
  return options.paper && counts ? k_reach_of_counts : study::k_default_reach;
}

/// @throws BadArgument if an algorithm cannot be studied, or a parameter or a grid belongs to none
std::vector<Candidate> select(const Options& options, const Registry& registry,
                              const std::map<std::string, std::vector<std::string>>& assignments) {
  const study::Grids grids = parse_grids(options.grids);
  std::vector<Candidate> candidates;
  for (const std::string& name : options.algorithms) {
    const Algorithm& algorithm = registry.find(name);
    if (!algorithm.traits().answers.respond) throw BadArgument(fmt::format("{} gives no response", name));
    const double reach = reach_of(options, algorithm.traits());
    candidates.push_back({&algorithm, study::resolution_axes(algorithm.traits(), grids, reach), assignments.at(name)});
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

/// @throws BadArgument if the algorithm cannot be searched
study::SearchTask task_of(const Options& options, const std::string& name, const Candidate& candidate) {
  const std::shared_ptr<const Scenario> scenario = make_scenario(name);
  const Traits& traits = candidate.algorithm->traits();
  const IdealLaw law = parse_ideal_law(options.law, traits);
  study::check_axes(candidate.axes);
  const Settings settings = settings_along(name, *candidate.algorithm, candidate.assignments);
  const auto measure = [scenario, candidate, settings, law, weights = parse_weights(options.weights),
                        steps = options.steps](const study::Resolution& at) {
    const study::ScenarioStudy study{.scenario = *scenario,
                                     .algorithm = *candidate.algorithm,
                                     .settings = settings,
                                     .law = law,
                                     .weights = weights,
                                     .steps = steps};
    return study::measure_scenario(study, candidate.axes, at);
  };
  return {.scenario = name,
          .algorithm = traits.name,
          .settings = settings,
          .law = std::string(to_string(law)),
          .axes = candidate.axes,
          .targets = targets(options),
          .isolated = is_isolated(*candidate.algorithm),
          .with_defaults = options.paper,
          .measure = measure};
}

/// The options on which a measurement depends besides the settings.
std::string measured_with(const Options& options) {
  return fmt::format("--steps {} --weights {} --law {}", options.steps, options.weights, options.law);
}

/// The command line, for the context of the result.
std::string arguments(const Options& options) {
  std::string text = fmt::format("equivalent --scenario {} --algorithm {} {}", fmt::join(options.scenarios, ","),
                                 fmt::join(options.algorithms, ","), measured_with(options));
  text += options.reverse > 0.0 ? fmt::format(" --reverse {}", options.reverse)
                                : fmt::format(" --tau {}", fmt::join(options.taus, ","));
  for (const std::string& grid : options.grids) text += " --grid " + shell_quoted(grid);
  for (const std::string& parameter : options.parameters) text += " -p " + shell_quoted(parameter);
  if (options.reach > 0.0) text += fmt::format(" --reach {}", options.reach);
  text += fmt::format(" --memory {}", options.largest_gb);
  if (options.paper) text += " --paper";
  return text + process_words(options.process, Options().process);
}

class EquivalentCommand {
 public:
  /// @throws BadArgument for what can be checked before anything is measured
  explicit EquivalentCommand(const Options& options)
      : options_(options),
        budget_s_(options.budget.empty() ? StudyProgress::k_no_limit : parse_duration("--budget", options.budget)) {
    for (const std::string& scenario : options.scenarios) scenario_settings(scenario);
    targets(options);
    parse_weights(options.weights);
    register_all_algorithms(registry_, options.process);
    settings_ = bench::parse_parameters(options.parameters, registry_);
    candidates_ = select(options, registry_, bench::parse_assignments(options.parameters, registry_));
  }

  void run() {
    std::vector<study::SearchTask> tasks;
    for (const std::string& scenario : options_.scenarios) {
      for (const Candidate& candidate : candidates_) tasks.push_back(task_of(options_, scenario, candidate));
    }
    // Another rival that is set up must not keep a run from being continued.
    const auto is_asked = [&](const Traits& traits) {
      const auto is_it = [&](const Candidate& each) { return each.algorithm->traits().name == traits.name; };
      return !traits.is_rival() || std::ranges::any_of(candidates_, is_it);
    };
    context_ = bench::run_context(
        {.program = "sixdof", .arguments = arguments(options_), .benchmark_flags = measured_with(options_)}, registry_,
        settings_, is_asked);
    study::MeasurementStore store(context_);
    if (!options_.output.empty()) store.open(options_.output, options_.resume);
    StudyProgress progress(own_command("sixdof equivalent"), budget_s_);
    const study::EquivalentRun searched =
        study::run_searches(tasks, store, progress, [&](const study::EquivalentRun& so_far) {
          print_new(so_far);
          write(so_far, store, true);
        });
    const bool whole = searched.not_searched.empty();
    write(searched, store, !whole);
    if (whole) store.finish();
    print(searched, store);
    progress.end();
    std::fflush(stdout);
  }

 private:
  bool prints_searches() const { return !options_.json && !options_.paper; }

  /// Those that have ended since the last call.
  void print_new(const study::EquivalentRun& searched) {
    if (!prints_searches()) return;
    for (; printed_ < searched.results.size(); ++printed_) {
      print_equivalent(searched.results[printed_], options_.weights);
    }
    std::fflush(stdout);  // into a file, too: the next search may take minutes
  }

  void print(const study::EquivalentRun& searched, const study::MeasurementStore& store) const {
    if (options_.json) return fmt::print("{}\n", json_text(document(searched, store, !searched.not_searched.empty())));
    std::vector<Sheet> sheets = options_.paper ? paper_sheets(paper_lines(searched)) : std::vector<Sheet>();
    if (!searched.results.empty()) sheets.push_back(prediction_sheet(searched.results));
    for (const Sheet& sheet : sheets) fmt::print("{}\n", options_.markdown ? as_markdown(sheet) : as_text(sheet));
    const std::vector<std::string> lines = not_searched_lines(searched.not_searched);
    fmt::print("{}", options_.markdown ? lines_as_markdown(lines) : lines_as_text(lines));
  }

  static std::vector<results::PaperLine> paper_lines(const study::EquivalentRun& searched) {
    return results::paper_lines(study::equal_time_answers(searched.results));
  }

  /// Until the study is whole, the file says that it is not.
  void write(const study::EquivalentRun& searched, const study::MeasurementStore& store, bool interrupted) const {
    if (options_.output.empty()) return;
    write_file_atomically(options_.output, json_text(document(searched, store, interrupted)) + "\n");
  }

  nlohmann::ordered_json document(const study::EquivalentRun& searched, const study::MeasurementStore& store,
                                  bool interrupted) const {
    std::vector<results::Row> rows;
    for (const study::EquivalentResult& result : searched.results) {
      for (results::Row& row : study::equivalent_rows(result)) rows.push_back(std::move(row));
    }
    nlohmann::ordered_json context = context_;
    if (interrupted) context["interrupted"] = "true";
    nlohmann::ordered_json json = results::document_of(context, rows);
    if (options_.paper) json["paper"] = paper_json(paper_lines(searched));
    json["not_searched"] = not_searched_json(searched.not_searched);
    json["measurements"] = store.as_json();
    return json;
  }

  const Options& options_;
  const double budget_s_;
  Registry registry_;
  std::map<std::string, Settings> settings_;
  std::vector<Candidate> candidates_;
  nlohmann::ordered_json context_;
  std::size_t printed_ = 0;
};

/// What --paper changes where the command line does not say otherwise: the searches of the paper, and a time that is
/// its mean query time on a core k_faster times as fast, which is assumed.
void take_paper_defaults(const CLI::App& command, Options& options) {
  constexpr double k_faster = 3.0;
  const auto given = [&](const char* option) { return command.count(option) > 0; };
  if (!given("--scenario")) options.scenarios = {"Ia", "II", "III"};
  if (!given("--tau")) {
    options.taus = {study::time_text(results::k_paper_mean_ns), study::time_text(results::k_paper_mean_ns / k_faster)};
  }
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
  auto* const paper = command->add_flag(
      "--paper", options->paper,
      "The paper's table, with what is worse than printed: Ia, II and III, at 0.9 ms and, for a core three times as "
      "fast (assumed), 0.3 ms; other options change that");
  command->add_flag("--markdown", options->markdown, "That table as Markdown")->needs(paper);
  command
      ->add_option("--reverse", options->reverse,
                   "Instead of --tau: find the least time at which the error eta (below) is this")
      ->type_name("ETA")
      ->check(CLI::PositiveNumber)
      ->excludes(paper);
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
      ->default_str("2; with --paper 4 for counts");
  command
      ->add_option("--memory", options->largest_gb,
                   "Leave out resolutions predicted to need more memory, in GB; 0: no limit")
      ->type_name("GB")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--steps", options->steps, "Steps along the path")->type_name("N")->capture_default_str();
  add_process_options(*command, options->process);
  command->add_option("--budget", options->budget, "Longest time: 90s, 10min; searches that do not fit are named")
      ->type_name("TIME")
      ->default_str("no limit");
  auto* const output =
      command->add_option("-o,--output", options->output, "Write answers and all measurements to this file (JSON)");
  output->type_name("FILE");
  command
      ->add_flag("--resume", options->resume,
                 "Take over what FILE and FILE.journal have of the same command, which broke off or ran out of budget")
      ->needs(output);
  command->add_flag("--json", options->json, "As JSON");
  command->callback([command, options] {
    if (options->paper) take_paper_defaults(*command, *options);
    EquivalentCommand(*options).run();
  });
  add_examples(
      *command,
      "sixdof equivalent --scenario II --algorithm vps --tau 10us --steps 100 "
      "--grid voxel_size=0.03,0.02,0.01 --grid point_spacing=0.03,0.02,0.01",
      "sixdof equivalent --paper --scenario II --algorithm vps --tau 10us --steps 100 "
      "--grid voxel_size=0.03,0.02,0.01 --grid point_spacing=0.03,0.02,0.01 --budget 5min --resume -o equivalent.json",
      "Measures a grid of resolutions, fits time and error, and measures the predicted best one. The error is eta = "
      "w1 sigma + w2 gamma: sigma is the error of the force's magnitude, as a fraction; gamma that of its direction, "
      "in radians; w1 and w2 are the --weights.");
}

}  // namespace sixdof::cli
