#include "bench/harness/options.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>
#include <memory>
#include <set>
#include <string_view>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <sixdof/base/data_folder.h>
#include <sixdof/base/error.h>
#include <sixdof/base/shell_text.h>
#include <sixdof/query/variant.h>
#include "bench/common/completion.h"
#include "bench/common/help_format.h"
#include "bench/common/rivals.h"
#include "bench/common/run_guarded.h"
#include "bench/common/unknown_word.h"
#include "bench/harness/benchmark_versions.h"

namespace sixdof::bench {
namespace {

/// Short enough for a suite of hundreds of rows; one round over the bucket is the shortest measurement.
constexpr const char* k_default_min_time = "--benchmark_min_time=0.1";

/// For the rows of an own pair: a table within two minutes, the making of its coarse set included.
constexpr double k_own_pair_budget_s = 60.0;
constexpr const char* k_own_pair_min_time = "--benchmark_min_time=0.02";

/// Flags of Google Benchmark, which the parser does not know.
constexpr std::array k_benchmark_flags{"benchmark_list_tests",
                                       "benchmark_filter",
                                       "benchmark_min_time",
                                       "benchmark_min_warmup_time",
                                       "benchmark_repetitions",
                                       "benchmark_enable_random_interleaving",
                                       "benchmark_report_aggregates_only",
                                       "benchmark_display_aggregates_only",
                                       "benchmark_color",
                                       "benchmark_counters_tabular",
                                       "benchmark_context",
                                       "benchmark_time_unit"};

constexpr const char* k_examples =
    "\nExamples:\n"
    "  sixdof-bench --benchmark_filter='^distance/algorithm:(exact|fcl-rss)/pair:torus-knot-10k/distance:05$' "
    "--sample 64\n"
    "  sixdof-bench --suite default --benchmark_list_tests\n";

bool has_flag(const std::vector<std::string>& flags, const std::string& name) {
  return std::any_of(flags.begin(), flags.end(), [&](const auto& flag) { return flag.starts_with(name); });
}

/// The words of the command line but those that name the result file.
std::string arguments_but_file(int argc, const char* const* argv) {
  const std::set<std::string> names{"--benchmark_out", "--out", "--resume"};
  std::string text;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const std::size_t equals = word.find('=');
    if (names.contains(word.substr(0, equals))) {
      if (equals == std::string::npos) ++i;
      continue;
    }
    text += (text.empty() ? "" : " ") + shell_quoted(word);
  }
  return text;
}

/// Google Benchmark's flags but those that choose rows or what is shown of them.
std::string flags_of_measurement(std::vector<std::string> flags) {
  const std::set<std::string> others{"--benchmark_filter",
                                     "--benchmark_list_tests",
                                     "--benchmark_color",
                                     "--benchmark_counters_tabular",
                                     "--benchmark_display_aggregates_only",
                                     "--benchmark_context",
                                     "--v"};
  std::erase_if(flags, [&](const std::string& flag) { return others.contains(flag.substr(0, flag.find('='))); });
  std::ranges::sort(flags);
  return fmt::format("{}", fmt::join(flags, " "));
}

/// Whether the environment asks for text without colour (no-color.org, terminals that cannot show it).
bool wants_no_color() {
  const char* const no_color = std::getenv("NO_COLOR");
  const char* const terminal = std::getenv("TERM");
  return (no_color != nullptr && *no_color != '\0') || (terminal != nullptr && std::string_view(terminal) == "dumb");
}

/// Why --a and --b do not go with the other options; empty if they do.
std::string conflict_of_meshes(const Options& options, bool has_manifest) {
  if (!options.b.empty() && options.a.empty() && options.sets.empty()) return "--b needs --a";
  if (!(options.a.empty() && options.b.empty()) && options.sets.size() > 1) {
    return "--a and --b say where the meshes of one --set are, not of several";
  }
  if (options.own_pair() && has_manifest) {
    return "--a without --set measures this pair alone; leave out --manifest";
  }
  return {};
}

/// Google Benchmark reads its flags from a command line, and keeps a pointer to the program's name.
/// @returns the first word that it does not know; empty if it knows all
std::string initialize_benchmark(const std::vector<std::string>& flags) {
  static std::vector<std::string> words;
  words = {"sixdof-bench"};
  for (const std::string& flag : flags) {
    words.push_back(flag_of_version<benchmark::BenchmarkReporter::Run>(flag));
  }
  // It insists on a file name before it calls a reporter of files; ours keeps the text in memory.
  words.emplace_back("--benchmark_out=/dev/null");
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  int count = static_cast<int>(words.size());
  benchmark::Initialize(&count, pointers.data());
  return count > 1 ? pointers[1] : std::string();
}

/// Long names of this program's options and of Google Benchmark's.
std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names(k_benchmark_flags.begin(), k_benchmark_flags.end());
  for (const CLI::Option* option : app.get_options())
    std::ranges::copy(option->get_lnames(), std::back_inserter(names));
  return names;
}

