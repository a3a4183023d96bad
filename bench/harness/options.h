#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace sixdof::bench {

/// What sixdof-bench understands besides Google Benchmark's own flags.
struct Options {
  std::filesystem::path manifest;           ///< Catalogue of configuration sets; empty for none.
  std::vector<std::filesystem::path> sets;  ///< Further sets of the user's.
  std::vector<std::string> settings;        ///< "ALGORITHM:PARAMETER=VALUE".
  std::size_t sample = 1024;                ///< Configurations per bucket; 0 for all.
  double budget_s = 0.0;                    ///< Wall time for all rows together; 0 for no limit.
  std::uint64_t seed = 1;                   ///< Of samples and orders.
  bool stats = false;                       ///< Print what was opened, read, loaded and prepared.
  std::filesystem::path out;                ///< Result file; empty for none.
  bool json_on_stdout = false;
  bool list_only = false;

  std::vector<std::string> benchmark_flags;  ///< Left for Google Benchmark, without the program's name.
};

/// Parses the command line. Help and version are printed to stdout.
/// @returns the exit code if the program should end now, -1 otherwise.
int parse_options(int argc, const char* const* argv, Options& options);

}  // namespace sixdof::bench
