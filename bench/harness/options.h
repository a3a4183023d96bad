#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <sixdof/query/registry.h>
#include "bench/common/process_options.h"

namespace sixdof::bench {

enum class ResultFormat {
  json,
  csv
};

/// What sixdof-bench understands besides Google Benchmark's own flags.
struct Options {
  std::string program = "sixdof-bench";       ///< Named in messages.
  std::filesystem::path manifest;             ///< Catalogue of configuration sets; empty for none.
  std::vector<std::filesystem::path> sets;    ///< Further sets of the user's.
  std::string a, b;                           ///< Meshes, models' names or files: of the one set, or of a coarse set.
  std::vector<std::filesystem::path> meshes;  ///< Mesh files that these sets name.
  std::string suite_word;                     ///< As --suite takes it.
  std::filesystem::path suite;                ///< List of rows (harness/suite.h); empty for all rows.
  std::vector<std::string> parameters;        ///< "ALGORITHM:NAME=VALUE".
  std::size_t sample = 1024;                  ///< Configurations per bucket; 0 for all.
  double budget_s = 0.0;                      ///< Wall time for all rows together; 0 for no limit.
  std::size_t iterations = 0;  ///< Queries that a row times, in whole samples; 0 for --benchmark_min_time.
  std::uint64_t seed = 1;      ///< Of samples and orders.
  bool stats = false;          ///< Print how much was opened, read, loaded and prepared.
  std::filesystem::path out;   ///< Result file; empty for none.
  ResultFormat out_format = ResultFormat::json;
  bool resume = false;                 ///< Take over the rows that are in the result file.
  std::optional<ResultFormat> format;  ///< Of standard output; none for the console's table.
  std::string arguments;               ///< The command line, but for the result file, as a shell takes it.
  std::string benchmark_flags;         ///< Those of Google Benchmark's flags that change how a row is measured.
  bool fail_on_wrong = false;          ///< Exit code 3 for wrong or missing answers.
  bool list_only = false;
  ProcessOptions process;

  /// The words of the command line on which it depends what a row asks and whom: meshes, sets, parameters, processes.
  std::string reproduction_words() const;

  /// Whether a coarse set of the meshes is to be made (coarse_set.h), the only one of the run.
  bool own_pair() const { return !a.empty() && sets.empty(); }
};

/// The catalogue of the sets that come with the programs.
std::filesystem::path default_manifest();

/// Parses the command line and hands Google Benchmark its part of it. Help, version and errors are printed.
/// @returns the exit code if the program should end now, -1 otherwise
int parse_options(int argc, const char* const* argv, Options& options);

/// What the command line sets of every algorithm, by its name: "NAME=VALUE" each; empty for nothing.
/// @param parameters "ALGORITHM:NAME=VALUE"; "rivals" stands for all rivals that have the parameter
/// @throws BadArgument for an algorithm that does not exist
std::map<std::string, std::vector<std::string>> parse_assignments(const std::vector<std::string>& parameters,
                                                                  const Registry& registry);

/// The settings of every algorithm by its name: defaults, and what the command line says.
/// @throws BadArgument as parse_assignments() does, and for a parameter or value that does not exist
std::map<std::string, Settings> parse_parameters(const std::vector<std::string>& parameters, const Registry& registry);

}  // namespace sixdof::bench