std::string completion_of(const CLI::App& app) {
  ValueTable values = common_values();
  values["SUITE"] = {.words = {"default", "own-pair", "all-algorithms", "paper", "scenes", "deform", "all"},
                     .files = true};
  std::vector<std::string> flags;
  for (const char* name : k_benchmark_flags) flags.push_back(std::string("--") + name);
  return bash_completion(app, "sixdof-bench", values, flags);
}

/// The file of a named list of rows, or of the user's own; empty for all rows.
std::filesystem::path file_of_suite(const std::string& suite) {
  if (suite == "all") return {};
  const std::filesystem::path folder = data_folder() / "bench";
  if (suite == "default") return folder / "default_suite.json";
  if (suite == "own-pair") return folder / "own_pair_suite.json";
  if (suite == "all-algorithms") return folder / "all_algorithms_suite.json";
  if (suite == "paper") return folder / "paper_suite.json";
  if (suite == "scenes") return folder / "scenes_suite.json";
  if (suite == "deform") return folder / "deform_suite.json";
  return suite;
}

/// What the parser fills besides Options, and its options of which it matters whether they were given.
struct CommandLine {
  std::string format = "console", out_format = "json", suite, shell;
  bool no_manifest = false;
  const CLI::Option *manifest = nullptr, *budget = nullptr, *resume = nullptr;
};

void add_set_options(CLI::App& app, Options& options, CommandLine& line) {
  auto* const manifest = app.add_option("--manifest", options.manifest, "Catalogue of configuration sets")
                             ->type_name("FILE")
                             ->default_str("that of the sets that come with sixdof");
  line.manifest = manifest;
  app.add_flag("--no-manifest", line.no_manifest, "No catalogue: only the sets of --set")->excludes(manifest);
  app.add_option("--set", options.sets, "A configuration set of your own (sixdof generate); may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->check(CLI::ExistingFile);
  app.add_option("--mesh", options.meshes,
                 "Where to find a mesh that a --set names, e.g. tray.off for its mesh tray; may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->check(CLI::ExistingFile);
  app.add_option(
         "--a", options.a,
         "Fixed mesh A, a model's name or a file: measure this pair alone, on a coarse set that is made in seconds and "
         "kept in the cache. With --set: where to find the set's mesh A")
      ->type_name("MESH");
  app.add_option("--b", options.b, "Moving mesh B, likewise")->type_name("MESH")->default_str("a copy of A");
}

void add_row_options(CLI::App& app, Options& options, CommandLine& line) {
  app.add_option("--suite", line.suite,
                 "Rows to run: default, own-pair, all-algorithms, paper, scenes, deform (bench/*_suite.json), all, or "
                 "a file of the same form")
      ->type_name("SUITE")
      ->default_str("own-pair with --a and no --set; all with --benchmark_filter or your own sets; else default");
  app.add_option(
         "-p,--parameter", options.parameters,
         "Parameter of an algorithm (sixdof algorithms lists them); several values: rows of each. May be repeated")
      ->type_name("ALGORITHM:NAME=VALUE[,VALUE...]")
      ->allow_extra_args(false);
  app.add_option("--sample", options.sample, "Poses (configurations) per bucket, drawn at random; 0: all")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  line.budget =
      app.add_option("--budget", options.budget_s,
                     fmt::format("Time of all rows together; samples are reduced to fit. 0: no limit; {} with "
                                 "--a and no --set",
                                 k_own_pair_budget_s))
          ->type_name("SECONDS")
          ->check(CLI::NonNegativeNumber)
          ->capture_default_str();
  app.add_option("--iterations", options.iterations,
                 "Queries that a row times, in whole samples; 0: --benchmark_min_time decides")
      ->type_name("N")
      ->check(CLI::Range(0, 1'000'000'000))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Seed of samples and orders")->type_name("N")->capture_default_str();
  app.add_flag("--fail-on-wrong", options.fail_on_wrong,
               "Exit code 3 if an answer is missing, or is wrong though the algorithm does not approximate");
  app.add_flag("--stats", options.stats, "Print on stderr how many sets, buckets, meshes and structures were used");
  add_process_options(app, options.process);
}

void add_output_options(CLI::App& app, Options& options, CommandLine& line) {
  auto* const out =
      app.add_option("--benchmark_out,--out", options.out,
                     "Result file; appears whole or not at all. Until then finished rows are in FILE.journal")
          ->type_name("FILE");
  line.resume =
      app.add_option("--resume", options.out,
                     "Continue an interrupted run with the same arguments: finished rows of FILE are kept, missing and "
                     "failed rows are measured")
          ->type_name("FILE")
          ->excludes(out)
          ->check([](const std::string& file) { return file.empty() ? "a file is needed" : ""; });
  app.add_option("--benchmark_out_format", line.out_format, "Format of the result file; csv has no context")
      ->type_name("FORMAT")
      ->check(CLI::IsMember({"json", "csv"}))
      ->capture_default_str();
  app.add_option("--benchmark_format", line.format, "Format of standard output")
      ->type_name("FORMAT")
      ->check(CLI::IsMember({"console", "json", "csv"}))
      ->capture_default_str();
  // For the installation, which keeps the script; no row is run.
  app.add_option("--completion", line.shell, "Print a script with which a shell completes the options")
      ->check(CLI::IsMember({"bash"}))
      ->type_name("SHELL")
      ->group("");
}

/// Help, version, completion and errors end the program. @returns as parse_options()
int parse(CLI::App& app, int argc, const char* const* argv, const CommandLine& line) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}\nGoogle Benchmark's own flags:\n", app.help());
    benchmark::PrintDefaultHelp();
    fmt::print("{}", k_examples);
    return 0;
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : k_exit_usage;
  }
  if (line.shell.empty()) return -1;
  fmt::print("{}", completion_of(app));
  return 0;
}

/// What depends on several options.
void complete_options(const CommandLine& line, bool has_filter, Options& options) {
  const bool own_pair = options.own_pair();
  if (own_pair && line.budget->empty()) options.budget_s = k_own_pair_budget_s;
  const bool no_manifest = line.no_manifest || own_pair;
  const bool own_sets = no_manifest || !line.manifest->empty() || !options.sets.empty();
  const char* const usual = own_pair ? "own-pair" : own_sets || has_filter ? "all" : "default";
  options.suite_word = line.suite.empty() ? usual : line.suite;
  options.suite = file_of_suite(options.suite_word);
  if (no_manifest) options.manifest.clear();
  options.resume = !line.resume->empty();
  options.out_format = line.out_format == "csv" ? ResultFormat::csv : ResultFormat::json;
  if (line.format != "console") options.format = line.format == "csv" ? ResultFormat::csv : ResultFormat::json;
}

/// Hands Google Benchmark its flags, with this program's defaults. @returns as parse_options()
int pass_on(std::vector<std::string> flags, Options& options, const std::vector<std::string>& own_names) {
  options.list_only = has_flag(flags, "--benchmark_list_tests") && !has_flag(flags, "--benchmark_list_tests=false");
  if (!has_flag(flags, "--benchmark_min_time")) {
    flags.emplace_back(options.own_pair() ? k_own_pair_min_time : k_default_min_time);
  }
  options.benchmark_flags = flags_of_measurement(flags);
  if (options.iterations > 0) {
    options.benchmark_flags.append(
        fmt::format("{}--iterations={}", options.benchmark_flags.empty() ? "" : " ", options.iterations));
  }
  const auto is_color = [](const std::string& flag) {
    return flag.starts_with("--benchmark_color=") && flag != "--benchmark_color=auto";
  };
  if (wants_no_color() && std::ranges::none_of(flags, is_color)) flags.emplace_back("--benchmark_color=false");
  const std::string unknown = initialize_benchmark(flags);
  if (unknown.empty()) return -1;
  print_message("sixdof-bench", unknown.starts_with('-')
                                    ? explain_unknown_word(unknown, own_names, "sixdof-bench --help")
                                    : unknown + ": unexpected argument (sixdof-bench --help)");
  return k_exit_usage;
}

/// Whether an algorithm has the parameter of "NAME=VALUE".
bool has_parameter(const Traits& traits, const std::string& assignment) {
  return std::ranges::any_of(traits.parameters,
                             [&](const Parameter& each) { return assignment.starts_with(each.name + "="); });
}

/// Names of the algorithm's variants, and its own where it is there too; empty for one without variants.
std::vector<std::string> variants_of(const std::string& name, const Registry& registry) {
  std::vector<std::string> names;
  for (const auto& algorithm : registry.all()) {
    if (base_name(algorithm->traits().name) == name) names.push_back(algorithm->traits().name);
  }
  return names;
}

}  // namespace

std::filesystem::path default_manifest() { return data_folder() / "fixtures" / "manifest.json"; }

int parse_options(int argc, const char* const* argv, Options& options) {
  CLI::App app(
      "Times yes/no, distance and response queries of every algorithm on the poses of configuration sets, checks every "
      "answer, and writes rows for `sixdof table` and `sixdof report`. Runs under Google Benchmark.",
      "sixdof-bench");
  app.formatter(std::make_shared<HelpFormat>());
  app.set_version_flag("--version", std::string("sixdof-bench ") + SIXDOF_VERSION);
  app.allow_extras();
  options.manifest = default_manifest();
  CommandLine line;
  add_set_options(app, options, line);
  add_row_options(app, options, line);
  add_output_options(app, options, line);
  if (const int code = parse(app, argc, argv, line); code >= 0) return code;
  if (const std::string conflict = conflict_of_meshes(options, !line.manifest->empty()); !conflict.empty()) {
    print_message("sixdof-bench", conflict);
    return k_exit_usage;
  }
  const std::vector<std::string> flags = app.remaining();
  complete_options(line, has_flag(flags, "--benchmark_filter"), options);
  options.arguments = arguments_but_file(argc, argv);
  return pass_on(flags, options, option_names(app));
}

std::map<std::string, std::vector<std::string>> parse_assignments(const std::vector<std::string>& parameters,
                                                                  const Registry& registry) {
  std::map<std::string, std::vector<std::string>> assignments;
  for (const auto& algorithm : registry.all()) assignments[algorithm->traits().name] = {};
  for (const std::string& text : parameters) {
    const auto colon = text.find(':');
    if (colon == std::string::npos) {
      throw BadArgument(fmt::format("--parameter {}: must read ALGORITHM:NAME=VALUE", text));
    }
    const std::string name = text.substr(0, colon), assignment = text.substr(colon + 1);
    const auto suits = [&](const Traits& traits) { return has_parameter(traits, assignment); };
    const std::vector<std::string> variants = variants_of(name, registry);
    for (const std::string& each : variants.empty() ? with_rivals({name}, registry, suits) : variants) {
      assignments[registry.find(each).traits().name].push_back(assignment);
    }
  }
  return assignments;
}

std::map<std::string, Settings> parse_parameters(const std::vector<std::string>& parameters, const Registry& registry) {
  std::map<std::string, Settings> settings;
  for (const auto& [name, assignments] : parse_assignments(parameters, registry)) {
    settings.emplace(name, registry.find(name).settings()).first->second.set_all(assignments);
  }
  return settings;
}

}  // namespace sixdof::bench
